#include <weft/reference/contact/contact_stages.hpp>

#include <weft/reference/contact/contact_points.hpp>
#include <weft/reference/contact/contact_problem.hpp>
#include <weft/reference/contact/distance/signed_distance.hpp>
#include <weft/reference/contact/face_contacts.hpp>
#include <weft/reference/contact/self_contacts.hpp>

namespace weft::reference {
namespace {

/// Collects contacts of nodes with colliders in a step. Order: collider, body, node.
class Stage {
 public:
  Stage(const System& system, SystemStep& step)
      : points(system, step), system_(system), step_(step) {
    contact_of_.assign(points.num_nodes() * system.colliders.size(), kNone);
  }

  ContactProblem problem;
  ContactPoints points;

  template <class Visit>
  void for_each_pair(const Visit& visit) {
    for (std::size_t k = 0; k < system_.colliders.size(); ++k) {
      for (std::size_t b = 0; b < system_.bodies.size(); ++b) {
        for (int node = 0; node < system_.bodies[b].mesh.num_nodes(); ++node) {
          const bool fixed =
              step_.inverse_masses[b][node] == 0.0 && step_.rigids[k].inverse_mass == 0.0;
          if (!fixed) visit(k, b, node);
        }
      }
    }
  }

  Contact* find(std::size_t k, std::size_t b, int node) {
    const int index = contact_of_[pair_index(k, b, node)];
    return index == kNone ? nullptr : &problem.contacts[static_cast<std::size_t>(index)];
  }

  Contact& add(std::size_t k, std::size_t b, int node, const Vector3<double>& velocity) {
    const int point = points.point(b, node, velocity, problem);
    contact_of_[pair_index(k, b, node)] = static_cast<int>(problem.contacts.size());
    problem.contacts.push_back(
        {.on = {.points = {point, -1, -1, -1}}, .rigid = static_cast<int>(k)});
    return problem.contacts.back();
  }

 private:
  static constexpr int kNone = -1;
  std::size_t pair_index(std::size_t k, std::size_t b, int node) const {
    return k * points.num_nodes() + points.number(b, node);
  }

  const System& system_;
  SystemStep& step_;
  std::vector<int> contact_of_;  // per collider and node
};

ContactOutcome outcome_of(const ContactProblem& problem) {
  ContactOutcome outcome;
  for (const Contact& contact : problem.contacts) {
    const double normal_impulse = contact.normal.dot(contact.impulse);
    if (normal_impulse > 0.0) ++outcome.num_contacts;
    outcome.normal_impulse += normal_impulse;
  }
  return outcome;
}

double combined_friction(const System& system, std::size_t k, std::size_t b) {
  return system.bodies[b].friction * system.colliders[k].friction;
}

/// Where the colliders end the step with the velocities of the problem.
std::vector<Pose> end_poses(const System& system, const SystemStep& step, const Stage& stage) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < system.colliders.size(); ++k) {
    RigidMotion motion = step.rigids[k];
    motion.mean_velocity = stage.problem.rigids[k].velocity;
    motion.mean_angular_velocity = stage.problem.rigids[k].angular_velocity;
    poses.push_back(end_pose(system.colliders[k], motion, step.time_step));
  }
  return poses;
}

/// Linearises every surface at the predicted end of the step, or only those of new contacts.
/// False: nothing new, the solution stands.
bool linearise(const System& system, const PositionStage& options, const SystemStep& step,
               const std::vector<Pose>& poses, bool only_new, Stage& stage) {
  bool changed = false;
  stage.for_each_pair([&](std::size_t k, std::size_t b, int node) {
    const Body& body = system.bodies[b];
    const Vector3<double> velocity =
        stage.points.velocity(b, node, step.bodies[b].mean_velocities, stage.problem);
    const Vector3<double> end = body.positions.col(node) + step.time_step * velocity;
    const SurfaceDistance surface = signed_distance(system.colliders[k].shape, poses[k], end);
    const double depth = body.collision_margin - surface.distance;
    Contact* contact = stage.find(k, b, node);
    if (contact == nullptr) {
      if (!(depth > 0.0)) return;
      contact = &stage.add(k, b, node, velocity);
      contact->lever = position_stage_lever(system, step, k, b, node);
      contact->friction = options.friction ? combined_friction(system, k, b) : 0.0;
      changed = true;
    } else if (only_new) {
      return;
    } else if (!contact->impulse.isZero(0.0) || depth > 0.0) {
      changed |= (surface.normal - contact->normal).norm() > kNormalTolerance;
    }
    contact->normal = surface.normal;
    contact->target_speed =
        surface.normal.dot(relative_velocity(stage.problem, *contact)) + depth / step.time_step;
  });
  return changed;
}

