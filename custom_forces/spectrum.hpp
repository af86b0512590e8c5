#pragma once

// Tested by tests/reference/statics/static_solver_test.cpp, tests/reference/damping_test.cpp.

#include <vector>

#include <weft/custom_forces/law_set.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// The stiffest and the most damped motion of a body, linearised at its present state.
/// K = -df/dx, C = -df/dv, free nodes only. M is the mass matrix; for a body with inertia-level laws,
/// whose forces are redistributed by R, it stands for M R^-1 except with velocity-level laws.
struct Spectrum {
  double omega_max = 0.0;           ///< root of the largest eigenvalue of M^-1/2 K M^-1/2 [rad/s]
  double top_mode_damping = 0.0;    ///< phi . C phi / phi . M phi of that mode, all laws [1/s]
  double gamma_force_max = 0.0;     ///< largest eigenvalue of M^-1 C, laws that act as forces [1/s]
  double gamma_velocity_max = 0.0;  ///< the same for velocity-level laws [1/s]
  int iterations = 0;               ///< of the longest of the three power iterations
  bool converged = true;            ///< all three
};

/// Relative change of the Rayleigh quotient at which power iteration stops. The error of omega_max
/// is larger where the next modes are close: 1e-6 for small meshes, 3e-6 measured on a 30 x 30
/// lattice.
inline constexpr double kRayleighTolerance = 1e-8;
inline constexpr int kMaxPowerIterations = 5000;

/// Matrix-free power iteration from a fixed start vector: the same bits every time. Approaches from
/// below. A negative eigenvalue (a compressed spring) may dominate; the iteration is then shifted
/// so that the largest positive one is found. inverse_masses: n [1/kg], 0 for nodes that do not move.
[[nodiscard]] Spectrum spectrum(LawSet<double>& laws, const State<double>& state,
                                const VectorX<double>& inverse_masses);

/// Largest step [s] at which no mode of a body with this spectrum grows under symplectic Euler, the
/// scheme of Bullet's classic world and of its explicit deformable world; infinity if nothing moves
/// it. w = omega_max, f = gamma_force_max, g = gamma_velocity_max:
///
///   h^2 w^2 < 2 (1 + exp(-h g) (1 - h f)),  h f < 2
///
/// exact for a mode x'' = -w^2 x - (f + g) x' (Jury criterion of its 2 x 2 matrix: trace 1 - h^2 w^2 +
/// q, determinant q = exp(-h g) (1 - h f)). Undamped: h w < 2.
[[nodiscard]] double critical_time_step(const Spectrum& spectrum);

/// The same for a cloth at its rest shape with these laws: what a program may give its world before
/// the first step. All laws count, torsion and acceleration damping too. A cloth that is stretched or
/// folded, or in contact, may allow less. Throws InvalidArgument as make_law().
[[nodiscard]] double critical_time_step(const ClothMesh& mesh,
                                        const std::vector<LawSpecification>& laws);

}  // namespace weft::forces
