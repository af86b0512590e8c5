// Bodies that move as a theory says: oscillators, pendulums, strings, a membrane, a strip, a cloth in free flight. What a step
// may do to a period and to an energy follows from the order of the method.
// Tested by tests/validation/theory_test.cpp.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>
#include <weft/validation/theory/bending_scenes.hpp>
#include <weft/validation/theory/scene_parts.hpp>
#include <weft/validation/theory/swing_fit.hpp>
#include <weft/validation/theory/theory_scenes.hpp>

namespace weft::validation {
namespace {

/// What a second-order method may do to the frequency of a mode.
Tolerance period_tolerance(double omega, double time_step, double rest) {
  const double phase = omega * time_step;
  return {phase * phase / 2 + rest, Basis::kTruncation,
          "(w h)^2 / 2, and what the theory leaves out: a method of second order is off by (w h)^2 "
          "times 1 / 24 (explicit) to 1 / 3 (BDF2)"};
}

/// What it may take from the energy in one period of a swing with this decay of its amplitude [1/s].
Tolerance energy_tolerance(double omega, double decay, double time_step, double rest) {
  const double phase = omega * time_step;
  const double damped =
      2 * decay * (2 * std::numbers::pi / omega) * phase * phase;  // of the decay itself
  return {
      1.5 * (std::numbers::pi * phase * phase * phase + damped) + rest, Basis::kTruncation,
      "1.5 (pi (w h)^3 + 2 delta T (w h)^2), and what the theory leaves out: BDF2 loses pi (w h)^3 "
      "in a period and is off by (w h)^2 of a decay, other methods of second order by less, "
      "implicit Euler loses 2 pi w h"};
}

using Amplitude = std::function<double(const scenes::SceneState&)>;

/// Part of a run from begin on [s]; its frames lie interval apart [s].
std::vector<double> samples(const Frames& frames, double begin, const Amplitude& amplitude) {
  std::vector<double> values;
  for (const scenes::SceneState& frame : frames) {
    if (frame.time >= begin - 1e-9) values.push_back(amplitude(frame));
  }
  return values;
}

struct Swing {
  std::string what;     ///< "a stiff pendulum"
  std::string formula;  ///< of w
  std::string source;
  double omega = 1.0;  ///< exact [rad/s]
  double decay = 0.0;  ///< exact, of the amplitude [1/s]
  double rest =
      1e-3;  ///< what the theory leaves out, of the frequency and of the energy of a period [-]
  double begin = 0.0;  ///< [s]: from then on it swings freely
  Amplitude amplitude;
  Sabotage other_frequency;
};

/// Frequency, and energy left after a period.
std::vector<TheoryBound> swing_bounds(const Swing& swing) {
  const auto fit = [swing](const Frames& frames) {
    const std::vector<double> values = samples(frames, swing.begin, swing.amplitude);
    const double interval = frames.size() > 1 ? frames[1].time - frames[0].time : 1.0;
    return fit_swing(values, interval);
  };
  const double period = 2 * std::numbers::pi / swing.omega;
  const double left = std::exp(-2 * swing.decay * period);
  TheoryBound frequency;
  frequency.claim = fmt::format("in the engine: {} has its frequency", swing.what);
  frequency.metric = "relative error of its frequency";
  frequency.formula = swing.formula;
  frequency.source = swing.source;
  frequency.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    return {{"w", fit(frames).frequency, swing.omega, "rad/s"}};
  };
  frequency.tolerance = [=](double h) { return period_tolerance(swing.omega, h, swing.rest); };
  frequency.sabotages = {swing.other_frequency};
  TheoryBound energy;
  energy.claim = fmt::format("in the engine: {} keeps its energy", swing.what);
  energy.metric = "relative error of the energy left after one period";
  energy.formula = swing.decay > 0 ? "e^(-2 delta T)" : "1";
  energy.source = swing.source;
  energy.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    return {{"energy left after a period", std::exp(-2 * fit(frames).decay * period), left, "1"}};
  };
  energy.tolerance = [=](double h) {
    return energy_tolerance(swing.omega, swing.decay, h, swing.rest);
  };
  // Half of the energy is lost in a period.
  energy.sabotages = {drag_added(std::log(2.0) / period)};
  return {frequency, energy};
}

