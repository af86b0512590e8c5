#include <weft/bridge/snapshot/bullet_state.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

#include <BulletDynamics/ConstraintSolver/btConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using Node = btSoftBody::Node;

/// All nodes in one piece, for a call for each number took two thirds of the time of a snapshot.
template <btVector3 Node::*kVector>
void serialize_nodes(StateArchive& archive, btSoftBody& body) {
  Matrix3X<btScalar> vectors = vectors_of<kVector>(body);
  archive.values(std::span(vectors.data(), static_cast<std::size_t>(vectors.size())));
  for (int i = 0; i < body.m_nodes.size() && archive.is_reading(); ++i) {
    body.m_nodes[i].*kVector = to_bullet(vectors.col(i));
  }
}

template <class Is>
bool any_node(const btSoftBody& body, const Is& is) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    if (is(body.m_nodes[i])) return true;
  }
  return false;
}

void serialize_inverse_masses(StateArchive& archive, btSoftBody& body) {
  VectorX<btScalar> inverse_masses(body.m_nodes.size());
  for (int i = 0; i < body.m_nodes.size(); ++i) inverse_masses[i] = body.m_nodes[i].m_im;
  archive.runs(std::span(inverse_masses.data(), static_cast<std::size_t>(inverse_masses.size())));
  for (int i = 0; i < body.m_nodes.size() && archive.is_reading(); ++i) {
    body.m_nodes[i].m_im = inverse_masses[i];
  }
}

void serialize_sleep(StateArchive& archive, btCollisionObject& object) {
  int state = object.getActivationState();
  btScalar deactivation_time = object.getDeactivationTime();
  archive.value(state);
  archive.value(deactivation_time);
  if (!archive.is_reading()) return;
  object.forceActivationState(state);
  object.setDeactivationTime(deactivation_time);
}

void serialize_motion(StateArchive& archive, btRigidBody& rigid) {
  btTransform pose = rigid.getCenterOfMassTransform();
  btTransform last_pose = rigid.getInterpolationWorldTransform();
  std::array<btVector3, 6> vectors{rigid.getLinearVelocity(),
                                   rigid.getAngularVelocity(),
                                   rigid.getInterpolationLinearVelocity(),
                                   rigid.getInterpolationAngularVelocity(),
                                   rigid.getTotalForce(),
                                   rigid.getTotalTorque()};
  serialize(archive, pose);
  serialize(archive, last_pose);
  for (btVector3& vector : vectors) serialize(archive, vector);
  if (!archive.is_reading()) {
    rigid.updateInertiaTensor();  // of this pose, as it will be after a restore
    return;
  }
  rigid.setCenterOfMassTransform(pose);
  rigid.setLinearVelocity(vectors[0]);
  rigid.setAngularVelocity(vectors[1]);
  rigid.setInterpolationWorldTransform(last_pose);
  rigid.setInterpolationLinearVelocity(vectors[2]);
  rigid.setInterpolationAngularVelocity(vectors[3]);
  rigid.clearForces();
  const btVector3& linear_factor = rigid.getLinearFactor();
  const btVector3& angular_factor = rigid.getAngularFactor();
  const auto without = [](const btVector3& vector, const btVector3& factor) {
    btVector3 result(0, 0, 0);
    for (int k = 0; k < 3; ++k) result[k] = factor[k] != 0 ? vector[k] / factor[k] : btScalar(0);
    return result;
  };
  rigid.applyCentralForce(without(vectors[4], linear_factor));
  rigid.applyTorque(without(vectors[5], angular_factor));
}

}  // namespace

void serialize(StateArchive& archive, btVector3& vector) {
  archive.values(std::span(vector.m_floats).first(3));
  if (archive.is_reading()) vector[3] = 0;
}

void serialize(StateArchive& archive, btTransform& transform) {
  for (int k = 0; k < 3; ++k) serialize(archive, transform.getBasis()[k]);
  serialize(archive, transform.getOrigin());
}

void check_savable(const btCollisionObject& object, int number) {
  const auto refuse = [&](const char* what) {
    throw Error("snapshot: object " + std::to_string(number) + " of the world " + what);
  };
  if (dynamic_cast<const btMultiBodyLinkCollider*>(&object) != nullptr) {
    refuse(
        "is a link of a btMultiBody, whose joints a snapshot does not have; expected rigid and "
        "soft bodies");
  }
  const btSoftBody* const body = btSoftBody::upcast(&object);
  if (body == nullptr) return;
  if (body->m_clusters.size() > 0) refuse("is a soft body with clusters, expected one without");
  if (body->m_pose.m_bvolume || body->m_pose.m_bframe) {
    refuse("is a soft body with a pose to match, expected one without");
  }
}

