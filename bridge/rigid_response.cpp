#include <weft/bridge/rigid_response.hpp>

#include <algorithm>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Of the margin: contacts are visited until none moves its node farther [-].
constexpr btScalar kRest = btScalar(1e-5);

/// [kg/s] From a change of a node's motion relative to an object over a step [m] to the impulse that makes it [N s].
btMatrix3x3 impulse_matrix(const btSoftBody::Node& node, const btRigidBody* rigid,
                           const btVector3& lever, btScalar time_step) {
  const btScalar mobility = node.m_im + (rigid == nullptr ? btScalar(0) : rigid->getInvMass());
  btMatrix3x3 response(mobility, 0, 0, 0, mobility, 0, 0, 0, mobility);
  if (rigid != nullptr && rigid->getInvMass() > 0) {
    btMatrix3x3 cross;
    lever.getSkewSymmetricMatrix(&cross[0], &cross[1], &cross[2]);
    response -= cross * rigid->getInvInertiaTensorWorld() * cross;
  }
  return (response * btMatrix3x3(time_step, 0, 0, 0, time_step, 0, 0, 0, time_step)).inverse();
}

}  // namespace

void RigidResponse::collide(btSoftBody& body, const btCollisionObjectWrapper& object,
                            HullTable& hulls, btScalar time_step) {
  if ((body.m_cfg.collisions & btSoftBody::fCollision::SDF_RS) == 0) return;
  auto& collision_object = *const_cast<btCollisionObject*>(object.getCollisionObject());
  btRigidBody* const rigid = btRigidBody::upcast(&collision_object);
  if (!are_ways_known_) ways_.update(body);
  are_ways_known_ = true;
  found_.clear();
  add_rigid_contacts(body, ways_,
                     {&collision_object, object.getCollisionShape(), object.getWorldTransform(),
                      hulls.find(*object.getCollisionShape())},
                     time_step, found_);
  for (const RigidContact& found : found_) {
    btSoftBody::RContact contact;
    contact.m_cti.m_colObj = &collision_object;
    contact.m_cti.m_normal = found.normal;
    contact.m_cti.m_offset = -found.offset;
    // Where the object begins, as Bullet has it.
    if (!collision_object.isStaticOrKinematicObject()) {
      contact.m_cti.m_offset += btDot(found.normal, found.motion);
    }
    contact.m_node = &body.m_nodes[found.node];
    contact.m_c1 = contact.m_node->m_x - object.getWorldTransform().getOrigin();
    if (rigid != nullptr) contact.m_c1 = contact.m_node->m_x - rigid->getCenterOfMassPosition();
    contact.m_c0 = impulse_matrix(*contact.m_node, rigid, contact.m_c1, time_step);
    contact.m_c2 = contact.m_node->m_im * time_step;
    contact.m_c3 = 0;  // Bullet's shares of friction and depth: not used
    contact.m_c4 = 0;
    body.m_rcontacts.push_back(contact);
  }
}

// Projected Gauss and Seidel in displacements. m_c0 turns a change of the relative motion over the step into an impulse,
// m_c2 an impulse into the node's way.
btScalar RigidResponse::visit(const btSoftBody& body, const btSoftBody::RContact& contact,
                              Given& given) const {
  btCollisionObject& object = *const_cast<btCollisionObject*>(contact.m_cti.m_colObj);
  if (!object.hasContactResponse()) return 0;
  const btVector3& normal = contact.m_cti.m_normal;
  btRigidBody* const rigid = btRigidBody::upcast(&object);
  btSoftBody::Node& node = *contact.m_node;
  btVector3 surface(0, 0, 0);
  if (rigid != nullptr) {
    surface = body.m_sst.sdt * rigid->getVelocityInLocalPoint(contact.m_c1);
  }
  const btVector3 motion = node.m_x - node.m_q - surface;
  btScalar gap = btDot(node.m_x, normal) + contact.m_cti.m_offset;
  // The plane was found where a kinematic object ends, but where a dynamic one begins.
  if (!object.isStaticOrKinematicObject()) gap -= btDot(surface, normal);
  const btScalar push = std::max(given.push - gap, btScalar(0));
  const btScalar most = body.m_cfg.kDF * object.getFriction() * push;
  btVector3 hold = given.hold - (motion - btDot(motion, normal) * normal);
  const btScalar length = hold.length();
  if (length > most) hold *= most / length;
  const btVector3 change = (push - given.push) * normal + (hold - given.hold);
  given = {push, hold};
  const btVector3 impulse = contact.m_c0 * change;
  node.m_x += impulse * contact.m_c2;
  if (rigid != nullptr && !change.isZero()) {
    rigid->activate();
    rigid->applyImpulse(-impulse, contact.m_c1);
  }
  return change.length();
}

void RigidResponse::visit_all(btSoftBody& body) {
  const btScalar rest = kRest * body.getCollisionShape()->getMargin();
  for (int round = 0; round < body.m_cfg.piterations; ++round) {
    btScalar most = 0;
    for (std::size_t i = 0; i < given_.size(); ++i) {
      most = std::max(most, visit(body, body.m_rcontacts[static_cast<int>(i)], given_[i]));
    }
    if (most <= rest) break;
  }
}

void RigidResponse::solve(btSoftBody& body) {
  given_.assign(static_cast<std::size_t>(body.m_rcontacts.size()), Given{});
  visit_all(body);
  contacts_.copyFromArray(body.m_rcontacts);
  body.m_rcontacts.resizeNoInitialize(0);
  body.solveConstraints();
  body.m_rcontacts.copyFromArray(contacts_);
  if (body.m_scontacts.size() == 0) return;
  // A layer above may have pushed nodes in again.
  visit_all(body);
  for (int i = 0; i < body.m_rcontacts.size(); ++i) {
    btSoftBody::Node& node = *body.m_rcontacts[i].m_node;
    node.m_v = (node.m_x - node.m_q) * body.m_sst.isdt;
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
