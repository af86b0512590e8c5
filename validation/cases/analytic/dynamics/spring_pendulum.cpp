// A pendulum on a spring against its trajectory, and a stiff one against the period of a rigid pendulum.
// Tested by tests/apps/CMakeLists.txt.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace spring_pendulum {
namespace {

using reference::IntegratorKind;

constexpr double kGravity = 9.81;  // [m/s^2]

struct Pendulum {
  double mass = 1.0;         ///< [kg]
  double stiffness = 100.0;  ///< [N/m]
  double length = 1.0;       ///< at rest [m]
  double x = 0.6;            ///< [m] start, at rest
  double y = -1.2;           ///< [m]
};

reference::SpringSolver make_pendulum(const Pendulum& pendulum, IntegratorKind integrator) {
  SpringRow row;
  row.spacing = pendulum.length;
  row.mass = pendulum.mass;
  row.direction = {0, -1, 0};
  row.laws = {tension_law(pendulum.stiffness), gravity_law({0, -kGravity, 0})};
  reference::Body body = make_row(row);
  body.positions.col(1) << pendulum.x, pendulum.y, 0;
  return make_solver(std::move(body), integrator);
}

/// Where the mass is at times that a table gives, Runge-Kutta 4 to 1e-8 m.
struct Place {
  double time, x, y;
};
constexpr std::array kTable = {
    Place{0.5, -.069627411, -1.217504590}, Place{1, -.348251841, -.821392145},
    Place{2, .445570232, -1.005587065}, Place{5, -.526191324, -1.186708980},
    Place{10, .347049829, -1.137932779}};

/// The same equations in polar coordinates, written apart from every law and solver.
Place exact_place(const Pendulum& p, double time) {
  using State = std::array<double, 4>;  // r, phi (0: hanging), their rates
  const auto slope = [&](const State& s) {
    const double r = s[0];
    return State{
        s[2], s[3],
        r * s[3] * s[3] + kGravity * std::cos(s[1]) - p.stiffness / p.mass * (r - p.length),
        -(kGravity * std::sin(s[1]) + 2 * s[2] * s[3]) / r};
  };
  const auto moved = [](const State& a, double h, const State& d) {
    return State{a[0] + h * d[0], a[1] + h * d[1], a[2] + h * d[2], a[3] + h * d[3]};
  };
  State s{std::hypot(p.x, p.y), std::atan2(p.x, -p.y), 0, 0};
  // h sqrt(k / m) = 1e-3 leaves 1e-12 of a period.
  const int steps = static_cast<int>(std::ceil(time * 1e3 * std::sqrt(p.stiffness / p.mass)));
  const double h = time / steps;
  for (int step = 0; step < steps; ++step) {
    const State k1 = slope(s);
    const State k2 = slope(moved(s, h / 2, k1));
    const State k3 = slope(moved(s, h / 2, k2));
    const State k4 = slope(moved(s, h, k3));
    for (std::size_t i = 0; i < 4; ++i) s[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return {time, s[0] * std::sin(s[1]), -s[0] * std::cos(s[1])};
}

/// Largest distance from the places, on the way [m].
double largest_error(const Pendulum& pendulum, IntegratorKind integrator, double step,
                     const std::vector<Place>& places) {
  reference::SpringSolver solver = make_pendulum(pendulum, integrator);
  double largest = 0;
  double time = 0;
  for (const Place& place : places) {
    const auto steps = std::lround((place.time - time) / step);
    for (long i = 0; i < steps; ++i) (void)solver.step((place.time - time) / steps);
    time = place.time;
    const auto& x = solver.system().bodies[0].positions;
    largest = std::max(largest, std::hypot(x(0, 1) - place.x, x(1, 1) - place.y));
  }
  return largest;
}

void add_trajectory_checks(const CaseInfo& info, const Pendulum& pendulum,
                           const std::vector<Place>& places, const std::string& source,
                           Report& report) {
  struct Method {
    IntegratorKind integrator;
    double step;  ///< times sqrt(m / k) [-]
    Tolerance tolerance;
  };
  const double end = places.back().time * std::sqrt(pendulum.stiffness / pendulum.mass);
  for (const Method& method :
       {Method{IntegratorKind::kRungeKutta4,
               5e-3,
               {2e-8 * std::max(1.0, end / 100), Basis::kTruncation,
                "(w h)^4 / 120 per radian, 1e-9 for 100 radians, and how far apart two ways grow"}},
        Method{IntegratorKind::kVelocityVerlet,
               4e-4,
               {1e-6 * std::max(1.0, end / 100), Basis::kTruncation,
                "(w h)^2 / 24 per radian: 7e-7 for 100 radians"}}}) {
    const double step = method.step * std::sqrt(pendulum.mass / pendulum.stiffness);
    CheckResult check = judged(
        info,
        {fmt::format("{} carries a spring pendulum along its way", name_of(method.integrator)),
         fmt::format("largest distance from it, 0 to {} s", places.back().time),
         "x'' = g - (k / m) (1 - l0 / |x|) x", source, method.tolerance,
         "a force, or a term of the scheme"},
        largest_error(pendulum, method.integrator, step, places));
    check.unit = "m";
    Pendulum stiffer = pendulum;
    stiffer.stiffness *= 1.0001;
    add_sabotage(check, "spring constant +0.01 %",
                 largest_error(stiffer, method.integrator, step, places));
    report.checks.push_back(std::move(check));
  }
}

/// Period over that of a small swing, by the arithmetic-geometric mean.
double period_ratio(double amplitude) {
  double a = 1.0;
  double b = std::cos(amplitude / 2);
  while (std::abs(a - b) > 1e-15) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

constexpr double kStretch = 1e-5;  ///< of the stiff pendulum under its weight [-]

/// Period of a stiff spring pendulum of 1 m, from the time to its lowest point, over 2 pi sqrt(l / g).
double measured_ratio(double amplitude, double gravity_factor) {
  Pendulum stiff;
  stiff.stiffness = stiff.mass * kGravity / (kStretch * stiff.length);
  const double length = stiff.length * (1 + kStretch * std::cos(amplitude));
  stiff.x = length * std::sin(amplitude);
  stiff.y = -length * std::cos(amplitude);
  stiff.stiffness *= gravity_factor;
  reference::SpringSolver solver = make_pendulum(stiff, IntegratorKind::kVelocityVerlet);
  constexpr double kStep = 2e-4;  // [s]: a fifth of the time of the spring
  constexpr int kMaxSteps = 200000;
  double before = stiff.x;
  for (int step = 1; step < kMaxSteps; ++step) {
    (void)solver.step(kStep);
    const double now = solver.system().bodies[0].positions(0, 1);
    if (now <= 0) {
      const double quarter = kStep * (step - 1 + before / (before - now));
      return 4 * quarter / (2 * std::numbers::pi * std::sqrt(stiff.length / kGravity));
    }
    before = now;
  }
  return std::nan("");
}

void add_period_check(const CaseInfo& info, double degrees, Report& report) {
  const double amplitude = degrees * std::numbers::pi / 180;
  const double exact = period_ratio(amplitude);
  CheckResult check =
      judged(info,
             {fmt::format("a stiff pendulum swings as a rigid one, amplitude {} degrees", degrees),
              "relative error of its period",
              "T / T0 = 1 / agm(1, cos(amplitude / 2))",
              "elliptic integral by the arithmetic-geometric mean (Gauss)",
              {1e-4, Basis::kModelGap,
               "the spring stretches by 1e-5 under the weight and by up to 5e-5 at speed"},
              "gravity, or the step of velocity Verlet"},
             ComparedValue{"T / T0", measured_ratio(amplitude, 1.0), exact, "1"});
  add_sabotage(check, "a spring that stretches by 0.1 %",
               std::abs(measured_ratio(amplitude, 0.01) / exact - 1));
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"mass", "kg", "of the bob", 0.1, 10.0, 1.0},
    CaseParameter{"stiffness", "N/m", "of the spring", 20.0, 1000.0, 100.0},
    CaseParameter{"length", "m", "of the spring at rest", 0.5, 2.0, 1.0},
    CaseParameter{"x", "m", "start, sideways from the pivot", -1.5, 1.5, 0.6},
    CaseParameter{"y", "m", "start, above the pivot", -3.0, -0.8, -1.2},
    CaseParameter{"time", "s", "end of the way", 0.1, 5.0, 2.0},
    CaseParameter{"amplitude", "deg", "of the stiff pendulum", 1.0, 170.0, 60.0},
};

}  // namespace
}  // namespace spring_pendulum

std::span<const CaseParameter> spring_pendulum_parameters() {
  using namespace spring_pendulum;
  return kParameters;
}

void evaluate_spring_pendulum(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                              Report& report) {
  using namespace spring_pendulum;
  if (asks_for_point(options)) {
    const auto value = [&](const char* name) { return value_of(info, options, name); };
    const Pendulum pendulum{value("mass"), value("stiffness"), value("length"), value("x"),
                            value("y")};
    add_trajectory_checks(info, pendulum, {exact_place(pendulum, value("time"))},
                          "the same equations in polar coordinates, solved on the spot", report);
    add_period_check(info, value("amplitude"), report);
    return;
  }
  add_trajectory_checks(
      info, {}, {kTable.begin(), kTable.end()},
      "m = 1 kg, k = 100 N/m, l0 = 1 m from (0.6, -1.2) m: tabulated, Runge-Kutta 4", report);
  for (const double degrees : {5.0, 10.0, 30.0, 60.0, 90.0, 120.0, 150.0}) {
    add_period_check(info, degrees, report);
  }
}

}  // namespace weft::validation
