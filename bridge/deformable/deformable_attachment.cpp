#include <weft/bridge/deformable/deformable_attachment.hpp>

#include <cstdio>
#include <utility>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <Eigen/Eigenvalues>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

using LawSet = forces::LawSet<btScalar>;
using State = forces::State<btScalar>;
using Stack = DeformableAttachment::Stack;

void DeformableAttachment::read(NodeVector position) {
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

bool DeformableAttachment::evaluate_at(const Matrix3X<btScalar>& at_velocities,
                                       Matrix3X<btScalar>& result) {
  result.setZero(3, positions.cols());
  forces::ForceReport report;
  const bool is_done = guard([&] {
    report = laws.add_forces(State{positions, at_velocities, followed.values(), time},
                             LawSet::VelocityLaws::kAsForces, result);
  });
  if (!is_done) return false;
  if (!report.ok()) {
    explode(*report.first_non_finite_node, "position or velocity is not finite");
    return false;
  }
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    if (result.col(i).allFinite()) continue;
    explode(static_cast<int>(i), "force is not finite");
    return false;
  }
  return true;
}

bool DeformableAttachment::evaluate() {
  return evaluate_at(velocities, forces);
}

bool DeformableAttachment::evaluate_still() {
  if (still_time == time && still_positions.cols() == positions.cols() &&
      still_positions == positions) {
    return true;
  }
  no_velocities.setZero(3, positions.cols());
  still_positions.resize(3, 0);
  if (!evaluate_at(no_velocities, still_forces)) return false;
  still_positions = positions;
  still_time = time;
  return true;
}

bool DeformableAttachment::evaluate_velocity_part() {
  if (!evaluate() || !evaluate_still()) return false;
  forces -= still_forces;
  return true;
}

void DeformableAttachment::write(btScalar scale, Stack& out) const {
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    if (!is_movable(i)) continue;
    out[body->m_nodes[i].index] += scale * btVector3(forces(0, i), forces(1, i), forces(2, i));
  }
}

void DeformableAttachment::write_node_forces(btScalar scale, Stack& out) const {
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    if (is_movable(i)) out[body->m_nodes[i].index] += scale * body->m_nodes[i].m_f;
  }
}

void DeformableAttachment::explode(int node, std::string reason) {
  blow_up = BodyBlowUp{node, std::move(reason)};
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    body->m_nodes[i].m_v.setZero();
    body->m_nodes[i].m_vn.setZero();
    body->m_nodes[i].m_splitv.setZero();
  }
  body->m_nodeRigidContacts.clear();
  body->m_faceRigidContacts.clear();
  body->m_faceNodeContacts.clear();
  body->m_faceNodeContactsCCD.clear();
  body->forceActivationState(DISABLE_SIMULATION);
}

std::optional<BodyBlowUp> DeformableAttachment::beyond_distance_field(btScalar time_step) const {
  // Cells have four voxels and are counted in int; the rest leaves room for the collider's own position.
  constexpr btScalar kMaxVoxels = 1e9;
  const btScalar reach = kMaxVoxels * body->m_worldInfo->m_sparsesdf.m_defaultVoxelsz;
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const Vector3<btScalar> position = positions.col(i) + time_step * velocities.col(i);
    if (position.cwiseAbs().maxCoeff() <= reach) continue;
    char text[96];
    std::snprintf(text, sizeof text,
                  "position %.3g m from the origin is beyond the %.3g m of the distance field",
                  static_cast<double>(position.norm()), static_cast<double>(reach));
    return BodyBlowUp{static_cast<int>(i), text};
  }
  return std::nullopt;
}

double DeformableAttachment::clamp_speed(btScalar time_step) const {
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

void DeformableAttachment::add_effective_mass(btScalar time_step) {
  if (!may_touch_rigid(*body, positions)) return;
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

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
