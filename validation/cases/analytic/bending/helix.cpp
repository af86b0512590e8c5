// Rods with three-point torsion: a helix under Love's force and couple, and a straight rod that is bent to a ring.
// Tested by tests/validation/theory_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/reference/statics/static_solver.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace helix {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 0.02;    // r [m]
constexpr double kRigidity = 1e-6;  // B [N m^2]

reference::Body make_rod(const Matrix3X<double>& rest, double spacing, double rigidity) {
  reference::Body body;
  body.name = "rod";
  const auto n = static_cast<int>(rest.cols());
  body.mesh.rest_positions = rest;
  body.mesh.masses = VectorX<double>::Ones(n);
  body.mesh.triangles.resize(3, 0);
  Edges edges(2, n - 1);
  Triples triples(3, n - 2);
  for (int i = 0; i < n; ++i) {
    if (i > 0) edges.col(i - 1) << i - 1, i;
    if (i > 1) triples.col(i - 2) << i - 2, i - 1, i;
  }
  body.mesh.edge_sets.push_back({"row", edges});
  body.mesh.line_sets.push_back({"rod", triples});
  // B = k a^3
  body.laws.add(forces::make_law<double>(
      {"torsion", {}, {{"stiffness", {rigidity / std::pow(spacing, 3)}}}}, body.mesh));
  return body;
}

struct Helix {
  double pitch = 30.0;           ///< angle alpha of the rod to the plane across the axis [deg]
  double natural = 0.5;          ///< kappa0 r: curvature of the rod when nothing acts [-]
  int nodes = 60;                ///< per turn
  double rigidity_factor = 1.0;  ///< sabotage
  bool is_straight = false;      ///< sabotage: the natural curvature is forgotten
};

/// A planar arc of nodes at equal distances, whose hinges turn as a circle of this curvature has them.
Matrix3X<double> arc(int nodes, double spacing, double curvature) {
  Matrix3X<double> places = Matrix3X<double>::Zero(3, nodes);
  const double turn = 2 * std::asin(spacing * curvature / 2);
  for (int i = 1; i < nodes; ++i) {
    const double angle = turn * (i - 1);
    places.col(i) =
        places.col(i - 1) + spacing * Vector3<double>(std::cos(angle), std::sin(angle), 0);
  }
  return places;
}

/// Force along the axis and couple about it that a rod of no twisting rigidity hands on at a cut, relative
/// errors, and what is left on its nodes over P a / r.
struct HelixTest {
  double force_error = 0.0;
  double couple_error = 0.0;
  double unbalance = 0.0;
  ComparedValue force = {};
  ComparedValue couple = {};
};

HelixTest test_helix(const Helix& helix) {
  const double alpha = helix.pitch * kPi / 180;
  const int nodes = 2 * helix.nodes + 1;
  const double step = 2 * kPi / helix.nodes;  // about the axis, per node
  const double rise = kRadius * std::tan(alpha) * step;
  Matrix3X<double> places(3, nodes);
  for (int i = 0; i < nodes; ++i) {
    places.col(i) << kRadius * std::cos(i * step), kRadius * std::sin(i * step), i * rise;
  }
  const double spacing = (places.col(1) - places.col(0)).norm();
  const double curvature = std::pow(std::cos(alpha), 2) / kRadius;
  const double natural = helix.natural / kRadius;
  reference::Body body = make_rod(arc(nodes, spacing, helix.is_straight ? 0.0 : natural), spacing,
                                  helix.rigidity_factor * kRigidity);
  const reference::StaticProblem problem = reference::static_problem(body, 1.0);
  Matrix3X<double> force(3, nodes);
  problem.forces(places, force);
  // Love: of a rod with C = 0.
  const double axial = -kRigidity * (curvature - natural) * std::sin(alpha) / kRadius;
  const double couple = kRigidity * (curvature - natural) * std::cos(alpha);
  // The springs of the rod carry the part of the axial force along it.
  const double tension = axial * std::sin(alpha);
  HelixTest result;
  Vector3<double> cut_force(0, 0, 0);
  Vector3<double> cut_couple(0, 0, 0);
  const int cut = helix.nodes;
  const auto tangent = [&](int i) -> Vector3<double> {
    return (places.col(i + 1) - places.col(i)).normalized();
  };
  for (int i = 0; i <= cut; ++i) {
    cut_force += force.col(i);
    cut_couple += Vector3<double>(places.col(i)).cross(Vector3<double>(force.col(i)));
    if (i < 3) continue;
    const Vector3<double> rest = force.col(i) + tension * (tangent(i) - tangent(i - 1));
    result.unbalance =
        std::max(result.unbalance, rest.norm() / (std::abs(axial) * spacing / kRadius));
  }
  cut_force += tension * tangent(cut);
  cut_couple += tension * Vector3<double>(places.col(cut)).cross(tangent(cut));
  // What acts on this half is what it hands on.
  result.force_error = (cut_force - Vector3<double>(0, 0, axial)).norm() / std::abs(axial);
  result.couple_error = std::abs(cut_couple.z() / couple - 1);
  result.couple = {"couple", cut_couple.z(), couple, "N m"};
  result.force = {"axial force", cut_force.z(), axial, "N"};
  return result;
}

