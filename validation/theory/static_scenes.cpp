// Bodies at rest of which a theory knows the shape: a chain, a catenary, a balloon. No engine and no step has a say in an
// equilibrium.
// Tested by tests/validation/theory_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/validation/cases/analytic/statics/catenary.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>
#include <weft/validation/theory/scene_parts.hpp>
#include <weft/validation/theory/theory_scenes.hpp>

namespace weft::validation {
namespace {

TheoryScene chain_scene(int masses, double mass, double stiffness) {
  const double rate = std::sqrt(stiffness / mass);  // [1/s]
  const double slowest = 2 * rate * std::sin(std::numbers::pi / (2 * (2 * masses + 1)));
  constexpr double kSpacing = 0.1;  // [m]
  RopeParts parts;
  parts.springs = masses;
  parts.end = {0, -kSpacing * masses, 0};
  parts.node_mass = mass;
  parts.stiffness = stiffness;
  parts.has_gravity = true;
  parts.rate = 2 * slowest;  // near-critical: the fastest way to rest
  parts.pinned = {0};
  // At the end the slowest mode has decayed by exp(-25).
  const scenes::World world = theory_world(25 / slowest, 0.1 / rate, 3);
  const double exact = mass * kTheoryGravity * masses * (masses + 1) / (2 * stiffness);
  TheoryBound bound;
  bound.claim = fmt::format("in the engine: a chain of {} masses hangs as theory says", masses);
  bound.metric = "relative error of the tip's drop";
  bound.formula = "m g N (N + 1) / (2 k)";
  bound.source = "statics of a hanging chain of springs";
  bound.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    const double drop = -kSpacing * masses - frames.back().cloths[0].positions(1, masses);
    return {{"drop of the tip", drop, exact, "m"}};
  };
  bound.tolerance = [](double) {
    return Tolerance{1e-3, Basis::kRoundoff,
                     "no step has a say in an equilibrium; single precision rounds a place as far "
                     "down as the tip to 1e-5 of its drop, and iterations leave a rest"};
  };
  bound.sabotages = {stiffness_scaled(1.01)};
  return {fmt::format("chain_{}", masses),
          theory_scene("chain", world, rope_cloth(parts), true),
          {bound}};
}

/// A cable of length times the span of 1 m, led to it from the straight line.
TheoryScene catenary_scene(const Cable& cable) {
  constexpr double kWeight = 10.0;   // w [N/m]
  constexpr double kLeadTime = 0.5;  // [s]
  const int n = cable.springs;
  const double spacing = cable.length / n;
  const double line = kWeight / kTheoryGravity;  // mass per length [kg/m]
  RopeParts parts;
  parts.springs = n;
  parts.end = {cable.length, 0, 0};
  parts.node_mass = line * spacing;
  parts.stiffness = cable.stiffness * kWeight / spacing;
  parts.has_gravity = true;
  const CableShape exact = exact_cable(cable);
  // The slowest swing is about that of a string under this tension; critically damped.
  const double slowest = std::numbers::pi * std::sqrt(std::max(exact.pull, 0.1) * kWeight / line);
  parts.rate = 2 * slowest;
  parts.pinned = {0, n};
  scenes::Cloth cloth = rope_cloth(parts);
  if (cable.length != 1.0) {
    cloth.pins = {scenes::NodePin{{0}}};
    cloth.moving_pins = {led_node(n, parts.end, {1, 0, 0}, kLeadTime)};
  }
  const double fastest = 2 * std::sqrt(parts.stiffness / parts.node_mass);
  const scenes::World world = theory_world(kLeadTime + 25 / slowest, 0.8 / fastest, 3);
  TheoryBound bound;
  bound.claim = fmt::format("in the engine: a chain of {} d, EA = {} w d, hangs as the catenary",
                            cable.length, cable.stiffness);
  bound.metric = fmt::format("relative error of the sag, N = {}", n);
  bound.formula = "d = H L0 / EA + (2 H / w) asinh(w L0 / (2 H))";
  bound.source = "elastic catenary, solved on the spot";
  bound.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    return {{"sag", -frames.back().cloths[0].positions.row(1).minCoeff(), exact.sag, "m"}};
  };
  bound.tolerance = [n](double) {
    return Tolerance{1e-3 * std::max(1.0, std::pow(100.0 / n, 2)), Basis::kTruncation,
                     "second order in the springs: 1e-3 for 100; no step has a say"};
  };
  bound.sabotages = {
      law_scaled("gravity +5 % and springs 10 % softer", "tension", "stiffness", 0.8)};
  bound.sabotages[0].name = "springs 20 % softer";
  return {fmt::format("cable_{:.0f}_{:.0f}", 100 * cable.length, cable.stiffness),
          theory_scene("cable", world, std::move(cloth), true),
          {bound}};
}

