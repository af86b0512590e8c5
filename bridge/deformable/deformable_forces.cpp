#include <weft/bridge/deformable/deformable_forces.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <weft/bridge/classic/nodes/node_colors.hpp>
#include <weft/bridge/deformable/deformable_attachment.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

using LawSet = forces::LawSet<btScalar>;
using Stack = btDeformableLagrangianForce::TVStack;

DeformableForces::DeformableForces(const BulletLayout& caller) {
  require_matching_bullet(caller);
  m_nodes = nullptr;  // Bullet's constructor leaves it as it is
}

DeformableForces::~DeformableForces() = default;

void DeformableForces::add_to(btDeformableBodySolver& solver, bool repairs_implicit) {
  if (solver_) throw Error("deformable forces: they have a solver already, expected one");
  setIndices(solver.getIndices());
  solver.getLagrangianForceArray()->push_back(this);
  solver_ = &solver;
  repairs_implicit_ = repairs_implicit;
}

void DeformableForces::remove_from(btDeformableBodySolver& solver) {
  solver.getLagrangianForceArray()->remove(this);
  if (solver_ != &solver) return;
  solver_ = nullptr;
  m_nodes = nullptr;
}

DeformableAttachment* DeformableForces::find(const btSoftBody& body) const {
  for (const auto& attachment : attachments_) {
    if (attachment->body == &body && attachment->life->is_alive) return attachment.get();
  }
  return nullptr;
}

void DeformableForces::attach(btSoftBody& body, const ClothMesh& mesh,
                              const std::vector<forces::LawSpecification>& laws) {
  check_topology("deformable forces", body, mesh);
  LawSet set = make_laws(mesh, laws);
  attach(body, std::move(set), mesh.masses.cast<btScalar>());
  attachments_.back()->colors = node_colors(mesh);
}

namespace {

void check_ignored_features(const btSoftBody& body) {
  const auto refuse = [](const std::string& what, const std::string& instead) {
    throw InvalidArgument("deformable forces: the body has " + what +
                          ", which Bullet's deformable world ignores; expected " + instead);
  };
  const btSoftBody::Config& config = body.m_cfg;
  if (body.m_anchors.size() > 0) refuse("anchors of appendAnchor", "appendDeformableAnchor");
  if (body.m_windVelocity.length2() > 0) refuse("a wind velocity", "a law");
  if (config.kLF != 0 || config.kDG != 0) refuse("lift or drag (kLF, kDG)", "0 and a law");
  if (config.kPR != 0 || config.kVC != 0) refuse("pressure or volume (kPR, kVC)", "0 and a law");
  if (config.kMT != 0) refuse("pose matching (kMT)", "0");
  if (config.kDP != 0) refuse("damping (kDP)", "0 and the law velocity_damping");
}

}  // namespace

void DeformableForces::attach(btSoftBody& body, LawSet laws, VectorX<btScalar> masses) {
  if (has_laws(body)) {
    throw InvalidArgument("deformable forces: the body has laws already, expected detach() first");
  }
  if (solver_) check_solver("deformable forces", body, *solver_);
  check_attachment("deformable forces", body, masses);
  check_ignored_features(body);
  if (laws.has_level(forces::LawTraits::Level::kInertia)) {
    throw InvalidArgument(
        "deformable forces: a law of inertia level (acceleration_damping), which Bullet's linear "
        "solver cannot carry; expected the classic world for it");
  }
  auto attachment = std::make_unique<DeformableAttachment>();
  attachment->body = &body;
  attachment->laws = std::move(laws);
  attachment->followed = FollowedMasses(body, std::move(masses));
  // Laws made for another mesh throw here, and not out of Bullet's step.
  attachment->read(&btSoftBody::Node::m_x);
  attachment->forces.setZero(3, attachment->positions.cols());
  (void)attachment->laws.add_forces(attachment->state(), LawSet::VelocityLaws::kAsForces,
                                    attachment->forces);
  forget_deleted();
  attachment->life = follow_life(body);
  attachments_.push_back(std::move(attachment));
  m_softBodies.push_back(&body);  // for testDerivative() and testHessian()
}