void add_helix_checks(const CaseInfo& info, const Helix& helix, Report& report) {
  const Tolerance tolerance{4e-3 * std::pow(60.0 / helix.nodes, 2), Basis::kTruncation,
                            "second order in the spacing"};
  Helix softer = helix;
  softer.rigidity_factor = 0.9;
  Helix straight = helix;
  straight.is_straight = true;
  const std::string what = fmt::format("pitch {} degrees, kappa0 r = {}, {} nodes per turn",
                                       helix.pitch, helix.natural, helix.nodes);
  const HelixTest right = test_helix(helix);
  const auto add = [&](const std::string& claim, const std::string& metric,
                       const std::string& formula, double HelixTest::*part) {
    CheckResult check =
        judged(info,
               {claim + ", " + what, metric, formula,
                "Love 1927, section 270, for a rod without twisting rigidity", tolerance,
                "the torsion law's directions or its rest angle", "laws"},
               right.*part);
    if (part == &HelixTest::force_error) check.values = {right.force};
    if (part == &HelixTest::couple_error) check.values = {right.couple};
    add_sabotage(check, "rigidity -10 %", test_helix(softer).*part);
    if (helix.natural > 0) {
      add_sabotage(check, "natural curvature forgotten", test_helix(straight).*part);
    }
    report.checks.push_back(std::move(check));
  };
  add("a helix needs Love's force along its axis", "|force at a cut - P| / P",
      "P = -B (kappa - kappa0) sin(alpha) / r, kappa = cos^2(alpha) / r", &HelixTest::force_error);
  add("a helix needs Love's couple about its axis", "relative error of the couple at a cut",
      "M = B (kappa - kappa0) cos(alpha)", &HelixTest::couple_error);
  add("under them no node of a helix moves", "largest force on an inner node over P a / r", "0",
      &HelixTest::unbalance);
}

void add_order_check(const CaseInfo& info, Report& report) {
  const auto order = [](const Helix& first) {
    Helix fine = first;
    fine.nodes *= 2;
    return std::log2(test_helix(first).force_error / test_helix(fine).force_error);
  };
  CheckResult check = judged(info,
                             {"the error of Love's force falls with the square of the spacing",
                              "|observed order - 2|, 60 and 120 nodes per turn",
                              "p = log2(e(a) / e(a / 2))",
                              "Love 1927, section 270",
                              {0.15, Basis::kTruncation, "the next term of the error"},
                              "the torsion law",
                              "laws"},
                             std::abs(order({}) - 2));
  add_sabotage(check, "rigidity -3 %", std::abs(order({.rigidity_factor = 0.97}) - 2));
  report.checks.push_back(std::move(check));
}

/// With more the residual drowns in the rounding of the springs.
constexpr int kRingSegments = 60;

/// A straight rod whose last segment is led round to its first, from a start that is no circle but
/// lies in its plane: without a twisting rigidity little holds the rod there.
struct Ring {
  double roundness = 0.0;     ///< largest |radius / mean - 1|
  double couple_error = 0.0;  ///< of the couple that holds its ends
  ComparedValue couple = {};
};