TheoryScene oscillator_scene(double mass, double stiffness, double damping, double rate) {
  const double natural = std::sqrt(stiffness / mass);
  const double decay = 0.5 * (damping / mass + rate);
  RopeParts parts;
  parts.node_mass = mass;
  parts.stiffness = stiffness;
  parts.damping = damping;
  parts.rate = rate;
  parts.pinned = {0};
  scenes::Cloth cloth = rope_cloth(parts);
  constexpr double kAmplitude = 0.1;  // [m], of a spring of 1 m
  cloth.velocity = {kAmplitude * natural, 0, 0};
  Swing swing;
  swing.omega = std::sqrt(natural * natural - decay * decay);
  swing.decay = decay;
  swing.what = decay > 0
                   ? fmt::format("a damped mass on a spring, w = {:.4g} rad/s, delta = {:.4g} 1/s,",
                                 swing.omega, decay)
                   : fmt::format("a mass on a spring, w = {:.4g} rad/s,", swing.omega);
  swing.formula = "w^2 = k / m - delta^2, delta = c / (2 m) + gamma / 2";
  swing.source = "damped harmonic oscillator";
  swing.amplitude = [](const scenes::SceneState& state) {
    return state.cloths[0].positions(0, 1) - 1.0;
  };
  swing.other_frequency = stiffness_scaled(1.5);
  const scenes::World world =
      theory_world(8 * 2 * std::numbers::pi / swing.omega, 0.05 / natural, 1);
  return {decay > 0 ? "damped" : "free", theory_scene("oscillator", world, cloth, false),
          swing_bounds(swing)};
}

/// Period over that of a small swing, by the arithmetic-geometric mean.
double pendulum_period_ratio(double amplitude) {
  double a = 1.0;
  double b = std::cos(amplitude / 2);
  while (std::abs(a - b) > 1e-15) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

TheoryScene pendulum_scene(double degrees) {
  constexpr double kLength = 1.0;     // [m]
  constexpr double kMass = 1.0;       // [kg]
  constexpr double kStiffness = 1e5;  // [N/m]: stretches by 1e-4 under the weight
  constexpr double kDamping = 20.0;   // of the spring [N s/m]: a swing does not feel it
  const double angle = degrees * std::numbers::pi / 180;
  RopeParts parts;
  parts.end = {kLength * std::sin(angle), -kLength * std::cos(angle), 0};
  parts.node_mass = kMass;
  parts.stiffness = kStiffness;
  parts.damping = kDamping;
  parts.has_gravity = true;
  parts.pinned = {0};
  const double small = std::sqrt(kTheoryGravity / kLength);
  const double period = 2 * std::numbers::pi / small * pendulum_period_ratio(angle);
  // The fastest turn is this quick, and errors of a step go with it.
  const double omega = small * std::max(1.0, 2 * std::sin(angle / 2));
  const double rest = 2e-3;
  constexpr int kPeriods = 5;
  const scenes::World world = theory_world((kPeriods + 0.9) * period, 1.0 / 2000, 1);
  const std::string what = fmt::format("a stiff pendulum, amplitude {:.4g} degrees,", degrees);
  TheoryBound time;
  time.claim = fmt::format("in the engine: {} has its period", what);
  time.metric = "relative error of its period";
  time.formula = "T = 2 pi sqrt(l / g) / agm(1, cos(amplitude / 2))";
  time.source = "elliptic integral by the arithmetic-geometric mean (Gauss)";
  time.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    const double interval = frames.size() > 1 ? frames[1].time - frames[0].time : 1.0;
    const std::vector<double> x = samples(
        frames, 0, [](const scenes::SceneState& state) { return state.cloths[0].positions(0, 1); });
    return {{"T", period_of(x, interval), period, "s"}};
  };
  time.tolerance = [=](double h) { return period_tolerance(omega, h, rest); };
  time.sabotages = {law_scaled("gravity +20 %", "gravity", "acceleration", 1.2)};
  TheoryBound energy;
  energy.claim = fmt::format("in the engine: {} keeps its energy", what);
  energy.metric =
      fmt::format("relative error of the energy left after one period, from {} of them", kPeriods);
  energy.formula = "1";
  energy.source = "conservation of energy";
  energy.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    // Height above the lowest point and speed. The spring has next to nothing, once it carries the weight.
    const auto of = [](const scenes::SceneState& state) {
      const scenes::ClothState& bob = state.cloths[0];
      const double lowest = kLength + kMass * kTheoryGravity / kStiffness;
      return kTheoryGravity * (bob.positions(1, 1) + lowest) +
             0.5 * bob.velocities.col(1).squaredNorm();
    };
    constexpr double kSettled = 0.5;  // [s]
    const double interval = frames[1].time - frames[0].time;
    const auto first = static_cast<std::size_t>(std::ceil(kSettled / interval));
    const std::size_t last = std::min(
        frames.size() - 1,
        first + static_cast<std::size_t>(std::lround((kPeriods - 0.5) * period / interval)));
    const double periods = (frames[last].time - frames[first].time) / period;
    return {{"energy left after a period",
             std::pow(of(frames[last]) / of(frames[first]), 1 / periods), 1.0, "1"}};
  };
  energy.tolerance = [=](double h) { return energy_tolerance(omega, 0.0, h, rest); };
  energy.sabotages = {drag_added(std::log(2.0) / period)};
  return {fmt::format("swing_{:.0f}", degrees),
          theory_scene("pendulum", world, rope_cloth(parts), true),
          {time, energy}};
}