/// dp R0 / k of a triangular lattice of springs, stretched by 1 + e.
double load_of_lattice(double e) {
  return 2 * std::sqrt(3.0) * e / ((1 + e) * (1 + e));
}

double volume_of(const Matrix3X<double>& x, const Triangles& triangles) {
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vector3<double> a = x.col(triangles(0, t));
    const Vector3<double> b = x.col(triangles(1, t));
    const Vector3<double> c = x.col(triangles(2, t));
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

TheoryScene balloon_scene(double target) {
  constexpr double kRadius = 1.0;       // [m]
  constexpr double kStiffness = 100.0;  // [N/m]
  constexpr double kNodeMass = 0.12;    // [kg]
  constexpr double kRate = 5.0;         // [1/s]
  Icosphere ball;
  ball.radius = kRadius;
  ball.frequency = 8;
  ball.lumping = MassLumping::kUniform;
  ball.total_mass = kNodeMass * (10 * ball.frequency * ball.frequency + 2);
  scenes::Cloth cloth;
  cloth.name = "balloon";
  cloth.source = ball;
  forces::LawSpecification tension = tension_law(kStiffness);
  tension.sets = {"stretch"};
  const double pressure = load_of_lattice(target) * kStiffness / kRadius * std::pow(1 + target, 3);
  cloth.laws = {tension, {"pressure", {}, {{"pressure", {pressure}}}}, velocity_damping_law(kRate)};
  const ClothMesh mesh = make_mesh(cloth);
  const double rest = volume_of(mesh.rest_positions, mesh.triangles);
  TheoryBound bound;
  bound.claim = fmt::format("in the engine: a balloon of springs is blown up to e = {}", target);
  bound.metric = "relative error of its stretch";
  bound.formula = "p0 R0 / (k (1 + e)^3) = 2 sqrt(3) e / (1 + e)^2, e = (V / V0)^(1/3) - 1";
  bound.source = "Laplace's law with the tension of a triangular lattice; Boyle's law";
  bound.values = [=, triangles = Triangles(mesh.triangles)](
                     const Frames& frames) -> std::vector<ComparedValue> {
    const double volume = volume_of(frames.back().cloths[0].positions, triangles);
    return {{"stretch e", std::cbrt(volume / rest) - 1, target, "1"}};
  };
  bound.tolerance = [](double) {
    return Tolerance{0.01, Basis::kTruncation,
                     "the icosphere of 642 nodes is no lattice of equal triangles: the sum of its "
                     "squared edges is 0.7 % larger; no step has a say"};
  };
  bound.sabotages = {stiffness_scaled(1.1)};
  return {fmt::format("balloon_{:.0f}", 100 * target),
          theory_scene("balloon", theory_world(8.0, 0.01, 6), std::move(cloth), false),
          {bound}};
}

}  // namespace

std::vector<TheoryScene> chain_scenes(const CaseInfo& info, const CaseOptions& options) {
  if (asks_for_point(options)) {
    return {chain_scene(static_cast<int>(value_of(info, options, "masses")),
                        value_of(info, options, "mass"), value_of(info, options, "stiffness"))};
  }
  return {chain_scene(1, 0.1, 1000), chain_scene(10, 0.1, 1000), chain_scene(30, 0.1, 1000)};
}

std::vector<TheoryScene> catenary_scenes(const CaseInfo& info, const CaseOptions& options) {
  constexpr int kSprings = 50;
  if (asks_for_point(options)) {
    return {catenary_scene({value_of(info, options, "length"), value_of(info, options, "stiffness"),
                            static_cast<int>(value_or(options, "nodes", kSprings))})};
  }
  return {catenary_scene({1.0, 10, kSprings}), catenary_scene({1.0, 100, kSprings}),
          catenary_scene({1.2, 120, kSprings})};
}

std::vector<TheoryScene> balloon_scenes(const CaseInfo& info, const CaseOptions& options) {
  if (asks_for_point(options)) return {balloon_scene(value_of(info, options, "stretch"))};
  return {balloon_scene(0.1), balloon_scene(0.5)};
}

}  // namespace weft::validation