Ring close_ring(int segments, double rigidity_factor, bool is_solved = true) {
  const double spacing = 2 * kPi * kRadius / segments;
  Matrix3X<double> straight = Matrix3X<double>::Zero(3, segments + 2);
  for (int i = 0; i < segments + 2; ++i) straight(0, i) = i * spacing;
  reference::Body body = make_rod(straight, spacing, rigidity_factor * kRigidity);
  const double spring = 1e4 * kRigidity / std::pow(spacing, 3);
  body.laws.add(forces::make_law<double>(tension_law(spring), body.mesh));
  body.mesh.pinned = {0, 1, segments, segments + 1};
  // A polygon of the rod's own segments; its last segment lies on its first.
  const double polygon = spacing / (2 * std::sin(kPi / segments));
  Matrix3X<double> places(3, segments + 2);
  for (int i = 0; i < segments + 2; ++i) {
    const double angle = 2 * kPi * i / segments;
    const bool is_held = i < 2 || i >= segments;
    const double radius = is_held ? polygon : polygon * (1 + 0.1 * std::sin(2 * angle));
    places.col(i) << radius * std::cos(angle), radius * std::sin(angle), 0;
  }
  const double load = kRigidity / (kRadius * kRadius);
  const reference::StaticProblem problem = reference::static_problem(body, load);
  reference::StaticOptions options;
  options.residual = 1e-9;
  options.max_move = 0.2 * kRadius;
  if (is_solved && !reference::solve_statics(problem, places, options).converged) {
    return {std::nan(""), std::nan(""), {}};
  }
  Matrix3X<double> force(3, segments + 2);
  problem.forces(places, force);
  const double couple =
      Vector3<double>(places.col(1) - places.col(0)).cross(Vector3<double>(force.col(1))).norm();
  Ring ring;
  for (int i = 0; i < segments; ++i) {
    ring.roundness = std::max(ring.roundness, std::abs(places.col(i).norm() / polygon - 1));
  }
  ring.couple = {"couple", couple, 2 * kPi * kRigidity / (segments * spacing), "N m"};
  ring.couple_error = relative_error(ring.couple);
  return ring;
}

void add_ring_check(const CaseInfo& info, int segments, Report& report) {
  const Ring ring = close_ring(segments, 1.0);
  CheckResult couple = judged(
      info,
      {fmt::format("a straight rod of {} segments is a ring under the couple 2 pi B / L", segments),
       "relative error of the couple at its ends",
       "M = 2 pi B / L",
       "pure bending: the same couple everywhere, so exact for any number of segments",
       {1e-10, Basis::kRoundoff, "rounding; what the residual leaves goes into the shape"},
       "the torsion law, or the static solver",
       "reference statics"},
      ring.couple);
  add_sabotage(couple, "rigidity +0.01 %", close_ring(segments, 1.0001).couple_error);
  report.checks.push_back(std::move(couple));
  CheckResult round =
      judged(info,
             {"the ring is round",
              "largest |radius / that of the polygon - 1|",
              "a regular polygon",
              "pure bending",
              {1e-11, Basis::kRoundoff, "residual of 1e-9 of B / r^2 over a spring"},
              "the static solver, or a torsion that knows a plane",
              "reference statics"},
             ring.roundness);
  add_sabotage(round, "not solved: the shape it starts from",
               close_ring(segments, 1.0, false).roundness);
  report.checks.push_back(std::move(round));
}

constexpr std::array kParameters = {
    CaseParameter{"pitch", "deg", "angle of the helix to the plane across its axis", 5.0, 70.0,
                  30.0},
    CaseParameter{"natural-curvature", "1", "kappa0 r of the rod at rest", 0.0, 2.0, 0.5},
    CaseParameter{"nodes", "1", "per turn", 40, 400, 60, true},
};

}  // namespace
}  // namespace helix

std::span<const CaseParameter> helix_parameters() {
  using namespace helix;
  return kParameters;
}

void evaluate_helix(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                    Report& report) {
  using namespace helix;
  if (asks_for_point(options)) {
    const int nodes = static_cast<int>(value_of(info, options, "nodes"));
    add_helix_checks(info,
                     {.pitch = value_of(info, options, "pitch"),
                      .natural = value_of(info, options, "natural-curvature"),
                      .nodes = nodes},
                     report);
    add_ring_check(info, std::min(nodes, kRingSegments), report);
    return;
  }
  add_helix_checks(info, {.pitch = 30, .natural = 0}, report);
  add_helix_checks(info, {.pitch = 30, .natural = 0.5}, report);
  add_helix_checks(info, {.pitch = 60, .natural = 0.5}, report);
  add_order_check(info, report);
  add_ring_check(info, 40, report);
}

}  // namespace weft::validation
