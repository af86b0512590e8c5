#include <weft/validation/stability/stability_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/reference/spectrum.hpp>
#include <weft/reference/step_guard.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace {

constexpr std::array<double, 5> kStiffnessFactors = {0.25, 0.5, 1, 2, 4};
constexpr std::array<double, 4> kStabilityMapBetas = {0, 0.5, 1, 3};
constexpr double kStabilityMapDisturbance = 1e-6;  ///< of the shortest spring [-]
constexpr double kStabilityMapGrown =
    1e-2;  ///< the same: 1e4 times as large, and springs still linear
/// A step 1 % beyond the stable one grows by exp(2 sqrt(0.02)) = 1.33 a step: 1e4 after 33 steps, of
/// which the disturbance needs some to find the mode.
constexpr int kStabilityMapNumSteps = 250;

/// The parameters that set how stiff a law is; all of them are linear in its force.
bool is_stiffness(const forces::ParameterInfo& parameter) {
  return parameter.name == "stiffness" || parameter.name == "rigidity";
}

reference::Body make_body(const scenes::Cloth& cloth, double stiffness_factor, double beta) {
  reference::Body body;
  body.name = cloth.name;
  body.mesh = scenes::make_mesh(cloth);
  bool stores_energy = false;
  for (forces::LawSpecification law : cloth.laws) {
    const forces::LawInfo& info = *forces::find_law(law.law);
    if (!info.traits.internal || info.traits.level == forces::LawTraits::Level::kInertia) continue;
    stores_energy = stores_energy || info.traits.has_energy;
    law = forces::checked(law);
    for (const forces::ParameterInfo& parameter : info.parameters) {
      if (!is_stiffness(parameter)) continue;
      law.parameters.at(std::string(parameter.name)).at(0) *= stiffness_factor;
    }
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  if (!stores_energy) {
    throw InvalidArgument("stability: cloth '" + cloth.name +
                          "' has no law that stores energy, expected tension or the like");
  }
  if (beta > 0) {
    body.laws.add(
        forces::make_law<double>({"acceleration_damping", {}, {{"beta", {beta}}}}, body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  return body;
}

double shortest_edge(const ClothMesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const EdgeSet& set : mesh.edge_sets) {
    if (set.edges.cols() > 0) {
      shortest = std::min(shortest, edge_lengths(mesh.rest_positions, set.edges).minCoeff());
    }
  }
  return shortest;
}

bool is_stable(const scenes::Cloth& cloth, double stiffness_factor, double beta, double time_step) {
  reference::Body body = make_body(cloth, stiffness_factor, beta);
  const double unit = shortest_edge(body.mesh);
  for (int node = 0; node < body.mesh.num_nodes(); ++node) {
    // Without a pattern that the mesh shares: it holds a part of every mode.
    for (int axis = 0; axis < 3; ++axis) {
      body.positions(axis, node) +=
          kStabilityMapDisturbance * unit * std::sin((7.0 + 4 * axis) * node + axis);
    }
  }
  for (const int node : body.mesh.pinned) {
    body.positions.col(node) = body.mesh.rest_positions.col(node);
  }
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kModifiedEuler);
  const reference::Body& now = solver.system().bodies[0];
  for (int step = 0; step < kStabilityMapNumSteps; ++step) {
    if (solver.step(time_step).blow_up) return false;
    const double off = (now.positions - now.mesh.rest_positions).cwiseAbs().maxCoeff();
    if (!(off <= kStabilityMapGrown * unit)) return false;
  }
  return true;
}

StabilityPoint map_point(const scenes::Cloth& cloth, double stiffness_factor, double beta) {
  reference::Body body = make_body(cloth, stiffness_factor, beta);
  StabilityPoint point{stiffness_factor, beta, 0.0, 0.0};
  point.predicted =
      reference::stable_step(reference::IntegratorKind::kModifiedEuler, reference::spectrum(body));
  constexpr double kBracket = 2.0;  // a prediction off by more is shown as off by this much
  double stable = point.predicted / kBracket;
  double unstable = point.predicted * kBracket;
  while (unstable > (1 + kStabilityResolution) * stable) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(cloth, stiffness_factor, beta, middle) ? stable : unstable) = middle;
  }
  point.measured = std::sqrt(stable * unstable);
  return point;
}

}  // namespace

std::vector<StabilityMap> map_stability(const scenes::Scene& scene) {
  std::vector<StabilityMap> maps;
  for (const scenes::Cloth& cloth : scene.cloths) {
    StabilityMap map{cloth.name, {}};
    for (const double beta : kStabilityMapBetas) {
      for (const double factor : kStiffnessFactors) {
        map.points.push_back(map_point(cloth, factor, beta));
      }
    }
    maps.push_back(std::move(map));
  }
  return maps;
}

CheckResult stability_check(const StabilityMap& map) {
  CheckResult check;
  check.case_id = map.cloth;
  check.engine = "reference";
  check.claim = "the predicted step is the largest stable one";
  check.metric = "largest |measured / predicted - 1| over the map";
  check.unit = "1";
  check.formula = "h^2 w^2 < 2 (1 + exp(-h g) (1 - h f))";
  check.source = "power iteration at the rest shape, modified Euler";
  const Tolerance tolerance{0.05, Basis::kTruncation,
                            "half the search's bracket of 1 %, and damping that the two rates of a "
                            "spectrum do not describe"};
  for (const StabilityPoint& point : map.points) {
    const double error = std::abs(point.measured / point.predicted - 1);
    if (!(error <= check.measured)) check.measured = error;
  }
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  double without = 0.0;
  for (const StabilityPoint& point : map.points) {
    for (const StabilityPoint& bare : map.points) {
      if (bare.beta != 0.0 || bare.stiffness_factor != point.stiffness_factor) continue;
      without = std::max(without, std::abs(point.measured / bare.predicted - 1));
    }
  }
  check.sabotages.push_back({"added inertia left out of the prediction", without,
                             judge(without, tolerance) == Verdict::kFail});
  check.note = "damping that differs much from mode to mode, or a body that is soft at rest";
  return check;
}

Section stability_section(const StabilityMap& map) {
  Section section{map.cloth, "Largest stable time step of cloth '" + map.cloth + "'", {}, {}, {},
                  ""};
  Plot plot{"Stable step by stiffness and added inertia",
            "stiffness / the scene's [1]",
            "largest stable step [s]",
            true,
            true,
            {}};
  Table table{"Stable step, found within 1 %",
              {"stiffness factor", "beta", "predicted [s]", "measured [s]", "measured / predicted"},
              {}};
  for (const double beta : kStabilityMapBetas) {
    Series predicted{fmt::format("predicted, beta = {:g}", beta), {}, {}};
    Series measured{fmt::format("measured, beta = {:g}", beta), {}, {}};
    for (const StabilityPoint& point : map.points) {
      if (point.beta != beta) continue;
      for (Series* series : {&predicted, &measured}) series->x.push_back(point.stiffness_factor);
      predicted.y.push_back(point.predicted);
      measured.y.push_back(point.measured);
      table.rows.push_back({fmt::format("{:g}", point.stiffness_factor), fmt::format("{:g}", beta),
                            fmt::format("{:.5g}", point.predicted),
                            fmt::format("{:.5g}", point.measured),
                            fmt::format("{:.4f}", point.measured / point.predicted)});
    }
    plot.series.push_back(std::move(predicted));
    plot.series.push_back(std::move(measured));
  }
  section.plots.push_back(std::move(plot));
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace weft::validation
