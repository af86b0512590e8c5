#include <weft/validation/motion/motion_figures.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <weft/validation/metrics/distance/penetration.hpp>
#include <weft/validation/metrics/energy.hpp>
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
  // Drag and contact take energy, nothing gives any; a surface that pushes a node out by a tenth of a millimeter may.
  return {"energy gained", "J", &energy_gained, 0.01, true, WrongMotion::kPushed};
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
          {{"mean height at 1 s", "m", at(1.0, mean_height), 0.03}, energy_figure()}};
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
          {{"ball aside at 15 s", "m", at(15.0, aside), 1e-3, false, WrongMotion::kPushed},
           {"ball's height at 15 s", "m", at(15.0, height), 5e-3},
           {"ball's speed at 15 s", "m/s", at(15.0, speed), 0.02, false, WrongMotion::kUntouched},
           energy_figure()}};
}

/// allowed: of the ball's speed [m/s].
MotionScene hit_scene(Scene scene, double exact_step, double allowed) {
  const auto through = [](const SceneState& state) { return state.rigids[0].velocity.z(); };
  return {std::move(scene),
          exact_step,
          {{"ball's velocity at 0.25 s", "m/s", at(0.25, through), allowed},
           {"ball's velocity at 0.5 s", "m/s", at(0.5, through), allowed},
           energy_figure()}};
}

/// A body that is 10 cm high from its middle, over a table whose top is at 0: how far from where a cloth with margins to both holds it.
double gap_at_end(const Scene& scene, const MotionFrames& frames) {
  const auto last = static_cast<std::size_t>(num_frames(scene));
  if (frames.size() <= last) return kNaN;
  return frames[last].rigids[0].position.y() - 0.1 - 2 * scene.cloths[0].collision_margin;
}

/// The cloth between body and table bears the body's weight: margins give way by a tenth of a millimeter.
MotionScene box_on_tablecloth_scene() {
  const auto speed = [](const SceneState& state) { return state.rigids[0].velocity.norm(); };
  return {box_on_tablecloth(),
          1.0 / 8040,
          {{"gap between box and table", "m", &gap_at_end, 1e-3, false, WrongMotion::kFrozen},
           {"box's speed at 2 s", "m/s", at(2.0, speed), 0.02, true, WrongMotion::kUntouched},
           energy_figure()}};
}

/// A ball comes between nodes, as deep as they let it. It lies there; with explicit forces it still rocks at 0.09 m/s of 4.
MotionScene ball_onto_tablecloth_scene() {
  const auto speed = [](const SceneState& state) { return state.rigids[0].velocity.norm(); };
  return {ball_onto_tablecloth(),
          1.0 / 8040,
          {{"ball's speed at 2 s", "m/s", at(2.0, speed), 0.2, true, WrongMotion::kUntouched},
           energy_figure()}};
}

MotionScene free_scene() {
  const auto along = [](const SceneState& state) { return state.rigids[0].velocity.y(); };
  return {ball_into_free_sheet({}),
          1.0 / 20040,
          {{"ball's velocity at 0.3 s", "m/s", at(0.3, along), 0.5},
           {"momentum changed", "1", &momentum_changed, 1e-4, true, WrongMotion::kPushed},
           {"deepest node in the ball", "m", &deepest_node, 0.002, true, WrongMotion::kUntouched},
           energy_figure()}};
}

/// The energy gained as a share of the energy that everything has at the start [-].
double energy_share_gained(const Scene& scene, const MotionFrames& frames) {
  if (frames.empty()) return kNaN;
  return energy_gained(scene, frames) / SceneEnergy(scene).evaluate(frames.front()).kinetic();
}

MotionScene impact_scene(const FreeImpact& impact) {
  Scene scene = ball_into_free_sheet(impact);
  scene.name = fmt::format("impact_{:.0f}_to_1_at_{:.0f}_m_s", impact.mass_ratio, impact.speed);
  scene.colliders[0].position.y() = 0.13;
  // Until the ball is 35 cm farther.
  scene.world.duration = std::ceil(std::max(6.0, 21.0 / impact.speed)) / 60.0;
  const double end = scene.world.duration;
  const auto along = [](const SceneState& state) { return state.rigids[0].velocity.y(); };
  return {std::move(scene),
          1.0 / 20040,
          {{"ball's exit speed", "1", at(end, along), 0.05, false, WrongMotion::kFrozen, true},
           {"momentum changed", "1", &momentum_changed, 1e-4, true, WrongMotion::kPushed},
           {"energy gained", "1", &energy_share_gained, 1e-3, true, WrongMotion::kPushed}}};
}

/// How high the ball comes after it has come down for the first time [m]; not a number if it does not come up again.
double height_of_bounce(const Scene&, const MotionFrames& frames) {
  std::size_t n = 1;
  const auto height = [&](std::size_t k) { return frames[k].rigids[0].position.y(); };
  while (n < frames.size() && height(n) <= height(n - 1)) ++n;
  if (n >= frames.size()) return kNaN;
  while (n < frames.size() && height(n) >= height(n - 1)) ++n;
  return height(n - 1);
}

