#pragma once

class btSoftBodySolver;

namespace weft::bench {

/// What the demo's world is made with. Null: Bullet's own solver, as the demo has it.
[[nodiscard]] btSoftBodySolver* demo_solver();

}  // namespace weft::bench
