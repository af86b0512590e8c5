#include <weft/validation/motion/motion_figures.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <weft/validation/metrics/energy.hpp>
#include <weft/validation/metrics/penetration.hpp>
#include <weft/validation/motion/motion_scenes.hpp>

namespace weft::validation {
namespace {

using scenes::Scene;
using scenes::SceneState;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

int num_frames(const Scene& scene) {
  return static_cast<int>(std::lround(scene.world.duration / scene.world.frame_interval));
}

SceneState start_of(const Scene& scene) {
  SceneState state;
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = make_mesh(cloth);
    Matrix3X<double> velocities = cloth.velocity.replicate(1, mesh.num_nodes());
    for (const int node : mesh.pinned) velocities.col(node).setZero();
    state.cloths.push_back({cloth.name, mesh.rest_positions, velocities});
  }
  for (const scenes::Collider& collider : scene.colliders) {
    state.rigids.push_back({collider.name, collider.position, collider.orientation,
                            collider.velocity, collider.angular_velocity});
  }
  return state;
}

/// The state of a time [s]; null if the run ended before. Counted in frames: clocks of rounded steps run a little fast or slow.
const SceneState* state_at(const Scene& scene, const MotionFrames& frames, double time) {
  const auto index = static_cast<std::size_t>(std::lround(time / scene.world.frame_interval));
  return index < frames.size() ? &frames[index] : nullptr;
}

using Figure = std::function<double(const Scene&, const MotionFrames&)>;

/// A figure of one state; not a number if the run ended before.
Figure at(double time, const std::function<double(const SceneState&)>& of) {
  return [time, of](const Scene& scene, const MotionFrames& frames) {
    const SceneState* state = state_at(scene, frames, time);
    return state != nullptr ? of(*state) : kNaN;
  };
}

double highest(const SceneState& state) {
  return state.cloths[0].positions.row(1).maxCoeff();
}

double mean_height(const SceneState& state) {
  return state.cloths[0].positions.row(1).mean();
}

MotionFigure energy_figure() {
  return {"energy gained", "J", &energy_gained, 0.0, true};
}

MotionScene sheet_on_edge_scene() {
  return {sheet_on_edge(),
          1.0 / 8040,
          {{"highest node at 1 s", "m", at(1.0, highest), 0.05},
           {"highest node at 3 s", "m", at(3.0, highest), 0.05},
           energy_figure()}};
}

MotionScene narrow_box_scene() {
  return {sheet_over_narrow_box(),
          1.0 / 8040,
          {{"mean height at 1 s", "m", at(1.0, mean_height), 0.02},
           {"mean height at 2 s", "m", at(2.0, mean_height), 0.02},
           {"mean height at 3 s", "m", at(3.0, mean_height), 0.02},
           energy_figure()}};
}

MotionScene trampoline_scene() {
  const auto aside = [](const SceneState& state) {
    const Vector3<double>& x = state.rigids[0].position;
    return std::hypot(x.x(), x.z());
  };
  const auto height = [](const SceneState& state) { return state.rigids[0].position.y(); };
  const auto speed = [](const SceneState& state) { return state.rigids[0].velocity.norm(); };
  return {ball_on_trampoline(15.0),
          1.0 / 4020,
          {{"ball aside at 15 s", "m", at(15.0, aside), 1e-3},
           {"ball's height at 15 s", "m", at(15.0, height), 5e-3},
           {"ball's speed at 15 s", "m/s", at(15.0, speed), 0.02},
           energy_figure()}};
}

/// allowed: of the ball's speed [m/s].
MotionScene hit_scene(Scene scene, double exact_step, double allowed) {
  const auto through = [](const SceneState& state) { return state.rigids[0].velocity.z(); };
  return {std::move(scene),
          exact_step,
          {{"ball's velocity at 0.25 s", "m/s", at(0.25, through), allowed},
           {"ball's velocity at 0.5 s", "m/s", at(0.5, through), allowed},
           {"deepest node in the ball", "m", &deepest_node, 0.002, true},
           energy_figure()}};
}

MotionScene free_scene() {
  const auto along = [](const SceneState& state) { return state.rigids[0].velocity.y(); };
  return {ball_into_free_sheet({}),
          1.0 / 20040,
          {{"ball's velocity at 0.3 s", "m/s", at(0.3, along), 0.5},
           {"momentum changed", "1", &momentum_changed, 1e-4, true},
           {"deepest node in the ball", "m", &deepest_node, 0.002, true},
           energy_figure()}};
}

}  // namespace