void serialize(StateArchive& archive, btCollisionObject& object) {
  if (btRigidBody* const rigid = btRigidBody::upcast(&object)) {
    serialize_motion(archive, *rigid);
  } else {
    serialize(archive, object.getWorldTransform());
  }
  serialize_sleep(archive, object);
}

void serialize(StateArchive& archive, bool keeps_starts, btSoftBody& body) {
  archive.part("soft body");
  archive.expect(body.m_nodes.size(), "number of nodes");
  archive.expect(body.m_links.size(), "number of links");
  archive.expect(body.m_faces.size(), "number of faces");
  archive.expect(body.m_anchors.size() + body.m_deformableAnchors.size(), "number of anchors");
  serialize_inverse_masses(archive, body);
  serialize_nodes<&Node::m_x>(archive, body);
  serialize_nodes<&Node::m_v>(archive, body);
  bool has_starts = keeps_starts;
  archive.value(has_starts);
  if (has_starts) {
    serialize_nodes<&Node::m_q>(archive, body);
  } else if (archive.is_reading()) {
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_q = body.m_nodes[i].m_x;
  }
  bool has_forces = any_node(body, [](const Node& node) { return !node.m_f.isZero(); });
  archive.value(has_forces);
  if (has_forces) {
    serialize_nodes<&Node::m_f>(archive, body);
  } else if (archive.is_reading()) {
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_f.setZero();
  }
  for (btVector3& bound : body.m_bounds) serialize(archive, bound);
  serialize(archive, body.m_windVelocity);
  serialize_sleep(archive, body);
  if (!archive.is_reading()) return;
  // They are those of a step, and the next one finds its own.
  body.m_rcontacts.resizeNoInitialize(0);
  body.m_scontacts.resizeNoInitialize(0);
}

void rebuild_trees(bool has_face_tree, btSoftBody& body) {
  const btScalar margin = body.getCollisionShape()->getMargin();
  body.m_ndbvt.clear();
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    Node& node = body.m_nodes[i];
    node.m_leaf = body.m_ndbvt.insert(btDbvtVolume::FromCR(node.m_x, margin), &node);
  }
  body.m_fdbvt.clear();
  for (int f = 0; f < body.m_faces.size(); ++f) {
    btSoftBody::Face& face = body.m_faces[f];
    face.m_leaf = nullptr;
    if (!has_face_tree) continue;
    std::array<const btVector3*, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &face.m_n[k]->m_x;
    btDbvtVolume box = btDbvtVolume::FromPoints(corners.data(), 3);
    box.Expand(btVector3(margin, margin, margin));
    face.m_leaf = body.m_fdbvt.insert(box, &face);
  }
}

void rebuild_broadphase(StateArchive& archive, btSoftRigidDynamicsWorld& world) {
  struct Entry {
    btVector3 low;
    btVector3 high;
    int group;
    int mask;
  };
  btBroadphaseInterface& broadphase = *world.getBroadphase();
  btDispatcher* const dispatcher = world.getDispatcher();
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  std::vector<Entry> entries;
  archive.part("broadphase");
  for (int i = 0; i < objects.size(); ++i) {
    btBroadphaseProxy* const proxy = objects[i]->getBroadphaseHandle();
    Entry entry{proxy->m_aabbMin, proxy->m_aabbMax, proxy->m_collisionFilterGroup,
                proxy->m_collisionFilterMask};
    serialize(archive, entry.low);
    serialize(archive, entry.high);
    entries.push_back(entry);
  }
  for (int i = 0; i < objects.size(); ++i) {
    btBroadphaseProxy* const proxy = objects[i]->getBroadphaseHandle();
    broadphase.getOverlappingPairCache()->cleanProxyFromPairs(proxy, dispatcher);
    broadphase.destroyProxy(proxy, dispatcher);
    objects[i]->setBroadphaseHandle(nullptr);
  }
  broadphase.resetPool(dispatcher);
  for (int i = 0; i < objects.size(); ++i) {
    const Entry& entry = entries[static_cast<std::size_t>(i)];
    objects[i]->setBroadphaseHandle(broadphase.createProxy(
        entry.low, entry.high, objects[i]->getCollisionShape()->getShapeType(), objects[i],
        entry.group, entry.mask, dispatcher));
  }
  world.getConstraintSolver()->reset();
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