/// Adds what touched in the position stage to a velocity stage.
void add_touches(const System& system, const SystemStep& step, const std::vector<Pose>& poses,
                 const Touches& touches, bool friction, Stage& stage) {
  for (const FaceTouch& touch : touches.faces) {
    const Body& body = system.bodies[touch.body];
    Contact contact = contact_at(touch, step, stage.points, stage.problem, true);
    Vector3<double> end = Vector3<double>::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const int node = touch.nodes[k];
      end += touch.weights[static_cast<Eigen::Index>(k)] *
             (body.positions.col(node) +
              step.time_step * step.bodies[touch.body].mean_velocities.col(node));
    }
    const Pose& pose = poses[touch.collider];
    contact.normal = signed_distance(system.colliders[touch.collider].shape, pose, end).normal;
    contact.lever = end - pose.position;
    contact.friction = friction ? combined_friction(system, touch.collider, touch.body) : 0.0;
    stage.problem.contacts.push_back(contact);
  }
  for (const PairTouch& touch : touches.pairs) {
    Contact contact{.normal = touch.normal, .friction = friction ? touch.friction : 0.0};
    for (std::size_t k = 0; k < 4; ++k) {
      const Matrix3X<double>& velocities = step.bodies[touch.bodies[k]].end_velocities;
      contact.on.points[k] = stage.points.point(touch.bodies[k], touch.nodes[k],
                                                velocities.col(touch.nodes[k]), stage.problem);
      contact.on.weights[k] = touch.weights[k];
    }
    stage.problem.contacts.push_back(contact);
  }
}

void write_position_stage(const ContactProblem& problem, const PositionStage& options,
                          SystemStep& step) {
  for (const ContactPoint& point : problem.points) {
    BodyStep& body = step.bodies[point.body];
    body.mean_velocities.col(point.node) = point.velocity;
    if (!options.change_end_velocity) continue;
    if (step.mean_is_end) {
      body.end_velocities.col(point.node) = point.velocity;
    } else {
      body.end_velocities.col(point.node) += point.inverse_mass * point.impulse;
    }
  }
  for (std::size_t k = 0; k < problem.rigids.size(); ++k) {
    const ContactRigid& rigid = problem.rigids[k];
    if (rigid.inverse_mass == 0.0) continue;
    RigidMotion& motion = step.rigids[k];
    motion.mean_velocity = rigid.velocity;
    motion.mean_angular_velocity = rigid.angular_velocity;
    if (!options.change_end_velocity) continue;
    if (step.mean_is_end) {
      motion.end_velocity = rigid.velocity;
    } else {
      motion.end_velocity += rigid.inverse_mass * rigid.impulse;
    }
    motion.angular_momentum += rigid.angular_impulse;
  }
}

}  // namespace

Vector3<double> position_stage_lever(const System& system, const SystemStep& step, std::size_t k,
                                     std::size_t b, int node) {
  const double h = step.time_step;
  const BodyStep& body = step.bodies[b];
  const RigidMotion& rigid = step.rigids[k];
  const Vector3<double> point =
      system.bodies[b].positions.col(node) +
      h * (body.mean_velocities.col(node) - body.end_velocities.col(node));
  const Vector3<double> centre =
      system.colliders[k].position + h * (rigid.mean_velocity - rigid.end_velocity);
  return point - centre;
}

