#pragma once

// Tested by tests/engines/blow_up_engines_test.cpp, tests/engines/attach_test.cpp.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// An engine that this program contains. Bullet's two precisions cannot live in one process, so a
/// program holds the Bullet engines of one precision, and the reference.
struct EngineInfo {
  std::string_view name;  ///< "bullet_forces"
  StoredPrecision precision;
  std::string_view summary;  ///< one sentence
  std::unique_ptr<Simulator> (*make)();
};

[[nodiscard]] std::span<const EngineInfo> engine_table();

/// The engine of this name in this program, or nullptr.
[[nodiscard]] const EngineInfo* find_engine(std::string_view name, StoredPrecision precision);

[[nodiscard]] std::string_view to_string(StoredPrecision precision);  ///< "float32", "float64"

/// "Bullet 3.24, single precision" or "none".
[[nodiscard]] std::string bullet_description();

}  // namespace weft::scenes
