// A chain with three-point torsion bends as a chain of hinges: the tip of a cantilever of N segments
// drops by F a^2 N (N + 1) (2 N + 1) / (6 kappa) under a small force F.
// Tested by tests/validation/theory_test.cpp.
#include <cmath>

#include <weft/custom_forces/registry.hpp>
#include <weft/reference/statics/static_solver.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace torsion_beam {
namespace {

constexpr double kSpacing = 0.01;   // a [m]
constexpr double kStiffness = 2.0;  // k [N/(m rad)]
constexpr double kSpring = 100.0;   // [N/m]
constexpr double kTipForce = 1e-7;  // [N]: turns the tip by 1e-2 rad at most

double tip_drop(int num_segments, double stiffness) {
  reference::Body body;
  body.name = "beam";
  const int num_nodes = num_segments + 2;  // nodes 0 and 1 are the clamp
  body.mesh.rest_positions = Matrix3X<double>::Zero(3, num_nodes);
  Edges edges(2, num_nodes - 1);
  Triples triples(3, num_nodes - 2);
  for (int i = 0; i < num_nodes; ++i) {
    body.mesh.rest_positions(0, i) = i * kSpacing;
    if (i > 0) edges.col(i - 1) << i - 1, i;
    if (i > 1) triples.col(i - 2) << i - 2, i - 1, i;
  }
  body.mesh.edge_sets.push_back({"row", edges});
  body.mesh.line_sets.push_back({"beam", triples});
  // All the weight at the tip: what the others add is below rounding.
  body.mesh.masses = VectorX<double>::Constant(num_nodes, 1e-30);
  body.mesh.masses[num_nodes - 1] = 1.0;
  body.mesh.pinned = {0, 1};
  for (const forces::LawSpecification& law :
       {tension_law(kSpring), gravity_law({0, -kTipForce, 0}),
        forces::LawSpecification{"torsion", {}, {{"stiffness", {stiffness}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  const reference::StaticProblem problem = reference::static_problem(body, kTipForce);
  Matrix3X<double> positions = body.mesh.rest_positions;
  reference::StaticOptions options;
  options.residual = 1e-6;  // rounding of springs: 100 N/m times 1e-17 m
  if (!reference::solve_statics(problem, positions, options).converged) return std::nan("");
  return -positions(1, num_nodes - 1);
}

}  // namespace
}  // namespace torsion_beam

void evaluate_torsion_beam(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                           Report& report) {
  using namespace torsion_beam;
  const Tolerance tolerance{1e-4, Basis::kTruncation, "small turns: 1e-2 rad squared at most"};
  for (const int n : {1, 10, 20}) {
    const double kappa = kStiffness * kSpacing * kSpacing;
    const double exact = kTipForce * kSpacing * kSpacing * n * (n + 1) * (2 * n + 1) / (6 * kappa);
    const auto drop = [&](double stiffness) {
      return ComparedValue{"drop of the tip", tip_drop(n, stiffness), exact, "m"};
    };
    CheckResult check;
    check.case_id = info.id;
    check.engine = "reference statics";
    check.claim = "a beam of " + std::to_string(n) + " segments bends as its rigidity k d^3 says";
    check.metric = "relative error of the tip's drop";
    check.unit = "1";
    check.formula = "F a^2 N (N + 1) (2 N + 1) / (6 kappa), kappa = k a^2";
    check.source = "statics of a chain of hinges";
    check.values = {drop(kStiffness)};
    check.measured = relative_error(check.values[0]);
    check.tolerance = tolerance;
    check.verdict = judge(check.measured, tolerance);
    const double sabotaged = relative_error(drop(1.01 * kStiffness));
    check.sabotages.push_back(
        {"torsion stiffness +1 %", sabotaged, judge(sabotaged, tolerance) == Verdict::kFail});
    check.note = "the torsion law, or the static solver";
    report.checks.push_back(std::move(check));
  }
}

}  // namespace weft::validation
