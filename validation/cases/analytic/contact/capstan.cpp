// A chain over a round body holds back more than pulls it, by the friction of every turn: the capstan.
// Tested by tests/validation/cases/support/parameters_test.cpp, tests/apps/CMakeLists.txt.
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace capstan {
namespace {

constexpr double kRadius = 1.0;   // [m]
constexpr double kPull = 1.0;     // T1 [N]
constexpr double kMass = 1.0;     // of a node [kg]
constexpr double kStrain = 1e-4;  // of the springs under T1 [-]

struct Capstan {
  double friction = 0.3;
  double wrap = 180.0;           ///< [deg]
  int nodes = 16;                ///< that touch: each turns the chain by wrap / nodes
  double friction_factor = 1.0;  ///< sabotage

  [[nodiscard]] double turn() const { return wrap * std::numbers::pi / 180 / nodes; }
  /// T2 / T1 of a polygon with equal turns: each node sits where its turn is halved.
  [[nodiscard]] double exact() const {
    const double t = friction * std::tan(turn() / 2);
    return std::pow((1 + t) / (1 - t), nodes);
  }
};

/// Whether T2 = ratio T1 pulls the chain over: it keeps moving when all else has come to rest. The chain lies
/// on a great circle of a sphere.
bool slips(const Capstan& capstan, double ratio) {
  const int n = capstan.nodes + 2;
  const double turn = capstan.turn();
  const double spacing = 2 * kRadius * std::sin(turn / 2);
  Matrix3X<double> places = Matrix3X<double>::Zero(3, n);
  for (int i = 1; i <= capstan.nodes; ++i) {
    const double angle = (i - 0.5) * turn;
    places.col(i) << kRadius * std::cos(angle), kRadius * std::sin(angle), 0;
  }
  const double wrap = capstan.nodes * turn;
  const Vector3<double> first(0, -1, 0);  // away from the body, along the pulls
  const Vector3<double> last(-std::sin(wrap), std::cos(wrap), 0);
  places.col(0) = places.col(1) + spacing * first;
  places.col(n - 1) = places.col(n - 2) + spacing * last;
  SpringBody springs;
  springs.positions = places;
  springs.edges.resize(2, n - 1);
  for (int i = 1; i < n; ++i) springs.edges.col(i - 1) << i - 1, i;
  springs.masses = VectorX<double>::Constant(n, kMass);
  const double stiffness = kPull / (kStrain * spacing);
  const double rate = std::sqrt(stiffness / kMass);  // of a node on its spring [rad/s]
  const double damping = 3 * rate / n;  // the slowest wave along the chain dies fastest
  springs.laws = {tension_law(stiffness), velocity_damping_law(damping)};
  reference::Body body = make_body(springs);
  body.friction = capstan.friction * capstan.friction_factor;
  body.external_forces = Matrix3X<double>::Zero(3, n);
  reference::System system;
  system.bodies.push_back(std::move(body));
  reference::Collider ball;
  ball.name = "ball";
  ball.shape = reference::Sphere{kRadius};
  system.colliders.push_back(ball);
  reference::SpringSolver solver(std::move(system), {});
  const double step = 0.5 / rate;
  const int num_steps = static_cast<int>(std::lround(40 / (damping * step)));
  Matrix3X<double> pulls = Matrix3X<double>::Zero(3, n);
  for (int i = 0; i < num_steps; ++i) {
    // Slowly, so that no wave helps it over.
    const double part = std::min(1.0, 2.0 * i / num_steps);
    pulls.col(0) = kPull * first;
    pulls.col(n - 1) = kPull * (1 + part * (ratio - 1)) * last;
    solver.set_external_forces(0, pulls);
    if (solver.step(step).blow_up) return true;
  }
  // A difference of 1e-4 T1 would move the whole chain at this speed.
  const double moving = 1e-4 * kPull / (n * kMass * damping);
  const reference::Body& end = solver.system().bodies[0];
  return end.velocities.col(n - 1).dot(last) > moving;
}

double largest_ratio(const Capstan& capstan) {
  double low = 0.0;  // logarithms
  double high = 1.5 * std::log(capstan.exact());
  constexpr int kBisections = 11;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (slips(capstan, std::exp(middle)) ? high : low) = middle;
  }
  return std::exp(0.5 * (low + high));
}

void add_check(const CaseInfo& info, const Capstan& capstan, Report& report) {
  const auto pull = [](const Capstan& each) {
    return ComparedValue{"T2 / T1", largest_ratio(each), each.exact(), "1"};
  };
  const double rope = std::exp(capstan.friction * capstan.wrap * std::numbers::pi / 180);
  CheckResult check = judged(
      info,
      {fmt::format("a chain round a body holds as a polygon of {} turns, mu = {}, {} degrees",
                   capstan.nodes, capstan.friction, capstan.wrap),
       fmt::format("relative error of T2 / T1 (a rope's: {:.4f})", rope),
       "T2 / T1 = ((1 + mu tan(d / 2)) / (1 - mu tan(d / 2)))^n, d = wrap / n",
       "balance of a node that turns a chain by d; Euler and Eytelwein for n to infinity",
       {0.01, Basis::kModelGap, "the last node that touches moves on by a strain of 1e-4"},
       "Coulomb friction of the impulse contact on a curved body"},
      pull(capstan));
  Capstan wrong = capstan;
  wrong.friction_factor = 1.1;
  if (capstan.friction * capstan.wrap > 20)
    add_sabotage(check, "friction +10 %", relative_error(pull(wrong)));
  wrong.friction_factor = 0.0;
  add_sabotage(check, "no friction", relative_error(pull(wrong)));
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"mu", "1", "friction of chain and body", 0.05, 0.8, 0.3},
    CaseParameter{"wrap", "deg", "angle round the body", 45.0, 270.0, 180.0},
    CaseParameter{"nodes", "1", "nodes that touch", 8, 48, 16, true},
};

}  // namespace
}  // namespace capstan

std::span<const CaseParameter> capstan_parameters() {
  using namespace capstan;
  return kParameters;
}

void evaluate_capstan(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                      Report& report) {
  using namespace capstan;
  if (asks_for_point(options)) {
    add_check(info,
              {.friction = value_of(info, options, "mu"),
               .wrap = value_of(info, options, "wrap"),
               .nodes = static_cast<int>(value_of(info, options, "nodes"))},
              report);
    return;
  }
  for (const int nodes : {4, 8, 16}) add_check(info, {.nodes = nodes}, report);
  add_check(info, {.friction = 0.5, .nodes = 8}, report);
  add_check(info, {.wrap = 90, .nodes = 8}, report);
  add_check(info, {.friction = 0.2}, report);
}

}  // namespace weft::validation
