#pragma once

// Tested by tests/engines/blow_up_engines_test.cpp, tests/engines/bullet/bullet_shapes_test.cpp.

#include <memory>
#include <string>

#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// bullet_soft: tension laws become Bullet links, everything else stays a Weft law.
[[nodiscard]] std::unique_ptr<Simulator> make_bullet_soft();

/// bullet_forces: every law is Weft's, Bullet has no links and does integration and contact.
[[nodiscard]] std::unique_ptr<Simulator> make_bullet_forces();

/// bullet_weft: springs and their dampers by the fast implicit solver, everything else as
/// bullet_forces.
[[nodiscard]] std::unique_ptr<Simulator> make_bullet_weft();

/// The precision this program's Bullet was built with.
[[nodiscard]] StoredPrecision bullet_precision();
[[nodiscard]] std::string bullet_version_text();

}  // namespace weft::scenes
