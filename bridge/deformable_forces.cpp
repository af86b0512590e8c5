#include <weft/bridge/deformable_forces.hpp>

#include <algorithm>
#include <utility>

#include <Eigen/Eigenvalues>

#include <weft/bridge/node_colors.hpp>
#include <weft/custom_forces/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

using LawSet = forces::LawSet<btScalar>;
using State = forces::State<btScalar>;
using Stack = btDeformableLagrangianForce::TVStack;
using NodeVector = btVector3 btSoftBody::Node::*;

struct DeformableForces::Attachment {
  btSoftBody* body;
  LawSet laws;
  VectorX<btScalar> masses;
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  Matrix3X<btScalar> forces;
  Matrix3X<btScalar> direction;
  Matrix3X<btScalar> still_positions;  ///< where still_forces were evaluated
  Matrix3X<btScalar> still_forces;     ///< f(x, 0) [N]
  Matrix3X<btScalar> no_velocities;
  std::vector<std::vector<int>> colors;  ///< see node_colors(); empty if the mesh is not known
  std::optional<BodyBlowUp> blow_up;

  [[nodiscard]] State state() const { return {positions, velocities, masses}; }
  [[nodiscard]] bool is_movable(int node) const { return body->m_nodes[node].m_im > 0; }
  void read(NodeVector position);
  bool evaluate();
  bool evaluate_velocity_part();
  void evaluate_still();
  void add_node_forces(btScalar scale, Stack& out) const;
  void write(btScalar scale, Stack& out) const;
  void explode(int node, std::string reason);
  [[nodiscard]] double clamp_speed(btScalar time_step) const;
  void add_effective_mass(btScalar time_step);
};

void DeformableForces::Attachment::read(NodeVector position) {
  const int num_nodes = body->m_nodes.size();
  positions.resize(3, num_nodes);
  velocities.resize(3, num_nodes);
  for (int i = 0; i < num_nodes; ++i) {
    const btSoftBody::Node& node = body->m_nodes[i];
    const btVector3& x = node.*position;
    positions.col(i) << x.x(), x.y(), x.z();
    velocities.col(i) << node.m_v.x(), node.m_v.y(), node.m_v.z();
  }
}

// False if the state is beyond use; the body is then frozen.
bool DeformableForces::Attachment::evaluate() {
  forces.setZero(3, positions.cols());
  const forces::ForceReport report =
      laws.add_forces(state(), LawSet::VelocityLaws::kAsForces, forces);
  if (!report.ok()) {
    explode(*report.first_non_finite_node, "position or velocity is not finite");
    return false;
  }
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    if (forces.col(i).allFinite()) continue;
    explode(static_cast<int>(i), "force is not finite");
    return false;
  }
  return true;
}

void DeformableForces::Attachment::evaluate_still() {
  if (still_positions.cols() == positions.cols() && still_positions == positions) return;
  no_velocities.setZero(3, positions.cols());
  still_forces.setZero(3, positions.cols());
  still_positions = positions;
  (void)laws.add_forces(State{positions, no_velocities, masses}, LawSet::VelocityLaws::kAsForces,
                        still_forces);
}

// forces = f(x, v) - f(x, 0). Where nothing depends on velocity this is zero to the last bit.
bool DeformableForces::Attachment::evaluate_velocity_part() {
  if (!evaluate()) return false;
  evaluate_still();
  forces -= still_forces;
  return true;
}

void DeformableForces::Attachment::write(btScalar scale, Stack& out) const {
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    if (!is_movable(i)) continue;
    out[body->m_nodes[i].index] += scale * btVector3(forces(0, i), forces(1, i), forces(2, i));
  }
}

void DeformableForces::Attachment::add_node_forces(btScalar scale, Stack& out) const {
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    if (is_movable(i)) out[body->m_nodes[i].index] += scale * body->m_nodes[i].m_f;
  }
}

