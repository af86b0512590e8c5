#include <weft/validation/cases/motion_departures.hpp>

namespace weft::validation {

std::span<const StatedDeparture> motion_departures() {
  return {};
}

}  // namespace weft::validation