void DeformableForces::detach(btSoftBody& body) {
  m_softBodies.remove(&body);
  attachments_.erase(
      std::remove_if(attachments_.begin(), attachments_.end(),
                     [&](const auto& attachment) { return attachment->body == &body; }),
      attachments_.end());
}

// Those that were deleted without having been in a world, which tells of all that leave it.
void DeformableForces::forget_deleted() {
  std::erase_if(attachments_, [&](const auto& attachment) {
    if (attachment->life->is_alive) return false;
    m_softBodies.remove(attachment->body);
    return true;
  });
}

void DeformableForces::removeSoftBody(btSoftBody* body) {
  detach(*body);
}

std::optional<BodyBlowUp> DeformableForces::blow_up(const btSoftBody& body) const {
  const DeformableAttachment* attachment = find(body);
  return attachment ? attachment->blow_up : std::nullopt;
}

void DeformableForces::advance_time(double time_step) {
  for (const auto& attachment : attachments_) attachment->time += time_step;
  tell_of_blow_ups();
}

void serialize(StateArchive& archive, DeformableForces& forces) {
  archive.part("deformable forces");
  forces.forget_deleted();
  archive.expect(forces.attachments_.size(), "number of bodies with laws");
  for (const auto& attachment : forces.attachments_) {
    archive.expect(attachment->followed.values().size(), "number of masses");
    attachment->followed.serialize(archive);
    archive.value(attachment->time);
    archive.value(attachment->is_reported);
    archive.optional(attachment->blow_up, [&](BodyBlowUp& blow_up) {
      archive.value(blow_up.node);
      archive.value(blow_up.reason);
    });
    if (archive.is_reading()) attachment->still_positions.resize(3, 0);
  }
}

void DeformableForces::set_on_blow_up(
    std::function<void(btSoftBody&, const BodyBlowUp&)> callback) {
  on_blow_up_ = std::move(callback);
}

// A step is no place for an exception: one that the callback lets go ends the program.
void DeformableForces::tell_of_blow_ups() noexcept {
  if (!on_blow_up_) return;
  std::vector<std::pair<btSoftBody*, BodyBlowUp>> news;  // the callback may attach and detach
  for (const auto& attachment : attachments_) {
    if (!attachment->blow_up || attachment->is_reported) continue;
    attachment->is_reported = true;
    news.emplace_back(attachment->body, *attachment->blow_up);
  }
  const auto callback = on_blow_up_;  // which may set another one
  for (const auto& [body, blow_up] : news) callback(*body, blow_up);
}

// A body takes part once the solver has numbered its nodes.
bool DeformableForces::takes_part(const DeformableAttachment& attachment) const {
  const auto& nodes = attachment.body->m_nodes;
  if (!m_nodes || attachment.blow_up || !attachment.body->isActive()) return false;
  if (nodes.size() != attachment.followed.values().size()) return false;
  const int index = nodes[0].index;
  return index >= 0 && index + nodes.size() <= m_nodes->size() && (*m_nodes)[index] == &nodes[0];
}

void DeformableForces::reinitialize(bool /*nodes_updated*/) {
  solve_has_failed_ = false;
  forget_deleted();
  tell_of_blow_ups();  // of the step before, where nobody calls advance_time()
  for (const auto& attachment : attachments_) {
    const int node = attachment->followed.follow(*attachment->body);
    if (node < 0 || attachment->blow_up) continue;
    const btScalar mass = attachment->followed.values()[node];
    attachment->still_positions.resize(3, 0);  // forces there were with other masses
    if (mass > 0 && std::isfinite(mass)) continue;
    attachment->explode(node,
                        "its m_im is not a number, negative or infinite, expected 1 / mass [1/kg]");
  }
  if (solver_ && solver_->m_objective->m_implicit && !repairs_implicit_) {
    throw Error(
        "deformable forces: an implicit step with Bullet's btDeformableBodySolver, which mixes up "
        "forces when a node is pinned; expected weft::bridge::DeformableSolver or explicit mode");
  }
}

void DeformableForces::find_explosions(btScalar time_step) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_x);
    attachment->no_velocities.setZero(3, attachment->positions.cols());
    auto found = predicted_blow_up(*attachment->body, attachment->velocities,
                                   attachment->no_velocities, time_step, kBlowUpSpeed);
    if (!found) found = attachment->beyond_distance_field(time_step);
    if (found) attachment->explode(found->node, std::move(found->reason));
  }
}