/// L_n(x), by its recurrence.
double laguerre(int n, double x) {
  double before = 1.0;
  double now = 1 - x;
  if (n == 0) return before;
  for (int k = 1; k < n; ++k) {
    const double next = ((2 * k + 1 - x) * now - k * before) / (k + 1);
    before = now;
    now = next;
  }
  return now;
}

/// Beads on a stiff string that hangs: its slowest swing.
TheoryScene hanging_string_scene(int beads) {
  constexpr double kSpacing = 0.1;  // [m]
  constexpr double kMass = 0.1;     // [kg]
  constexpr double kStiffness = 1e5;
  constexpr double kAngle = 0.03;  // [rad]
  // The smallest root of L_n: by bisection from 0, where it is 1, to 1 / n + ..., below 1.5 / n always.
  double low = 0;
  double high = 2.0 / beads;
  while (laguerre(beads, high) > 0) high *= 1.05;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (laguerre(beads, middle) > 0 ? low : high) = middle;
  }
  const double lambda = 0.5 * (low + high);
  RopeParts parts;
  parts.springs = beads;
  parts.end = kSpacing * beads * Vector3<double>(std::sin(kAngle), -std::cos(kAngle), 0);
  parts.node_mass = kMass;
  parts.stiffness = kStiffness;
  parts.damping = 20;
  parts.has_gravity = true;
  parts.pinned = {0};
  Swing swing;
  swing.what = fmt::format("a hanging string of {} beads in its slowest swing", beads);
  swing.formula = "w^2 = x g / a, L_N(x) = 0 (Laguerre)";
  swing.source = "Bernoulli's hanging chain, of beads";
  swing.omega = std::sqrt(lambda * kTheoryGravity / kSpacing);
  swing.rest = 3e-3;  // strings stretch by up to 1e-4 N of a spacing, slopes are up to 0.05
  VectorX<double> mode(beads + 1);
  for (int i = 0; i <= beads; ++i) mode[i] = laguerre(beads - i, lambda);
  swing.amplitude = [mode](const scenes::SceneState& state) {
    return state.cloths[0].positions.row(0).dot(mode);
  };
  swing.other_frequency = law_scaled("gravity +20 %", "gravity", "acceleration", 1.2);
  const scenes::World world = theory_world(5 * 2 * std::numbers::pi / swing.omega, 1.0 / 3000, 1);
  return {fmt::format("beads_{}", beads), theory_scene("beads", world, rope_cloth(parts), true),
          swing_bounds(swing)};
}