void DeformableForces::Attachment::explode(int node, std::string reason) {
  blow_up = BodyBlowUp{node, std::move(reason)};
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    body->m_nodes[i].m_v.setZero();
    body->m_nodes[i].m_vn.setZero();
    body->m_nodes[i].m_splitv.setZero();
  }
  body->m_nodeRigidContacts.resize(0);
  body->m_faceRigidContacts.resize(0);
  body->m_faceNodeContacts.resize(0);
  body->m_faceNodeContactsCCD.resize(0);
  body->forceActivationState(DISABLE_SIMULATION);
}

// Bullet's explicit step clamps every node to the diagonal of the body's bounds per step.
double DeformableForces::Attachment::clamp_speed(btScalar time_step) const {
  const Vector3<btScalar> size = positions.rowwise().maxCoeff() - positions.rowwise().minCoeff();
  const btScalar margin = 2 * body->getCollisionShape()->getMargin();
  return static_cast<double>((size + Vector3<btScalar>::Constant(margin)).norm() / time_step);
}

namespace {

/// Hears of everything near a box that is not soft.
struct RigidNearby : btBroadphaseAabbCallback {
  bool found = false;
  bool process(const btBroadphaseProxy* proxy) override {
    const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
    found = found || !btSoftBody::upcast(object);
    return !found;
  }
};

// Whether a step could bring the body into contact: half its size around it is far beyond that.
bool may_touch_rigid(const btSoftBody& body, const Matrix3X<btScalar>& positions) {
  const Vector3<btScalar> low = positions.rowwise().minCoeff();
  const Vector3<btScalar> high = positions.rowwise().maxCoeff();
  const btScalar reach = (high - low).norm() / 2 + 2 * body.getCollisionShape()->getMargin();
  const btVector3 around(reach, reach, reach);
  RigidNearby nearby;
  body.m_worldInfo->m_broadphase->aabbTest(btVector3(low[0], low[1], low[2]) - around,
                                           btVector3(high[0], high[1], high[2]) + around, nearby);
  return nearby.found;
}

// The part of a symmetric 3 x 3 block that makes a node heavier.
Eigen::Matrix<btScalar, 3, 3> positive_part(const Eigen::Matrix<btScalar, 3, 3>& block) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<btScalar, 3, 3>> solver((block + block.transpose()) /
                                                                      2);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(btScalar(0)).asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

void DeformableForces::Attachment::add_effective_mass(btScalar time_step) {
  std::vector<Eigen::Matrix<btScalar, 3, 3>> blocks(static_cast<std::size_t>(body->m_nodes.size()));
  for (const std::vector<int>& group : colors) {
    for (int axis = 0; axis < 3; ++axis) {
      direction.setZero(3, positions.cols());
      for (const int node : group) direction(axis, node) = 1;
      forces.setZero(3, positions.cols());
      laws.add_stiffness_product(state(), direction, forces);
      forces *= time_step;
      laws.add_damping_product(state(), direction, forces);
      forces *= -time_step;
      for (const int node : group) {
        blocks[static_cast<std::size_t>(node)].col(axis) = forces.col(node);
      }
    }
  }
  for (const std::vector<int>& group : colors) {
    for (const int node : group) {
      if (!is_movable(node) || !blocks[static_cast<std::size_t>(node)].allFinite()) continue;
      const auto block = positive_part(blocks[static_cast<std::size_t>(node)]);
      body->m_nodes[node].m_effectiveMass +=
          btMatrix3x3(block(0, 0), block(0, 1), block(0, 2), block(1, 0), block(1, 1), block(1, 2),
                      block(2, 0), block(2, 1), block(2, 2));
    }
  }
}

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

DeformableForces::Attachment* DeformableForces::find(const btSoftBody& body) const {
  for (const auto& attachment : attachments_) {
    if (attachment->body == &body) return attachment.get();
  }
  return nullptr;
}

void DeformableForces::attach(btSoftBody& body, const ClothMesh& mesh,
                              const std::vector<forces::LawSpecification>& laws) {
  attach(body, make_laws(mesh, laws), mesh.masses.cast<btScalar>());
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
  check_attachment("deformable forces", body, masses);
  check_ignored_features(body);
  auto attachment = std::make_unique<Attachment>();
  attachment->body = &body;
  attachment->laws = std::move(laws);
  attachment->masses = std::move(masses);
  // Laws made for another mesh throw here, and not out of Bullet's step.
  attachment->read(&btSoftBody::Node::m_x);
  attachment->forces.setZero(3, attachment->positions.cols());
  (void)attachment->laws.add_forces(attachment->state(), LawSet::VelocityLaws::kAsForces,
                                    attachment->forces);
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

void DeformableForces::removeSoftBody(btSoftBody* body) {
  detach(*body);
}

bool DeformableForces::has_laws(const btSoftBody& body) const {
  return find(body) != nullptr;
}

std::optional<BodyBlowUp> DeformableForces::blow_up(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment ? attachment->blow_up : std::nullopt;
}

// A body takes part once the solver has numbered its nodes.
bool DeformableForces::takes_part(const Attachment& attachment) const {
  const auto& nodes = attachment.body->m_nodes;
  if (!m_nodes || attachment.blow_up || !attachment.body->isActive()) return false;
  if (nodes.size() != attachment.masses.size()) return false;
  const int index = nodes[0].index;
  return index >= 0 && index + nodes.size() <= m_nodes->size() && (*m_nodes)[index] == &nodes[0];
}

void DeformableForces::reinitialize(bool /*nodes_updated*/) {
  solve_has_failed_ = false;
  if (solver_ && solver_->m_objective->m_implicit && !repairs_implicit_) {
    throw Error(
        "deformable forces: an implicit step with Bullet's btDeformableBodySolver, which mixes up "
        "forces when a node is pinned; expected weft::bridge::DeformableSolver or explicit mode");
  }
}

void DeformableForces::addScaledExplicitForce(btScalar scale, Stack& force) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_x);
    if (!attachment->evaluate()) continue;  // the velocity may be the part that is not finite
    attachment->still_positions.resize(3, 0);
    attachment->evaluate_still();
    attachment->forces = attachment->still_forces;
    const double clamp = attachment->clamp_speed(scale);
    auto found = predicted_blow_up(*attachment->body, attachment->velocities, attachment->forces,
                                   scale, std::min(clamp, kBlowUpSpeed));
    if (found) {
      attachment->explode(found->node, std::move(found->reason));
      continue;
    }
    attachment->write(scale, force);
    attachment->add_node_forces(scale, force);
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
    attachment->add_node_forces(scale, force);
  }
}

