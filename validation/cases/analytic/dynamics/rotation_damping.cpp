// The angular momentum of a body without symmetry decays at the stated rate, in magnitude and
// direction, and its linear momentum does not; what is internal leaves a rigid spin alone.
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include <weft/custom_forces/registry.hpp>
#include <weft/validation/cases/analytic/dynamics/torsional_damping.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace rotation_damping {
namespace {

using reference::IntegratorKind;

constexpr double kRate = 0.5;       // [1/s]
constexpr double kTimeStep = 5e-3;  // [s]
constexpr int kNumSteps = 4000;     // ten time constants: exp(-10) is left

/// Mistake: omega as if the inertia were the same about every axis.
class SphereInertia final : public forces::ForceLaw<double> {
 public:
  [[nodiscard]] const forces::LawInfo& info() const noexcept override {
    return *forces::find_law("rotation_damping");
  }
  void add_forces(const forces::State<double>&, Matrix3XRef<double>,
                  Matrix3XRef<double>) const override {}
  void advance_velocities(const forces::State<double>& state, double time_step,
                          Matrix3XRef<double> velocities) const override {
    const Vector3<double> center = state.positions * state.masses / state.masses.sum();
    Vector3<double> momentum = Vector3<double>::Zero();
    double trace = 0;
    for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
      const Vector3<double> r = state.positions.col(i) - center;
      momentum += state.masses[i] * r.cross(Vector3<double>(velocities.col(i)));
      trace += 2 * state.masses[i] * r.squaredNorm();
    }
    const Vector3<double> omega = (1 - std::exp(-kRate * time_step)) * 3 / trace * momentum;
    for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
      velocities.col(i) -= omega.cross(Vector3<double>(state.positions.col(i) - center));
    }
  }
};

/// Six masses without any symmetry, a spring between every two.
SpringBody lopsided_body() {
  SpringBody body;
  body.positions.resize(3, 6);
  body.positions << 0.0, 1.1, 0.2, -0.4, 0.6, -0.2,  //
      0.0, 0.1, 0.7, 0.3, -0.5, -0.3,                //
      0.0, -0.2, 0.1, 0.5, 0.3, -0.6;
  body.masses.resize(6);
  body.masses << 0.3, 0.1, 0.25, 0.4, 0.15, 0.2;
  body.edges.resize(2, 15);
  Eigen::Index edge = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j) body.edges.col(edge++) << i, j;
  }
  body.laws = {tension_law(200.0), spring_damping_law(0.05)};
  return body;
}

struct Momenta {
  Vector3<double> linear;   ///< P [kg m/s]
  Vector3<double> angular;  ///< L about the centre of mass [kg m^2/s]
};

Momenta momenta(const reference::Body& body) {
  const VectorX<double>& masses = body.mesh.masses;
  const Vector3<double> center = body.positions * masses / masses.sum();
  Momenta sum{body.velocities * masses, Vector3<double>::Zero()};
  for (Eigen::Index i = 0; i < masses.size(); ++i) {
    const Vector3<double> r = body.positions.col(i) - center;
    sum.angular += masses[i] * r.cross(Vector3<double>(body.velocities.col(i)));
  }
  return sum;
}

struct Run {
  Momenta start;
  Momenta end;
};

using AddLaw = std::function<void(reference::Body&)>;

AddLaw with(const forces::LawSpecification& specification) {
  return [specification](reference::Body& body) {
    body.laws.add(forces::make_law<double>(specification, body.mesh));
  };
}

/// A tumbling, drifting and shaking body.
Run run(const AddLaw& add_law, int num_steps) {
  reference::Body body = make_body(lopsided_body());
  add_law(body);
  const Vector3<double> spin(1.5, -0.8, 2.1);   // [rad/s]
  const Vector3<double> drift(0.5, -0.2, 0.7);  // [m/s]
  for (Eigen::Index i = 0; i < 6; ++i) {
    body.velocities.col(i) = drift + spin.cross(Vector3<double>(body.positions.col(i)));
    body.velocities(i % 3, i) += 0.4;
  }
  const Momenta start = momenta(body);
  reference::SpringSolver solver = make_solver(std::move(body), IntegratorKind::kModifiedEuler);
  for (int step = 0; step < num_steps; ++step) (void)solver.step(kTimeStep);
  return {start, momenta(solver.system().bodies[0])};
}

double spin_error(const AddLaw& add_law, int num_steps = kNumSteps) {
  const Run found = run(add_law, num_steps);
  const Vector3<double> exact = std::exp(-kRate * kTimeStep * kNumSteps) * found.start.angular;
  return (found.end.angular - exact).norm() / exact.norm();
}

double drift_error(const AddLaw& add_law) {
  const Run found = run(add_law, kNumSteps);
  return (found.end.linear - found.start.linear).norm() / found.start.linear.norm();
}

void check_spin(const CaseInfo& info, Report& report) {
  CheckResult check =
      judged(info,
             {"the angular momentum of a lopsided, shaking body decays, in size and direction",
              "|L_n - exact| over |exact| after 10 time constants",
              "L_n = exp(-n h rate) L_0",
              "modified Euler keeps L under internal forces; the law takes its exact part",
              {1e-8, Basis::kRoundoff,
               "4000 steps, each with a rounding of 1e-15 of the first L, 2e4 times the last"},
              "the inertia tensor, or the place of the law in the step"},
             spin_error(with(rotation_damping_law(kRate))));
  add_sabotage(check, "rate +1 %", spin_error(with(rotation_damping_law(1.01 * kRate))));
  add_sabotage(check, "one step dropped",
               spin_error(with(rotation_damping_law(kRate)), kNumSteps - 1));
  add_sabotage(check, "the same inertia about every axis", spin_error([](reference::Body& body) {
                 body.laws.add(std::make_unique<SphereInertia>());
               }));
  report.checks.push_back(std::move(check));
}

void check_drift(const CaseInfo& info, Report& report) {
  CheckResult check =
      judged(info,
             {"its linear momentum stays",
              "|P_n - P_0| over |P_0|",
              "P_n = P_0",
              "a rotation about the centre of mass carries no momentum",
              {1e-11, Basis::kRoundoff, "4000 steps, each with a rounding of 1e-15"},
              "the centre of mass"},
             drift_error(with(rotation_damping_law(kRate))));
  add_sabotage(check, "velocity_damping instead", drift_error(with(velocity_damping_law(kRate))));
  report.checks.push_back(std::move(check));
}

}  // namespace
}  // namespace rotation_damping

void evaluate_rotation_damping(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                               Report& report) {
  using namespace rotation_damping;
  check_spin(info, report);
  check_drift(info, report);
  check_torsional_mode(info, report);
  check_spinning_ring(info, report);
}

}  // namespace weft::validation