constexpr double kMotionScenesStrain =
    0.2;                            // of strings and membranes: rest length = (1 - strain) length
constexpr double kLeadTime = 2.0;   // [s], until they are stretched
constexpr double kSideways = 0.02;  // [m/s]

/// A string between two walls, drawn apart at the start, that then vibrates across itself.
TheoryScene string_scene(int masses) {
  constexpr double kSpacing = 0.1;  // [m], stretched
  constexpr double kMass = 0.1;     // [kg]
  constexpr double kStiffness = 400.0;
  const int n = masses + 1;
  const double tension = kStiffness * kSpacing * kMotionScenesStrain;
  RopeParts parts;
  parts.springs = n;
  parts.end = {n * kSpacing * (1 - kMotionScenesStrain), 0, 0};
  parts.node_mass = kMass;
  parts.stiffness = kStiffness;
  parts.damping = 0.5;  // stretching dies away, and a small swing across does not feel it
  parts.pinned = {0};
  scenes::Cloth cloth = rope_cloth(parts);
  cloth.moving_pins = {led_node(n, parts.end, {n * kSpacing, 0, 0}, kLeadTime)};
  cloth.velocity = {0, kSideways, 0};
  Swing swing;
  swing.what = fmt::format("a string of {} masses in its first mode", masses);
  swing.formula = "w = 2 sqrt(T / (m a)) sin(pi / (2 (N + 1)))";
  swing.source = "eigenvalues of a row of springs";
  swing.omega = 2 * std::sqrt(tension / (kMass * kSpacing)) * std::sin(std::numbers::pi / (2 * n));
  swing.rest = 3e-3;
  swing.begin = kLeadTime + 1.0;
  swing.amplitude = [n](const scenes::SceneState& state) {
    double sum = 0;
    for (int i = 0; i <= n; ++i)
      sum += std::sin(std::numbers::pi * i / n) * state.cloths[0].positions(1, i);
    return sum;
  };
  swing.other_frequency = stiffness_scaled(1.5);
  const scenes::World world = theory_world(swing.begin + 5 * 2 * std::numbers::pi / swing.omega,
                                           0.25 / std::sqrt(kStiffness / kMass), 1);
  return {fmt::format("string_{}", masses), theory_scene("string", world, cloth, false),
          swing_bounds(swing)};
}

