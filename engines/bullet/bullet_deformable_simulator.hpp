#pragma once

// Tested by tests/engines/blow_up_engines_test.cpp, tests/engines/body_engines_test.cpp, tests/engines/snapshot_test.cpp.

#include <memory>

#include <weft/scenes/simulator.hpp>

namespace weft::scenes {

/// bullet_deformable: Weft's laws in Bullet's deformable world, explicit.
[[nodiscard]] std::unique_ptr<Simulator> make_bullet_deformable();

/// bullet_deformable_implicit: the same world with its implicit step.
[[nodiscard]] std::unique_ptr<Simulator> make_bullet_deformable_implicit();

}  // namespace weft::scenes
