#pragma once

class btSoftBodySolver;

namespace weft::bench {

/// The solver that the demo's world is made with. Null: Bullet's own, as the demo has it.
[[nodiscard]] btSoftBodySolver* demo_solver();

}  // namespace weft::bench
