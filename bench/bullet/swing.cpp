#include <cmath>
#include <memory>

#include <fmt/core.h>
#include <tbb/task_arena.h>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/engines/reference_simulator.hpp>
#include <weft/validation/metrics/rest_forces.hpp>
#include <weft/validation/motion/motion_scenes.hpp>
#include <weft/validation/motion/swing.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"
#include "bench/swing_truth.hpp"

namespace weft::bench {
namespace {

using validation::Places;
using validation::SwingTrack;

const std::filesystem::path kTruthFolder = WEFT_SOURCE_DIR "/bench/truth";
/// Whether so many are enough, the residual tells.
constexpr fast::SolverSettings kConverged = {30, 60};
/// Explicit integration takes so many times the longest stable step, and is left out where it would need longer than some minutes.
constexpr double kShareOfStableStep = 0.5;
constexpr double kMostNodeSteps = 8e9;

struct Run {
  Places places;
  double median_ms = 0;
};

Run fast_run(const scenes::Scene& scene, const bridge::FastSettings& settings) {
  const scenes::Cloth& cloth = scene.cloths[0];
  const ClothMesh mesh = make_mesh(cloth);
  bridge::SoftWorld world({{0, -9.81, 0}, 0.1});
  btSoftBody& body = world.add(bridge::make_cloth_body(
      world.info(), mesh, {.collision_margin = cloth.collision_margin, .time_step = kSwingStep}));
  (void)world.solver().attach_fast(body, mesh, cloth.laws, settings);
  Run run{{mesh.rest_positions}, 0};
  std::vector<double> times;
  Matrix3X<btScalar> x;
  Matrix3X<btScalar> v;
  for (int step = 0; step < kSwingSteps; ++step) {
    const double start = processor_time();
    world.step(kSwingStep);
    times.push_back(processor_time() - start);
    bridge::read_nodes(body, x, v);
    run.places.push_back(x.cast<double>());
  }
  run.median_ms = median(times);
  return run;
}

/// Velocity Verlet of the same springs, no Bullet; none where it would take too long.
std::optional<Places> exact_run(scenes::Scene scene) {
  scene.reference.integrator = scenes::Integrator::kVelocityVerlet;
  const std::unique_ptr<scenes::Simulator> probe = scenes::make_reference();
  probe->load(scene);
  const double stable = probe->step(1e-9).stable_time_step.value_or(0.0);
  const double num_substeps = std::ceil(kSwingStep / (kShareOfStableStep * stable));
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  if (num_substeps * kSwingSteps * mesh.num_nodes() > kMostNodeSteps) return std::nullopt;
  scene.world.time_step = kSwingStep / num_substeps;
  const std::unique_ptr<scenes::Simulator> solver = scenes::make_reference();
  solver->load(scene);
  Places places = {mesh.rest_positions};
  for (int step = 0; step < kSwingSteps; ++step) {
    for (int k = 0; k < static_cast<int>(num_substeps); ++k) {
      (void)solver->step(scene.world.time_step);
    }
    places.push_back(solver->state().cloths[0].positions);
  }
  return places;
}

/// What the second-order backward difference formula lacks in each step, from places alone: M (9 x_n - 24 x_n-1 + 22 x_n-2 - 8 x_n-3 + x_n-4) / (4 h^2) - F(x_n).
double residual(const scenes::Scene& scene, const Places& x) {
  const validation::RestForces laws(scene, 1e-16);
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  double sum = 0;
  double count = 0;
  for (std::size_t n = 4; n < x.size(); ++n) {
    const Matrix3X<double> acceleration =
        (9 * x[n] - 24 * x[n - 1] + 22 * x[n - 2] - 8 * x[n - 3] + x[n - 4]) /
        (4 * kSwingStep * kSwingStep);
    const Matrix3X<double> lack =
        acceleration * mesh.masses.asDiagonal() - laws.forces(0, x[n], 0.0);
    for (int i = 0; i < mesh.num_nodes(); ++i) {
      if (std::binary_search(mesh.pinned.begin(), mesh.pinned.end(), i)) continue;
      sum += (lack.col(i) / (9.81 * mesh.masses[i])).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

SwingTruth truth_of(const ClothMesh& mesh, Places places, double lacking) {
  const SwingTrack track(mesh, kSwingStep, std::move(places));
  const SwingTrack::Stretch stretch = track.stretch();
  return {track.kinetic_energy(0, kSwingMiddle),
          track.kinetic_energy(kSwingMiddle, kSwingEnd),
          track.turning_time(),
          stretch.largest,
          stretch.mean,
          lacking};
}

void add_row(const SwingSheet& sheet, double stiffness, ResultFile& file) {
  const scenes::Scene scene = validation::swinging_sheet(sheet.nodes, sheet.mass, stiffness);
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const SwingTruths truths = read_swing_truths(kTruthFolder, swing_key(sheet, stiffness));
  Run run = fast_run(scene, {.may_sleep = false});
  const double lacking = residual(scene, run.places);
  const auto distance = [&](const Places& places) {
    return three_digits(100 *
                        validation::rms_distance(sampled(places, sheet.nodes), truths.sample));
  };
  const std::string apart = distance(run.places);
  const SwingTruth now = truth_of(mesh, std::move(run.places), lacking);
  const Places plate = validation::rigid_plate(mesh, kSwingStep, kSwingSteps);
  const SwingTruth swung = truth_of(mesh, plate, 0);
  const SwingTruth& right = truths.right();
  const auto ratio = [](double value, double of) { return fmt::format("{:.3f}", value / of); };
  file.add({sheet.name,
            fmt::format("{:.0e}", stiffness),
            three_digits(run.median_ms),
            ratio(now.first_energy, right.first_energy),
            ratio(now.later_energy, right.later_energy),
            three_digits(now.later_energy),
            three_digits(right.later_energy),
            truths.exact ? three_digits(truths.exact->later_energy) : "-",
            truths.has_converged() ? "converged" : "exact",
            ratio(now.turning_time, right.turning_time),
            apart,
            three_digits(100 * now.largest_stretch),
            three_digits(100 * now.mean_stretch),
            three_digits(100 * right.largest_stretch),
            three_digits(100 * right.mean_stretch),
            three_digits(lacking),
            three_digits(truths.converged.residual),
            ratio(swung.first_energy, right.first_energy),
            ratio(swung.later_energy, right.later_energy),
            distance(plate),
            distance(validation::hanging_flat(mesh, kSwingSteps)),
            distance(validation::frozen(mesh, kSwingSteps))});
}

}  // namespace

void bench_motion(const Settings& settings) {
  ResultFile file(
      "motion of a sheet of 1 m that swings from two corners (structural, shear and bend springs, "
      "no "
      "damping) for 3 s with the fast solver's default setting in steps of 1/60 s on one thread, "
      "beside "
      "the same step solved with very many iterations (converged) and short explicit steps (exact, "
      "which is right where the other has not converged): "
      "mean kinetic energy from places, the time of the first turn, RMS distance to the right "
      "run, stretch at the end, and what the equations of a BDF2 step lack over m g; and the same "
      "for "
      "predictors that solve nothing: a rigid plate that swings, a sheet that hangs flat and "
      "still, one that stays at its start",
      {"sheet",
       "stiffness_N_per_m",
       "median_ms",
       "energy_0_1_over_right",
       "energy_1_3_over_right",
       "energy_1_3_J",
       "right_energy_1_3_J",
       "exact_energy_1_3_J",
       "right_is",
       "turning_time_over_right",
       "rms_cm",
       "max_stretch_percent",
       "mean_stretch_percent",
       "right_max_stretch_percent",
       "right_mean_stretch_percent",
       "residual_over_mg",
       "converged_residual_over_mg",
       "plate_energy_0_1_over_right",
       "plate_energy_1_3_over_right",
       "plate_rms_cm",
       "hanging_rms_cm",
       "frozen_rms_cm"});
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (const SwingSheet& sheet : swing_sheets()) {
      for (const double stiffness : swing_stiffnesses()) add_row(sheet, stiffness, file);
    }
  });
  file.write(settings.folder / "motion.csv");
}

void bench_swing_truth(const Settings& /*settings*/) {
  std::filesystem::create_directories(kTruthFolder);
  for (const SwingSheet& sheet : swing_sheets()) {
    for (const double stiffness : swing_stiffnesses()) {
      if (std::filesystem::exists(swing_truth_file(kTruthFolder, swing_key(sheet, stiffness))))
        continue;
      const scenes::Scene scene = validation::swinging_sheet(sheet.nodes, sheet.mass, stiffness);
      const ClothMesh mesh = make_mesh(scene.cloths[0]);
      SwingTruths truths;
      Run run = fast_run(scene, {.solver = kConverged, .may_sleep = false});
      truths.sample = sampled(run.places, sheet.nodes);
      const double lacking = residual(scene, run.places);
      truths.converged = truth_of(mesh, std::move(run.places), lacking);
      if (std::optional<Places> exact = exact_run(scene)) {
        if (!truths.has_converged()) truths.sample = sampled(*exact, sheet.nodes);
        truths.exact = truth_of(mesh, std::move(*exact), 0);
      }
      write_swing_truths(kTruthFolder, swing_key(sheet, stiffness), truths);
      fmt::print("{}: kinetic energy {:.4g} {:.4g} J (exact {:.4g}), residual {:.3g} m g\n",
                 swing_key(sheet, stiffness), truths.converged.first_energy,
                 truths.converged.later_energy,
                 truths.exact ? truths.exact->later_energy : std::nan(""), lacking);
      std::fflush(stdout);
    }
  }
}

}  // namespace weft::bench