void DeformableForces::addScaledHessian(btScalar scale) {
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    attachment->read(&btSoftBody::Node::m_q);
    if (!may_touch_rigid(*attachment->body, attachment->positions)) continue;
    attachment->add_effective_mass(scale);
  }
}

void DeformableForces::add_differential(btScalar scale, bool elastic, const Stack& direction,
                                        Stack& product) {
  const bool implicit = elastic || (solver_ && solver_->m_objective->m_implicit);
  for (const auto& attachment : attachments_) {
    if (!takes_part(*attachment)) continue;
    Attachment& a = *attachment;
    a.read(implicit ? &btSoftBody::Node::m_q : &btSoftBody::Node::m_x);
    a.direction.resize(3, a.positions.cols());
    for (int i = 0; i < a.body->m_nodes.size(); ++i) {
      const btVector3& d = direction[a.body->m_nodes[i].index];
      a.direction.col(i) << d.x(), d.y(), d.z();
    }
    a.forces.setZero(3, a.positions.cols());
    if (elastic) {
      a.laws.add_stiffness_product(a.state(), a.direction, a.forces);
    } else {
      a.laws.add_damping_product(a.state(), a.direction, a.forces);
    }
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
    energy += static_cast<double>(attachment->laws.potential_energy(attachment->state()));
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
