// Tested by tests/apps/command_line_test.sh.

#include <weft/engines/engine_table.hpp>

namespace weft::scenes {

std::string_view to_string(StoredPrecision precision) {
  return precision == StoredPrecision::kFloat32 ? "float32" : "float64";
}

}  // namespace weft::scenes