ContactOutcome run_position_stage(const System& system, const PositionStage& options,
                                  SystemStep& step, Touches& touches) {
  Stage stage(system, step);
  for (const RigidMotion& motion : step.rigids) {
    stage.problem.rigids.push_back({.inverse_mass = motion.inverse_mass,
                                    .inverse_inertia = motion.start_inverse_inertia,
                                    .velocity = motion.mean_velocity,
                                    .angular_velocity = motion.mean_angular_velocity});
  }
  FaceContacts faces(system);
  SelfContacts pairs(system);
  // Faces and pairs share nodes: their sweeps converge linearly, and what they leave is looked at
  // again in the next pass.
  const SweepLimits limits = faces.is_needed() || pairs.is_needed() ? kSharedLimits : SweepLimits{};
  const auto look = [&](bool only_new) {
    const std::vector<Pose> poses = end_poses(system, step, stage);
    bool changed = linearise(system, options, step, poses, only_new, stage);
    if (faces.is_needed()) {
      changed |= faces.update(system, step, poses, options.friction, only_new, stage.points,
                              stage.problem);
    }
    if (pairs.is_needed()) {
      changed |= pairs.update(system, step, options.friction, stage.points, stage.problem);
    }
    return changed;
  };
  int passes = 0;
  int sweeps = 0;
  std::int64_t visits = 0;
  const std::int64_t visit_budget = contact_visit_budget(system);
  bool converged = true;
  bool changed = look(false);
  while (changed && passes < kMaxPasses) {
    const SweepReport report = solve_contacts(stage.problem, limits);
    ++passes;
    sweeps += report.sweeps;
    if (!faces.is_needed() && !pairs.is_needed()) visits += report.visits;
    converged = report.converged;
    if (pairs.is_needed()) {
      pairs.count_visits(report.visits);
      if (pairs.exhausted()) break;
    }
    if (visits > visit_budget) break;
    changed = look(passes >= kSmoothPasses);
  }
  ContactOutcome outcome = outcome_of(stage.problem);
  outcome.passes = passes;
  outcome.sweeps = sweeps;
  outcome.visits = visits;
  outcome.converged = converged && !changed;
  outcome.exhausted = pairs.exhausted();
  if (outcome.exhausted) return outcome;
  write_position_stage(stage.problem, options, step);
  faces.collect(stage.problem, touches.faces);
  pairs.collect(stage.problem, touches.pairs);
  if (pairs.is_needed()) outcome.num_stopped_nodes = pairs.stop_crossings(system, step);
  if (pairs.is_needed()) outcome.search_share = pairs.search_share();
  outcome.exhausted = pairs.exhausted();
  return outcome;
}

ContactOutcome run_velocity_stage(const System& system, bool friction, const Touches& touches,
                                  SystemStep& step) {
  Stage stage(system, step);
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < system.colliders.size(); ++k) {
    const RigidMotion& motion = step.rigids[k];
    Collider moved = system.colliders[k];
    write_motion(motion, step.time_step, moved);
    poses.push_back({moved.position, moved.orientation});
    stage.problem.rigids.push_back({.inverse_mass = motion.inverse_mass,
                                    .velocity = moved.velocity,
                                    .angular_velocity = moved.angular_velocity});
    if (moved.mass) stage.problem.rigids[k].inverse_inertia = world_inertia(moved).inverse();
  }
  stage.for_each_pair([&](std::size_t k, std::size_t b, int node) {
    const Body& body = system.bodies[b];
    const BodyStep& motion = step.bodies[b];
    const Vector3<double> end =
        body.positions.col(node) + step.time_step * motion.mean_velocities.col(node);
    const SurfaceDistance surface = signed_distance(system.colliders[k].shape, poses[k], end);
    if (!(surface.distance <= body.collision_margin + kTouchDistance)) return;
    Contact& contact = stage.add(k, b, node, motion.end_velocities.col(node));
    contact.normal = surface.normal;
    contact.lever = end - poses[k].position;
    contact.friction = friction ? combined_friction(system, k, b) : 0.0;
  });
  add_touches(system, step, poses, touches, friction, stage);
  const bool is_shared = !touches.faces.empty() || !touches.pairs.empty();
  const SweepReport report =
      solve_contacts(stage.problem, is_shared ? kSharedLimits : SweepLimits{});
  ContactOutcome outcome = outcome_of(stage.problem);
  outcome.sweeps = report.sweeps;
  outcome.visits = is_shared ? 0 : report.visits;
  outcome.converged = report.converged;
  for (const ContactPoint& point : stage.problem.points) {
    step.bodies[point.body].end_velocities.col(point.node) = point.velocity;
  }
  for (std::size_t k = 0; k < stage.problem.rigids.size(); ++k) {
    if (stage.problem.rigids[k].inverse_mass == 0.0) continue;
    step.rigids[k].end_velocity = stage.problem.rigids[k].velocity;
    step.rigids[k].angular_momentum += stage.problem.rigids[k].angular_impulse;
  }
  return outcome;
}

}  // namespace weft::reference