MotionScene bounce_scene() {
  Scene scene = ball_on_trampoline(1.0);
  scene.name = "bounce";
  scene.world.frame_interval = 1.0 / 60;
  std::erase_if(scene.cloths[0].laws,
                [](const forces::LawSpecification& law) { return law.law == "velocity_damping"; });
  for (forces::LawSpecification& law : scene.cloths[0].laws) {
    if (law.law == "tension") law.parameters.at("stiffness") = {2000.0};
  }
  scene.colliders[0].position.y() = 1.33;
  // Explicit contact gives and takes a little in each step that a node is hit in: 0.05 J of the 2 J that the ball falls by.
  MotionFigure gained = energy_figure();
  gained.allowed = 0.1;
  // 5 % of the 20 cm that it falls.
  return {
      std::move(scene),
      1.0 / 12000,
      {{"height of the first bounce", "m", &height_of_bounce, 0.01, false, WrongMotion::kUntouched},
       gained}};
}

MotionScene long_rest_scene() {
  Scene scene = ball_on_trampoline(60.0);
  scene.name = "trampoline_for_a_minute";
  scene.world.frame_interval = 0.1;
  const auto aside = [](const SceneState& state) {
    return std::hypot(state.rigids[0].position.x(), state.rigids[0].position.z());
  };
  const auto height = [](const SceneState& state) { return state.rigids[0].position.y(); };
  // From places: a velocity that is told may be one before contact has had its say.
  const auto speed = [](const Scene& given, const MotionFrames& frames) {
    const auto last = static_cast<std::size_t>(num_frames(given));
    if (frames.size() <= last) return kNaN;
    return (frames[last].rigids[0].position - frames[last - 1].rigids[0].position).norm() /
           given.world.frame_interval;
  };
  // A hundredth of the 10 cm that the ball sinks in.
  return {std::move(scene),
          1.0 / 4020,
          {{"ball aside at 60 s", "m", at(60.0, aside), 1e-3, true, WrongMotion::kPushed},
           {"ball's height at 60 s", "m", at(60.0, height), 1e-3, false, WrongMotion::kFrozen},
           {"ball's speed at 60 s", "m/s", speed, 1e-3, true, WrongMotion::kUntouched}}};
}

}  // namespace

std::string to_string(WrongMotion wrong) {
  switch (wrong) {
    case WrongMotion::kFrozen:
      return "all stays where it starts";
    case WrongMotion::kUntouched:
      return "nothing meets anything";
    case WrongMotion::kPushed:
      return "all drifts aside, half as fast again";
  }
  return {};
}

double MotionFigure::deviation(double value, double right) const {
  const double apart = std::abs(value - (is_bound ? 0.0 : right));
  return is_relative && !is_bound ? apart / std::abs(right) : apart;
}

std::vector<MotionScene> judged_motions() {
  return {sheet_on_edge_scene(),
          narrow_box_scene(),
          trampoline_scene(),
          hit_scene(ball_into_flag(), 1.0 / 20040, 0.25),
          hit_scene(ball_into_net(), 1.0 / 60000, 1.0),
          box_on_tablecloth_scene(),
          ball_onto_tablecloth_scene(),
          free_scene()};
}

std::vector<MotionScene> judged_impacts() {
  std::vector<MotionScene> list;
  for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
    for (const double speed : {1.0, 10.0, 50.0}) list.push_back(impact_scene({ratio, speed}));
  }
  list.push_back(bounce_scene());
  list.push_back(long_rest_scene());
  return list;
}

namespace {

/// m g v h / 2 [J]: an engine that gives a rigid body gravity's impulse of a whole step at its start, as Bullet and symplectic Euler
/// do, has the velocity of the middle of the step, which belongs to the height there.
double energy_since_middle(const Scene& scene, const SceneState& state) {
  double sum = 0;
  for (std::size_t k = 0; k < state.rigids.size(); ++k) {
    const double mass = scene.colliders[k].mass.value_or(0.0);
    sum -= mass * scene.world.gravity.dot(state.rigids[k].velocity) * scene.world.time_step / 2;
  }
  return sum;
}

}  // namespace

double energy_gained(const Scene& scene, const MotionFrames& frames) {
  if (frames.empty()) return kNaN;
  const SceneEnergy energy(scene);
  const auto total = [&](const SceneState& state) {
    return energy.evaluate(state).total() - energy_since_middle(scene, state);
  };
  const double start = total(frames.front());
  double most = 0;
  for (const SceneState& frame : frames) {
    const double gained = total(frame) - start;
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

MotionFrames wrong_motion(const Scene& scene, WrongMotion wrong) {
  if (wrong == WrongMotion::kFrozen) return standing_still(scene);
  MotionFrames frames = untouched(scene);
  if (wrong == WrongMotion::kUntouched) return frames;
  for (std::size_t n = frames.size() / 2; n < frames.size(); ++n) {
    const double aside = 0.5 * (frames[n].time - frames[frames.size() / 2].time);
    for (scenes::ClothState& cloth : frames[n].cloths) {
      cloth.positions.row(0).array() += aside;
      cloth.velocities *= 1.5;
    }
    for (scenes::RigidState& rigid : frames[n].rigids) {
      rigid.position.x() += aside;
      rigid.velocity *= 1.5;
    }
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
