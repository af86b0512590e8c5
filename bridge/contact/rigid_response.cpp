#include <weft/bridge/contact/rigid_response.hpp>

#include <algorithm>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Contacts are visited until none moves its node farther, as a share of the margin [-].
constexpr btScalar kRest = btScalar(1e-5);
/// The share of a pinned node's depth in an object that impulses move that a step takes away [-], as Bullet's own contacts of
/// rigid bodies do. All of it would come back as speed.
constexpr btScalar kDepthShare = btScalar(0.2);

/// [kg/s] From a change of a node's motion relative to an object over a step [m] to the impulse that makes it [N s].
btMatrix3x3 impulse_matrix(btScalar inverse_mass, const btRigidBody* dynamic,
                           const btVector3& lever, btScalar time_step) {
  const btScalar mobility =
      inverse_mass + (dynamic == nullptr ? btScalar(0) : dynamic->getInvMass());
  btMatrix3x3 response(mobility, 0, 0, 0, mobility, 0, 0, 0, mobility);
  if (dynamic != nullptr) {
    btMatrix3x3 cross;
    lever.getSkewSymmetricMatrix(&cross[0], &cross[1], &cross[2]);
    response -= cross * dynamic->getInvInertiaTensorWorld() * cross;
  }
  return (response * btMatrix3x3(time_step, 0, 0, 0, time_step, 0, 0, 0, time_step)).inverse();
}

}  // namespace

bool RigidResponse::fits(const btSoftBody& body) {
  const btSoftBody::Config& config = body.m_cfg;
  return body.m_links.size() == 0 && config.viterations == 0 && config.diterations == 0 &&
         (config.collisions & btSoftBody::fCollision::RVSmask) == btSoftBody::fCollision::SDF_RS;
}

bool RigidResponse::knows(const btCollisionObject& object) {
  return object.getInternalType() != btCollisionObject::CO_FEATHERSTONE_LINK;
}

void RigidResponse::begin_step() {
  swept_.invalidate();
  contacts_.clear();
}

void RigidResponse::collide(btSoftBody& body, const btCollisionObjectWrapper& object,
                            HullTable& hulls, btScalar time_step) {
  auto& collision_object = *const_cast<btCollisionObject*>(object.getCollisionObject());
  btRigidBody* const moving = btRigidBody::upcast(&collision_object);
  btRigidBody* const dynamic = MovableObject(&collision_object).rigid();
  swept_.update(body);
  found_.clear();
  // At once what a cloth that lies with all its nodes needs, and nothing later on.
  found_.reserve(static_cast<std::size_t>(body.m_nodes.size()));
  contacts_.reserve(static_cast<std::size_t>(body.m_nodes.size()));
  const HullFacets* const facets = hulls.find(*object.getCollisionShape());
  add_rigid_contacts(body, swept_, make_collider(object, facets, 0, time_step), time_step,
                     PinnedNodes::kWithDynamicObjects, found_);
  for (const RigidContact& found : found_) {
    Contact contact;
    contact.with = found;
    contact.node = &body.m_nodes[found.node];
    contact.friction = body.m_cfg.kDF * collision_object.getFriction();
    contact.moving = moving;
    contact.dynamic = dynamic;
    contact.lever.setZero();
    if (moving != nullptr) contact.lever = contact.node->m_x - moving->getCenterOfMassPosition();
    contact.impulses = impulse_matrix(contact.node->m_im, dynamic, contact.lever, time_step);
    contact.impulse.setZero();
    contacts_.push_back(contact);
  }
}

// Depenetration does not change velocities: start and end are shifted alike, by what both have in common,
// because where the surface bends the plane at the end is none at the start. Not for objects that move: where
// the surface of one was is known to first order in its turn only, and every step would lift nodes by that.
void RigidResponse::project_out_of_planes(const btSoftBody& body) {
  for (const Contact& contact : contacts_) {
    btSoftBody::Node& node = *contact.node;
    if (node.m_im <= 0 || !contact.with.motion.isZero()) continue;
    const btVector3& normal = contact.with.normal;
    const btScalar gap =
        std::max(btDot(normal, node.m_q), btDot(normal, node.m_x)) - contact.with.offset;
    if (gap >= -kRest * body.getCollisionShape()->getMargin()) continue;
    node.m_q -= gap * normal;
    node.m_x -= gap * normal;
  }
}