/// A square net whose rim is drawn apart at the start, and that then vibrates across itself.
TheoryScene membrane_scene(int cells) {
  constexpr double kTension = 1.0;  // per width [N/m]
  constexpr double kDensity = 0.2;  // stretched, of a square of 1 m [kg/m^2]
  constexpr double kStiffness = kTension / kMotionScenesStrain;
  scenes::Cloth cloth;
  cloth.name = "membrane";
  ClothGrid grid;
  grid.nodes = {cells + 1, cells + 1};
  grid.size = {1 - kMotionScenesStrain, 1 - kMotionScenesStrain};
  grid.stencil = GridStencil::k8Neighbour;
  grid.total_mass = kDensity;
  cloth.source = grid;
  cloth.collision_margin = 1e-3;
  const ClothMesh mesh = make_cloth_grid(grid);
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      if (i > 0 && j > 0 && i < cells && j < cells) continue;
      const int node = grid_node(grid, i, j);
      const Vector3<double> from = mesh.rest_positions.col(node);
      cloth.moving_pins.push_back(
          led_node(node, from, from / (1 - kMotionScenesStrain), kLeadTime));
    }
  }
  cloth.velocity = {0, kSideways, 0};
  forces::LawSpecification tension = tension_law(kStiffness);
  tension.sets = {"stretch"};
  forces::LawSpecification damper = spring_damping_law(0.02);
  damper.sets = {"stretch"};
  cloth.laws = {tension, damper};
  Swing swing;
  swing.what = fmt::format("a membrane of {} x {} cells in its first mode", cells, cells);
  swing.formula = "w^2 = 8 T / (rho a^2) sin^2(pi a / (2 L))";
  swing.source = "eigenvalues of a net of springs";
  const double cell = 1.0 / cells;
  swing.omega =
      std::sqrt(8 * kTension / (kDensity * cell * cell)) * std::sin(std::numbers::pi / (2 * cells));
  swing.rest = 3e-3;
  swing.begin = kLeadTime + 1.0;
  swing.amplitude = [grid, cells](const scenes::SceneState& state) {
    double sum = 0;
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        sum += std::sin(std::numbers::pi * i / cells) * std::sin(std::numbers::pi * j / cells) *
               state.cloths[0].positions(1, grid_node(grid, i, j));
      }
    }
    return sum;
  };
  swing.other_frequency = stiffness_scaled(1.5);
  const scenes::World world =
      theory_world(swing.begin + 5 * 2 * std::numbers::pi / swing.omega, 1.0 / 600, 1);
  return {fmt::format("membrane_{}", cells), theory_scene("membrane", world, cloth, false),
          swing_bounds(swing)};
}

/// A clamped strip that nothing pulls, in its first mode.
TheoryScene beam_scene(int cells) {
  StripScene strip;
  strip.cells = cells;
  strip.rigidity = 3.1392e-3;
  strip.stiffness = 1e3;
  scenes::Cloth cloth = strip_cloth(strip);
  cloth.velocity = {0, kSideways, 0};
  constexpr double kBeta = 1.8751040687119611;
  const ClothGrid grid = strip_grid(strip);
  const ClothMesh mesh = make_cloth_grid(grid);
  VectorX<double> mode(mesh.num_nodes());
  const double share = (std::cos(kBeta) + std::cosh(kBeta)) / (std::sin(kBeta) + std::sinh(kBeta));
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const double s = kBeta * std::max(0.0, mesh.rest_positions(0, node)) / strip.length;
    mode[node] =
        mesh.masses[node] * (std::cosh(s) - std::cos(s) - share * (std::sinh(s) - std::sin(s)));
  }
  Swing swing;
  swing.what = fmt::format("a clamped strip of {} cells in its first mode", cells);
  swing.formula = "w = beta^2 sqrt(D / (rho L^4)), cos beta cosh beta = -1";
  swing.source = "Euler-Bernoulli cantilever";
  swing.omega =
      kBeta * kBeta * std::sqrt(strip.rigidity / (strip.area_density * std::pow(strip.length, 4)));
  swing.rest = 1e-3 * std::max(1.0, std::pow(120.0 / cells, 2));  // second order in the cells
  swing.amplitude = [mode](const scenes::SceneState& state) {
    return state.cloths[0].positions.row(1).dot(mode);
  };
  swing.other_frequency = law_scaled("rigidity +50 %", "hinge_torsion", "rigidity", 1.5);
  const scenes::World world =
      theory_world(6 * 2 * std::numbers::pi / swing.omega, strip_step(strip), 1);
  return {fmt::format("beam_{}", cells), theory_scene("beam", world, cloth, false),
          swing_bounds(swing)};
}

