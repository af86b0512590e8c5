#include <weft/bridge/solver.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/node_state.hpp>
#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

using LawSet = forces::LawSet<btScalar>;
using Level = forces::LawTraits::Level;
using State = forces::State<btScalar>;

struct SoftBodySolver::Attachment {
  btSoftBody* body;
  LawSet laws;
  VectorX<btScalar> masses;
  DampingPlace damping = DampingPlace::kAutomatic;
  Matrix3X<btScalar> start_velocities;  // of the step, only for inertia after the projection
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  Matrix3X<btScalar> forces;
  std::optional<BodyBlowUp> blow_up;
  bool was_in_world = false;
  double time = 0.0;  // [s] of the steps since the body was attached

  [[nodiscard]] bool acts_after_projection(Level level) const;
  void add_forces(btScalar time_step);
  void sum_laws();
  void damp_velocities(btScalar time_step);
  void slow_down_changes();
  void check_prediction(btScalar time_step);
  void check_laws();
};

struct SoftBodySolver::Attachments {
  std::vector<std::unique_ptr<Attachment>> list;
};

bool SoftBodySolver::Attachment::acts_after_projection(Level level) const {
  if (!laws.has_level(level)) return false;
  if (damping != DampingPlace::kAutomatic) return damping == DampingPlace::kAfterProjection;
  return level == Level::kVelocity || body->m_links.size() > 0;
}

// Velocity-level laws state how fast velocities decay: inertia does not slow them down.
void SoftBodySolver::Attachment::sum_laws() {
  using VelocityLaws = LawSet::VelocityLaws;
  const State state{positions, velocities, masses, time};
  const forces::ForceReport report = laws.add_forces(state, VelocityLaws::kSeparate, forces);
  if (!report.ok()) {
    blow_up = BodyBlowUp{*report.first_non_finite_node, "position or velocity is not finite"};
    return;
  }
  if (!acts_after_projection(Level::kInertia)) laws.redistribute_forces(state, forces);
  if (!acts_after_projection(Level::kVelocity)) {
    (void)laws.add_forces(state, VelocityLaws::kAlone, forces);
  }
}

void SoftBodySolver::Attachment::add_forces(btScalar time_step) {
  read_nodes(*body, positions, velocities);
  if (acts_after_projection(Level::kInertia)) start_velocities = velocities;
  forces.setZero(3, positions.cols());
  sum_laws();
  if (blow_up) return;
  check_prediction(time_step);
  if (!blow_up) add_node_forces(forces, *body);
}

// Looks at the velocities that predictMotion is about to make. Afterwards would be too late: a node
// without a place in space ruins the body's bounding-volume tree.
void SoftBodySolver::Attachment::check_prediction(btScalar time_step) {
  const auto max_speed = static_cast<btScalar>(kMaxSpeed);
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    const btScalar speed =
        (velocities.col(i) + forces.col(i) * (body->m_nodes[i].m_im * time_step)).norm();
    if (speed <= max_speed) continue;
    if (!std::isfinite(speed)) {
      blow_up = BodyBlowUp{i, "velocity is not finite"};
    } else {
      char text[64];
      std::snprintf(text, sizeof text, "speed %.3g m/s is over %.3g m/s",
                    static_cast<double>(speed), kMaxSpeed);
      blow_up = BodyBlowUp{i, text};
    }
    return;
  }
}

// Laws made for another mesh throw here, at attach, and not out of Bullet's step.
void SoftBodySolver::Attachment::check_laws() {
  read_nodes(*body, positions, velocities);
  forces.setZero(3, positions.cols());
  const State state{positions, velocities, masses, time};
  (void)laws.add_forces(state, LawSet::VelocityLaws::kAsForces, forces);
  laws.redistribute_forces(state, forces);
}

// The change of momentum over the step stands for the sum of all forces on the body.
void SoftBodySolver::Attachment::slow_down_changes() {
  forces = (velocities - start_velocities) * masses.asDiagonal();
  laws.redistribute_forces(State{positions, velocities, masses, time}, forces);
  velocities = start_velocities + forces * masses.cwiseInverse().asDiagonal();
}

void SoftBodySolver::Attachment::damp_velocities(btScalar time_step) {
  const bool slows_down = acts_after_projection(Level::kInertia);
  const bool advances = acts_after_projection(Level::kVelocity);
  if (!slows_down && !advances) return;
  read_nodes(*body, positions, velocities);
  if (slows_down) slow_down_changes();
  if (advances) {
    forces = velocities;  // the laws see the state as it is and change a copy
    laws.advance_velocities(State{positions, velocities, masses, time}, time_step, forces);
    velocities.swap(forces);
  }
  write_node_velocities(velocities, *body);
}

SoftBodySolver::SoftBodySolver(const BulletLayout& caller)
    : attachments_(std::make_unique<Attachments>()) {
  require_matching_bullet(caller);
}

SoftBodySolver::~SoftBodySolver() = default;

