#include <weft/validation/reference/contact/contact_stages.hpp>

#include <weft/validation/reference/contact/contact_problem.hpp>
#include <weft/validation/reference/contact/signed_distance.hpp>

namespace weft::reference {
namespace {

/// Collects contacts of a step and writes their impulses back. Order: collider, body, node.
class Stage {
 public:
  Stage(const System& system, SystemStep& step) : system_(system), step_(step) {
    for (const Body& body : system.bodies) {
      first_node_.push_back(num_nodes_);
      num_nodes_ += body.mesh.num_nodes();
    }
    contact_of_.assign(num_nodes_ * system.colliders.size(), kNone);
    point_of_.assign(num_nodes_, kNone);
  }

  ContactProblem problem;

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
    return index == kNone ? nullptr : &problem.contacts[index];
  }

  Contact& add(std::size_t k, std::size_t b, int node, const Vector3<double>& velocity) {
    int& point = point_of_[first_node_[b] + node];
    if (point == kNone) {
      point = static_cast<int>(problem.points.size());
      problem.points.push_back({.body = static_cast<int>(b),
                                .node = node,
                                .inverse_mass = step_.inverse_masses[b][node],
                                .velocity = velocity});
    }
    contact_of_[pair_index(k, b, node)] = static_cast<int>(problem.contacts.size());
    problem.contacts.push_back({.point = point, .rigid = static_cast<int>(k)});
    return problem.contacts.back();
  }

  /// Velocity of a node as the problem knows it now, or the given one if it has no contact.
  Vector3<double> velocity(std::size_t b, int node, const Matrix3X<double>& otherwise) const {
    const int point = point_of_[first_node_[b] + node];
    return point == kNone ? Vector3<double>(otherwise.col(node)) : problem.points[point].velocity;
  }

 private:
  static constexpr int kNone = -1;
  std::size_t pair_index(std::size_t k, std::size_t b, int node) const {
    return k * num_nodes_ + first_node_[b] + node;
  }

  const System& system_;
  SystemStep& step_;
  std::size_t num_nodes_ = 0;
  std::vector<std::size_t> first_node_;
  std::vector<int> contact_of_;  // per collider and node
  std::vector<int> point_of_;    // per node
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

/// The point that a position-stage impulse acts at, relative to the collider's: see
/// make_impulse_contact().
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

/// Linearises every surface at the predicted end of the step, or only those of new contacts.
/// False: nothing new, the solution stands.
bool linearise(const System& system, const PositionStage& options, const SystemStep& step,
               bool only_new, Stage& stage) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < system.colliders.size(); ++k) {
    RigidMotion motion = step.rigids[k];
    motion.mean_velocity = stage.problem.rigids[k].velocity;
    motion.mean_angular_velocity = stage.problem.rigids[k].angular_velocity;
    poses.push_back(end_pose(system.colliders[k], motion, step.time_step));
  }
  bool changed = false;
  stage.for_each_pair([&](std::size_t k, std::size_t b, int node) {
    const Body& body = system.bodies[b];
    const Vector3<double> velocity = stage.velocity(b, node, step.bodies[b].mean_velocities);
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

ContactOutcome run_position_stage(const System& system, const PositionStage& options,
                                  SystemStep& step) {
  Stage stage(system, step);
  for (const RigidMotion& motion : step.rigids) {
    stage.problem.rigids.push_back({.inverse_mass = motion.inverse_mass,
                                    .inverse_inertia = motion.start_inverse_inertia,
                                    .velocity = motion.mean_velocity,
                                    .angular_velocity = motion.mean_angular_velocity});
  }
  int passes = 0;
  int sweeps = 0;
  bool converged = true;
  bool changed = linearise(system, options, step, false, stage);
  while (changed && passes < kMaxPasses) {
    const SweepReport report = solve_contacts(stage.problem);
    ++passes;
    sweeps += report.sweeps;
    converged = report.converged;
    changed = linearise(system, options, step, passes >= kSmoothPasses, stage);
  }
  ContactOutcome outcome = outcome_of(stage.problem);
  outcome.passes = passes;
  outcome.sweeps = sweeps;
  outcome.converged = converged && !changed;
  write_position_stage(stage.problem, options, step);
  return outcome;
}

ContactOutcome run_velocity_stage(const System& system, bool friction, SystemStep& step) {
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
  const SweepReport report = solve_contacts(stage.problem);
  ContactOutcome outcome = outcome_of(stage.problem);
  outcome.sweeps = report.sweeps;
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
