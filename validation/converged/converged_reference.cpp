#include <weft/validation/converged/converged_reference.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/engines/reference_simulator.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/codec/stream_hash.hpp>
#include <weft/validation/metrics/distance/vertex_distance.hpp>
#include <weft/validation/metrics/series/convergence.hpp>

namespace weft::validation {
namespace {

constexpr double kRatio = 2.0;

void check(const ConvergenceOptions& options, const scenes::World& world) {
  const auto refuse = [](const std::string& what, const std::string& expected) {
    throw InvalidArgument("converged reference: " + what + ", expected " + expected);
  };
  const double steps = options.time / world.time_step;
  if (!(steps >= 1.0 - 1e-9) || std::abs(steps - std::round(steps)) > 1e-9 * steps) {
    refuse(fmt::format("time = {:g} [s]", options.time),
           fmt::format("a whole number of time steps of {:g} s", world.time_step));
  }
  if (options.num_levels < 3) refuse(fmt::format("levels = {}", options.num_levels), ">= 3");
  if (options.first_division < 1) {
    refuse(fmt::format("first division = {}", options.first_division), ">= 1");
  }
  if (!(options.gate > 0.0)) refuse(fmt::format("gate = {:g} [-]", options.gate), "> 0");
}

std::string hash_of(const std::vector<Matrix3X<double>>& positions) {
  scenes::StreamHash hash;
  for (const Matrix3X<double>& one : positions) {
    for (const double number : one.reshaped()) hash.add(number);
  }
  return hash.hex();
}

std::string hash_of(const std::vector<ClothMesh>& meshes) {
  scenes::StreamHash hash;
  for (const ClothMesh& mesh : meshes) {
    for (const double number : mesh.rest_positions.reshaped()) hash.add(number);
    for (const double number : mesh.masses) hash.add(number);
    for (const int node : mesh.triangles.reshaped()) hash.add(node);
    for (const EdgeSet& set : mesh.edge_sets) {
      for (const int node : set.edges.reshaped()) hash.add(node);
    }
  }
  return hash.hex();
}

/// Area-weighted rms distance over all cloths [m].
double distance(const std::vector<Matrix3X<double>>& a, const std::vector<Matrix3X<double>>& b,
                const std::vector<ClothMesh>& meshes) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t c = 0; c < meshes.size(); ++c) {
    if (a[c].cols() != b[c].cols() || a[c].cols() != meshes[c].num_nodes()) {
      return std::numeric_limits<double>::quiet_NaN();  // torn: not the same nodes
    }
    const double share = static_cast<double>(meshes[c].num_nodes());
    const double rms = vertex_distance(a[c], b[c], node_weights(meshes[c])).rms;
    sum += share * rms * rms;
    weight += share;
  }
  return std::sqrt(sum / weight);
}

ConvergenceLevel run(scenes::Scene scene, scenes::Integrator integrator, double time, int num_steps,
                     std::vector<Matrix3X<double>>& positions) {
  scene.reference.integrator = integrator;
  scene.reference.step_guard = scenes::StepGuard::kReport;
  ConvergenceLevel level;
  level.num_steps = num_steps;
  level.time_step = time / num_steps;
  const std::unique_ptr<scenes::Simulator> simulator = scenes::make_reference();
  simulator->load(scene);
  for (int step = 0; step < num_steps; ++step) {
    const scenes::StepReport report = simulator->step(level.time_step);
    if (!report.blow_up) continue;
    level.blow_up = fmt::format("step {}, {}: {}", report.blow_up->step, report.blow_up->body,
                                report.blow_up->reason);
    break;
  }
  positions.clear();
  for (const scenes::ClothState& cloth : simulator->state().cloths) {
    positions.push_back(cloth.positions);
  }
  level.hash = hash_of(positions);
  return level;
}

/// Fills order and GCI from the last three levels.
void judge_levels(ConvergenceStudy& study) {
  const std::size_t last = study.levels.size() - 1;
  const auto& fine = study.levels[last].difference;
  const auto& coarse = study.levels[last - 1].difference;
  if (!fine || !coarse) return;
  study.order = order_of_differences(*fine, *coarse, kRatio);
  if (!study.order || !(*study.order > 0.0)) return;
  constexpr double kSafety = 1.25;  // for three and more levels
  const double order = std::min(*study.order, static_cast<double>(study.formal_order));
  study.gci = kSafety * *fine / (std::pow(kRatio, order) - 1.0);
}

}  // namespace

bool ConvergedReference::is_converged() const {
  const auto is_below = [](const std::optional<double>& value, double bound) {
    return value && *value < bound;
  };
  return std::all_of(
             studies.begin(), studies.end(),
             [&](const ConvergenceStudy& study) { return is_below(study.gci, gate / 10); }) &&
         is_below(agreement, gate / 3);
}

ConvergedReference converge(const scenes::Scene& scene, const ConvergenceOptions& options) {
  check(options, scene.world);
  ConvergedReference reference;
  reference.scene = scene.name;
  scenes::StreamHash hash;
  hash.add(scenes::write_scene(scene));
  reference.scene_hash = hash.hex();
  reference.time = options.time;
  reference.gate = options.gate;
  std::vector<ClothMesh> meshes;
  for (const scenes::Cloth& cloth : scene.cloths) {
    meshes.push_back(scenes::make_mesh(cloth));
    const Matrix3X<double>& rest = meshes.back().rest_positions;
    const Vector3<double> extent = rest.rowwise().maxCoeff() - rest.rowwise().minCoeff();
    reference.size = std::max(reference.size, extent.maxCoeff());
  }
  reference.mesh_hash = hash_of(meshes);
  const int first_steps =
      static_cast<int>(std::lround(options.time / scene.world.time_step)) * options.first_division;
  for (const scenes::Integrator integrator :
       {scenes::Integrator::kVelocityVerlet, scenes::Integrator::kTrBdf2}) {
    ConvergenceStudy study{integrator, 2, {}, {}, {}, {}};
    std::vector<Matrix3X<double>> previous;
    for (int n = 0; n < options.num_levels; ++n) {
      std::vector<Matrix3X<double>> positions;
      ConvergenceLevel level = run(scene, integrator, options.time, first_steps << n, positions);
      const bool is_whole = !level.blow_up && (n == 0 || !study.levels.back().blow_up);
      if (n > 0 && is_whole) {
        level.difference = distance(positions, previous, meshes) / reference.size;
      }
      study.levels.push_back(std::move(level));
      previous = std::move(positions);
    }
    study.positions = std::move(previous);
    judge_levels(study);
    reference.studies.push_back(std::move(study));
  }
  const double apart =
      distance(reference.studies[0].positions, reference.studies[1].positions, meshes);
  if (std::isfinite(apart)) reference.agreement = apart / reference.size;
  return reference;
}

}  // namespace weft::validation