SoftBodySolver::Attachment* SoftBodySolver::find(const btSoftBody& body) const {
  for (const auto& attachment : attachments_->list) {
    if (attachment->body == &body) return attachment.get();
  }
  return nullptr;
}

void SoftBodySolver::attach(btSoftBody& body, const ClothMesh& mesh,
                            const std::vector<forces::LawSpecification>& laws,
                            DampingPlace damping) {
  LawSet set;
  for (const forces::LawSpecification& law : laws) set.add(forces::make_law<btScalar>(law, mesh));
  attach(body, std::move(set), mesh.masses.cast<btScalar>(), damping);
}

void SoftBodySolver::attach(btSoftBody& body, LawSet laws, VectorX<btScalar> masses,
                            DampingPlace damping) {
  if (has_laws(body)) {
    throw InvalidArgument("soft body solver: the body has laws already, expected detach() first");
  }
  if (masses.size() != body.m_nodes.size()) {
    throw InvalidArgument("soft body solver: " + std::to_string(masses.size()) +
                          " masses, expected one for each of the " +
                          std::to_string(body.m_nodes.size()) + " nodes");
  }
  for (Eigen::Index i = 0; i < masses.size(); ++i) {
    if (!(masses[i] > 0) || !std::isfinite(masses[i])) {
      throw InvalidArgument("soft body solver: mass of node " + std::to_string(i) + " = " +
                            std::to_string(masses[i]) + " [kg], expected > 0 and finite");
    }
  }
  if (body.m_cfg.timescale != btScalar(1)) {
    throw InvalidArgument("soft body solver: m_cfg.timescale = " +
                          std::to_string(body.m_cfg.timescale) + " [1], expected 1");
  }
  auto attachment = std::make_unique<Attachment>();
  attachment->body = &body;
  attachment->laws = std::move(laws);
  attachment->masses = std::move(masses);
  attachment->damping = damping;
  attachment->check_laws();
  attachments_->list.push_back(std::move(attachment));
}

void SoftBodySolver::detach(btSoftBody& body) {
  auto& list = attachments_->list;
  list.erase(std::remove_if(list.begin(), list.end(),
                            [&](const auto& attachment) { return attachment->body == &body; }),
             list.end());
}

bool SoftBodySolver::has_laws(const btSoftBody& body) const {
  return find(body) != nullptr;
}

std::optional<BodyBlowUp> SoftBodySolver::blow_up(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment ? attachment->blow_up : std::nullopt;
}

bool SoftBodySolver::is_frozen(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment && attachment->blow_up;
}

// The world hands over its bodies at the start of every step: one that was there and is no more may be deleted,
// and another may stand at its address tomorrow.
void SoftBodySolver::optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool force_update) {
  btDefaultSoftBodySolver::optimize(bodies, force_update);
  auto& list = attachments_->list;
  const auto has_left = [&](const std::unique_ptr<Attachment>& attachment) {
    const bool is_in_world =
        m_softBodySet.findLinearSearch(attachment->body) != m_softBodySet.size();
    const bool left = attachment->was_in_world && !is_in_world;
    attachment->was_in_world = is_in_world;
    return left;
  };
  list.erase(std::remove_if(list.begin(), list.end(), has_left), list.end());
}

void SoftBodySolver::predictMotion(btScalar time_step) {
  time_step_ = time_step;
  for (int i = 0; i < m_softBodySet.size(); ++i) {
    btSoftBody& body = *m_softBodySet[i];
    if (!body.isActive()) continue;
    Attachment* attachment = find(body);
    if (attachment && !attachment->blow_up) attachment->add_forces(time_step);
    if (!is_frozen(body)) body.predictMotion(time_step);
  }
}

void SoftBodySolver::solveConstraints(btScalar /*time_step*/) {
  // Velocities decay over the step that predictMotion was given. The argument here is the same time
  // before Bullet rounds it to single precision; to use it would mix two clocks in one step.
  for (int i = 0; i < m_softBodySet.size(); ++i) {
    btSoftBody& body = *m_softBodySet[i];
    if (!body.isActive() || is_frozen(body)) continue;
    body.solveConstraints();
    if (Attachment* attachment = find(body)) attachment->damp_velocities(time_step_);
  }
  for (const auto& attachment : attachments_->list) {
    if (attachment->was_in_world) attachment->time += static_cast<double>(time_step_);
  }
}

void SoftBodySolver::updateSoftBodies() {
  for (int i = 0; i < m_softBodySet.size(); ++i) {
    btSoftBody& body = *m_softBodySet[i];
    if (body.isActive() && !is_frozen(body)) body.integrateMotion();
  }
}

void SoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* object) {
  if (!is_frozen(*body)) btDefaultSoftBodySolver::processCollision(body, object);
}

void SoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other) {
  if (is_frozen(*body) || is_frozen(*other)) return;
  btDefaultSoftBodySolver::processCollision(body, other);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