/// A cloth thrown upwards: with gravity its mean height, without its mean velocity.
TheoryScene flight_scene(bool has_gravity) {
  constexpr double kSpeed = 5.0;  // [m/s]
  constexpr double kTime = 0.5;   // [s]
  ClothGrid grid;
  grid.nodes = {9, 9};
  grid.size = {0.5, 0.5};
  grid.total_mass = 0.05;
  scenes::Cloth cloth;
  cloth.name = "cloth";
  cloth.source = grid;
  cloth.velocity = {0, kSpeed, 0};
  cloth.laws = {tension_law(20.0)};
  if (has_gravity) cloth.laws.push_back(gravity_law({0, -kTheoryGravity, 0}));
  const double pull = has_gravity ? kTheoryGravity : 0.0;
  const double height = kSpeed * kTime - 0.5 * pull * kTime * kTime;
  const double speed = kSpeed - pull * kTime;
  const VectorX<double> masses = make_cloth_grid(grid).masses;
  TheoryBound way;
  way.claim = has_gravity ? "in the engine: a cloth thrown up at 5 m/s rises as a stone does"
                          : "in the engine: a cloth thrown at 5 m/s flies on at 5 m/s";
  way.metric = "relative error of the way of its centre of mass in 0.5 s";
  way.formula = has_gravity ? "v t - g t^2 / 2" : "v t";
  way.source = "free flight";
  way.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    const scenes::ClothState& end = frames.back().cloths[0];
    const double mass = masses.sum();
    return {{"way of the centre of mass", end.positions.row(1).dot(masses) / mass, height, "m"},
            {"its velocity", end.velocities.row(1).dot(masses) / mass, speed, "m/s"}};
  };
  way.tolerance = [=](double h) {
    return Tolerance{1e-4 + 1.05 * pull * h * kTime / 2 / height, Basis::kTruncation,
                     "momentum is kept in any step; of the fall a method of first order misses "
                     "g h t / 2"};
  };
  way.sabotages = {initial_velocity_unset(), drag_added(2.0)};
  return {has_gravity ? "thrown" : "flying",
          theory_scene("flight", theory_world(kTime, 1.0 / 600, 3), cloth, has_gravity),
          {way}};
}

}  // namespace

std::vector<TheoryScene> oscillator_scenes(const CaseInfo& info, const CaseOptions& options) {
  if (asks_for_point(options)) {
    refuse_values(info, options, {"time-step", "steps"});
    return {oscillator_scene(value_of(info, options, "mass"), value_of(info, options, "stiffness"),
                             value_of(info, options, "damping"), value_of(info, options, "rate"))};
  }
  return {oscillator_scene(0.3, 40.0, 0.0, 0.0), oscillator_scene(0.3, 40.0, 0.3, 0.0)};
}

std::vector<TheoryScene> pendulum_scenes(const CaseInfo& info, const CaseOptions& options) {
  if (asks_for_point(options)) {
    refuse_values(info, options, {"mass", "stiffness", "length", "x", "y", "time"});
    return {pendulum_scene(value_of(info, options, "amplitude"))};
  }
  return {pendulum_scene(5), pendulum_scene(60), pendulum_scene(120)};
}

std::vector<TheoryScene> vibration_scenes(const CaseInfo& info, const CaseOptions& options) {
  if (asks_for_point(options)) {
    refuse_values(info, options, {"mode"});
    const auto whole = [&](const char* name, int chosen) {
      return static_cast<int>(value_or(options, name, chosen));
    };
    constexpr int kMostCells = 24;  // a scene has room for 100 pins, one for each node of the rim
    if (whole("cells", 12) > kMostCells) {
      throw InvalidArgument(
          fmt::format("validate: case '{}': cells = {}, expected at most {} for '{}'", info.id,
                      whole("cells", 12), kMostCells, options.engine));
    }
    return {string_scene(whole("masses", 20)), membrane_scene(whole("cells", 12)),
            beam_scene(whole("nodes", 32))};
  }
  return {hanging_string_scene(10), string_scene(20), membrane_scene(12), beam_scene(32)};
}

std::vector<TheoryScene> flight_scenes(const CaseInfo&, const CaseOptions&) {
  return {flight_scene(false), flight_scene(true)};
}

}  // namespace weft::validation