std::vector<MotionScene> judged_motions() {
  std::vector<MotionScene> list = {sheet_on_edge_scene(),
                                   narrow_box_scene(),
                                   trampoline_scene(),
                                   hit_scene(ball_into_flag(), 1.0 / 20040, 0.25),
                                   hit_scene(ball_into_net(), 1.0 / 60000, 1.0),
                                   free_scene()};
  for (MotionScene& motion : list) {
    // Drag and contact take energy, nothing gives any; a surface that pushes a node out by a tenth of a millimeter may.
    MotionFigure& gained = motion.figures.back();
    gained.allowed = 0.01;
  }
  return list;
}

double energy_gained(const Scene& scene, const MotionFrames& frames) {
  if (frames.empty()) return kNaN;
  const SceneEnergy energy(scene);
  const double start = energy.evaluate(frames.front()).total();
  double most = 0;
  for (const SceneState& frame : frames) {
    const double gained = energy.evaluate(frame).total() - start;
    if (!(gained <= most)) most = gained;
  }
  return most;
}

double momentum_changed(const Scene& scene, const MotionFrames& frames) {
  if (frames.empty()) return kNaN;
  const SceneEnergy energy(scene);
  const Vector3<double> start = energy.evaluate(frames.front()).momentum;
  double most = 0;
  for (const SceneState& frame : frames) {
    const double change = (energy.evaluate(frame).momentum - start).norm() / start.norm();
    if (!(change <= most)) most = change;
  }
  return most;
}

double deepest_node(const Scene& scene, const MotionFrames& frames) {
  double deepest = frames.empty() ? kNaN : 0.0;
  for (const SceneState& frame : frames) {
    for (const Penetration& pair : penetrations(scene, frame)) {
      if (!(pair.surface.deepest <= deepest)) deepest = pair.surface.deepest;
    }
  }
  return deepest;
}

MotionFrames standing_still(const Scene& scene) {
  SceneState state = start_of(scene);
  for (scenes::ClothState& cloth : state.cloths) cloth.velocities.setZero();
  for (scenes::RigidState& rigid : state.rigids) {
    rigid.velocity.setZero();
    rigid.angular_velocity.setZero();
  }
  MotionFrames frames;
  for (int n = 0; n <= num_frames(scene); ++n) {
    state.time = n * scene.world.frame_interval;
    frames.push_back(state);
  }
  return frames;
}

MotionFrames untouched(const Scene& scene) {
  const SceneState start = start_of(scene);
  MotionFrames frames;
  for (int n = 0; n <= num_frames(scene); ++n) {
    const double t = n * scene.world.frame_interval;
    SceneState state = start;
    state.time = t;
    const Vector3<double> fallen = 0.5 * t * t * scene.world.gravity;
    for (std::size_t c = 0; c < state.cloths.size(); ++c) {
      if (!make_mesh(scene.cloths[c]).pinned.empty()) continue;
      state.cloths[c].positions.colwise() += t * scene.cloths[c].velocity + fallen;
      state.cloths[c].velocities.colwise() += t * scene.world.gravity;
    }
    for (std::size_t r = 0; r < state.rigids.size(); ++r) {
      if (!scene.colliders[r].mass) continue;
      state.rigids[r].position += t * scene.colliders[r].velocity + fallen;
      state.rigids[r].velocity += t * scene.world.gravity;
    }
    frames.push_back(std::move(state));
  }
  return frames;
}

MotionFrames frames_of(scenes::Simulator& simulator, const Scene& scene) {
  simulator.load(scene);
  MotionFrames frames = {simulator.state()};
  const long per_frame = std::lround(scene.world.frame_interval / scene.world.time_step);
  for (int n = 0; n < num_frames(scene); ++n) {
    for (long k = 0; k < per_frame; ++k) {
      if (simulator.step(scene.world.time_step).blow_up) return frames;
    }
    frames.push_back(simulator.state());
  }
  return frames;
}

}  // namespace weft::validation