void DeformableForces::addScaledExplicitForce(btScalar scale, Stack& force) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_x);
    if (!attachment->evaluate_still()) continue;
    attachment->forces = attachment->still_forces;
    const double clamp = attachment->clamp_speed(scale);
    auto found = predicted_blow_up(*attachment->body, attachment->velocities, attachment->forces,
                                   scale, std::min(clamp, kBlowUpSpeed));
    if (found) {
      attachment->explode(found->node, std::move(found->reason));
      continue;
    }
    attachment->write(scale, force);
    attachment->write_node_forces(scale, force);
    for (int i = 0; i < attachment->body->m_nodes.size(); ++i) {
      attachment->body->m_nodes[i].m_f.setZero();
    }
  }
}

void DeformableForces::addScaledDampingForce(btScalar scale, Stack& force) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_x);
    if (attachment->evaluate_velocity_part()) attachment->write(scale, force);
  }
}

void DeformableForces::addScaledForces(btScalar scale, Stack& force) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_q);
    if (!attachment->evaluate()) continue;
    // The forces of an implicit step do not say how fast the body will be; its velocity does.
    attachment->no_velocities.setZero(3, attachment->positions.cols());
    auto found = predicted_blow_up(*attachment->body, attachment->velocities,
                                   attachment->no_velocities, scale, kBlowUpSpeed);
    if (found) {
      attachment->explode(found->node, std::move(found->reason));
      continue;
    }
    attachment->write(scale, force);
    attachment->write_node_forces(scale, force);
  }
}

void DeformableForces::addScaledHessian(btScalar scale) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_q);
    attachment->guard([&] { attachment->add_effective_mass(scale); });
  }
}

void DeformableForces::add_differential(btScalar scale, bool elastic, const Stack& direction,
                                        Stack& product) {
  const bool implicit = elastic || (solver_ && solver_->m_objective->m_implicit);
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    DeformableAttachment& a = *attachment;
    a.read(implicit ? &btSoftBody::Node::m_q : &btSoftBody::Node::m_x);
    a.direction.resize(3, a.positions.cols());
    for (int i = 0; i < a.body->m_nodes.size(); ++i) {
      const btVector3& d = direction[a.body->m_nodes[i].index];
      a.direction.col(i) << d.x(), d.y(), d.z();
    }
    a.forces.setZero(3, a.positions.cols());
    const bool is_done = a.guard([&] {
      if (elastic) {
        a.laws.add_stiffness_product(a.state(), a.direction, a.forces);
      } else {
        a.laws.add_damping_product(a.state(), a.direction, a.forces);
      }
    });
    if (!is_done) continue;
    if (a.forces.allFinite()) {
      a.write(scale, product);
      continue;
    }
    // Bullet would go on, set what is not a number to zero, and nobody would know. All bodies are
    // in one linear system: where the first bad product comes from good input, the others are
    // victims.
    const bool is_source = a.direction.allFinite();
    if (is_source || !solve_has_failed_) {
      a.explode(0, "the velocity change of the linear solver is not finite");
    }
    solve_has_failed_ = solve_has_failed_ || is_source;
  }
}

void DeformableForces::addScaledElasticForceDifferential(btScalar scale, const Stack& dx,
                                                         Stack& df) {
  add_differential(scale, true, dx, df);
}

void DeformableForces::addScaledDampingForceDifferential(btScalar scale, const Stack& dv,
                                                         Stack& df) {
  add_differential(scale, false, dv, df);
}

double DeformableForces::totalElasticEnergy(btScalar /*time_step*/) {
  double energy = 0;
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_q);
    attachment->guard([&] {
      energy += static_cast<double>(attachment->laws.potential_energy(attachment->state()));
    });
  }
  return energy;
}

double DeformableForces::totalDampingEnergy(btScalar time_step) {
  double energy = 0;
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_q);
    if (!attachment->evaluate_velocity_part()) continue;
    energy -= 0.5 * static_cast<double>(time_step) *
              static_cast<double>(attachment->forces.cwiseProduct(attachment->velocities).sum());
  }
  return energy;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