// Projected Gauss and Seidel.
btScalar RigidResponse::visit(const btSoftBody& body, Contact& contact) {
  btSoftBody::Node& node = *contact.node;
  btVector3 surface(0, 0, 0);
  if (contact.moving != nullptr) {
    surface = body.m_sst.sdt * contact.moving->getVelocityInLocalPoint(contact.lever);
  }
  const btVector3& normal = contact.with.normal;
  const btVector3 motion = node.m_x - node.m_q - surface;
  const btScalar gap =
      btDot(normal, node.m_x - (surface - contact.with.motion)) - contact.with.offset;
  // What would hold the node where it touches; then the nearest impulse of Coulomb's cone sideways.
  const btVector3 wanted = -gap * normal - (motion - btDot(motion, normal) * normal);
  btVector3 impulse = contact.impulse + contact.impulses * wanted;
  const btScalar push = std::max(btDot(impulse, normal), btScalar(0));
  btVector3 hold = impulse - btDot(impulse, normal) * normal;
  const btScalar most = contact.friction * push;
  const btScalar length = hold.length();
  contact.is_sticking = length <= most;
  if (length > most) hold *= most / length;
  impulse = push * normal + hold;
  const btVector3 change = impulse - contact.impulse;
  contact.impulse = impulse;
  const btVector3 moved = change * (node.m_im * body.m_sst.sdt);
  node.m_x += moved;
  if (contact.dynamic == nullptr || change.isZero()) return moved.length();
  contact.dynamic->activate();
  contact.dynamic->applyImpulse(-change, contact.lever);
  return moved.length() + contact.dynamic->getInvMass() * body.m_sst.sdt * change.length();
}

void RigidResponse::visit_all(const btSoftBody& body) {
  const btScalar rest = kRest * body.getCollisionShape()->getMargin();
  for (int round = 0; round < body.m_cfg.piterations; ++round) {
    btScalar most = 0;
    for (Contact& contact : contacts_) most = std::max(most, visit(body, contact));
    if (most <= rest) break;
  }
}

void RigidResponse::solve(btSoftBody& body) {
  std::erase_if(contacts_, [&](const Contact& contact) {
    return !(contact.node->m_im > 0) && contact.dynamic == nullptr;
  });
  for (Contact& contact : contacts_) {
    if (contact.dynamic != nullptr) {
      follow_object(contact.with, contact.dynamic->getWorldTransform());
    }
    if (contact.node->m_im > 0) continue;
    const btVector3 start = contact.node->m_q + contact.with.motion;
    const btScalar gap = btDot(contact.with.normal, start) - contact.with.offset;
    if (gap < 0) contact.with.offset += (1 - kDepthShare) * gap;
  }
  project_out_of_planes(body);
  visit_all(body);
  body.solveConstraints();
  if (contacts_.empty()) return;
  if (body.m_scontacts.size() > 0) {  // a layer above may have pushed nodes in again
    visit_all(body);
    for (const Contact& contact : contacts_) {
      btSoftBody::Node& node = *contact.node;
      node.m_v = (1 - body.m_cfg.kDP) * body.m_sst.isdt * (node.m_x - node.m_q);
    }
  }
  // A dynamic object stands where it came to before it was pushed: depenetration changes a node's position, not its velocity.
  for (const Contact& contact : contacts_) {
    const btScalar gap = btDot(contact.with.normal, contact.node->m_x) - contact.with.offset;
    if (gap < 0 && contact.node->m_im > 0) contact.node->m_x -= gap * contact.with.normal;
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
