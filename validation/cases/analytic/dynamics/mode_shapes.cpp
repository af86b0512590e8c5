#include <weft/validation/cases/analytic/dynamics/mode_shapes.hpp>

#include <cmath>

#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {

double swing_frequency(const std::function<reference::Body()>& make, const Matrix3X<double>& mode,
                       double amplitude, double step, int num_steps) {
  reference::Body body = make();
  const Matrix3X<double> center = body.positions;
  const VectorX<double> masses = body.mesh.masses;
  body.positions += amplitude * mode;
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kVelocityVerlet);
  const auto place = [&] {
    const Matrix3X<double> moved = solver.system().bodies[0].positions - center;
    return (moved.cwiseProduct(mode).colwise().sum() * masses).value();
  };
  double before = place();
  (void)solver.step(step);
  double now = place();
  double product = 0;
  double square = 0;
  for (int i = 0; i < num_steps; ++i) {
    if (solver.step(step).blow_up) return std::nan("");
    const double next = place();
    product += now * (next - 2 * now + before);
    square += now * now;
    before = now;
    now = next;
  }
  return std::sqrt(-product / square) / step;
}

std::vector<Mode> slowest_modes(const reference::StaticProblem& problem,
                                const Matrix3X<double>& positions, const VectorX<double>& masses,
                                int count, double length) {
  const Eigen::Index n = positions.cols();
  Matrix3X<double> rest(3, n);
  problem.forces(positions, rest);
  const auto product = [&](const Matrix3X<double>& a, const Matrix3X<double>& b) {
    return (a.cwiseProduct(b).colwise().sum() * masses).value();
  };
  std::vector<Mode> modes;
  for (int m = 0; m < count; ++m) {
    Mode mode;
    mode.shape = Matrix3X<double>::Zero(3, n);
    for (Eigen::Index node = 0; node < n; ++node) {
      if (problem.fixed[static_cast<std::size_t>(node)]) continue;
      // Nothing symmetric, so that every mode has a part of it.
      const double s = static_cast<double>(node + 1) / static_cast<double>(n);
      mode.shape.col(node) << 0, s * s + 0.1 * m * std::sin(5.0 * (m + 1) * s), 0;
    }
    constexpr int kIterations = 60;
    constexpr double kConverged = 1e-12;
    double last = 0;
    for (int i = 0; i < kIterations; ++i) {
      for (const Mode& found : modes) {
        mode.shape -=
            product(mode.shape, found.shape) / product(found.shape, found.shape) * found.shape;
      }
      mode.shape /= mode.shape.cwiseAbs().maxCoeff();
      // K u = M shape, as the change of an equilibrium under a load of 1e-6 of what bends it through.
      reference::StaticProblem loaded = problem;
      const Matrix3X<double> load = mode.shape * masses.asDiagonal();
      Matrix3X<double> response(3, n);
      Matrix3X<double> moved = positions;
      const double scale = 1e-6 * length;
      const double guess = last > 0 ? last : 1.0;
      loaded.forces = [&](const Matrix3X<double>& x, Matrix3X<double>& f) {
        problem.forces(x, f);
        f += scale * guess * load - rest;
      };
      loaded.load = (scale * guess * load).cwiseAbs().maxCoeff();
      reference::StaticOptions options;
      options.residual = 1e-6;
      options.max_iterations = 2;  // the second takes what rounding left of the first
      options.max_move = length;
      (void)reference::solve_statics(loaded, moved, options);
      response = (moved - positions) / (scale * guess);
      const double omega_squared = product(mode.shape, mode.shape) / product(mode.shape, response);
      if (!std::isfinite(omega_squared)) return modes;
      mode.shape = response;
      const bool is_done = std::abs(omega_squared / last - 1) < kConverged;
      last = omega_squared;
      if (is_done) break;
    }
    mode.omega_squared = last;
    mode.shape /= mode.shape.cwiseAbs().maxCoeff();
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace weft::validation
