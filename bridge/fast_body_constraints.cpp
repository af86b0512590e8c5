// What touches or leads a fast body, as its solver sees it, and what that gets from it.
#include <algorithm>

#include <weft/bridge/bullet_vector.hpp>
#include <weft/bridge/fast_body.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// [m^2] Inertia over mass of a body that cannot be turned.
constexpr btScalar kNoTurn = 1e6;

/// In the world [kg m^2]. What cannot be turned about an axis has a very large one there.
Matrix3<btScalar> inertia_of(const btRigidBody& rigid) {
  Vector3<btScalar> about;
  Matrix3<btScalar> turn;
  for (int k = 0; k < 3; ++k) {
    const btScalar inverse = rigid.getInvInertiaDiagLocal()[k];
    about[k] = inverse > 0 ? 1 / inverse : kNoTurn / rigid.getInvMass();
    turn.row(k) = from_bullet<btScalar>(rigid.getWorldTransform().getBasis().getRow(k));
  }
  return turn * about.asDiagonal() * turn.transpose();
}

void push(btRigidBody& rigid, const btVector3& impulse, const btVector3& place) {
  rigid.activate();
  rigid.applyImpulse(impulse, place - rigid.getCenterOfMassPosition());
}

}  // namespace

void FastBody::list_pushed(const btSoftBody& body, std::vector<const btRigidBody*>& list) const {
  const std::size_t num_before = list.size();
  const auto add = [&](const btRigidBody* rigid) {
    const auto mine = list.begin() + static_cast<std::ptrdiff_t>(num_before);
    if (rigid != nullptr && std::find(mine, list.end(), rigid) == list.end()) list.push_back(rigid);
  };
  for (const RigidContact& contact : contacts_) add(movable(contact.object));
  for (int a = 0; a < body.m_anchors.size(); ++a) add(movable(body.m_anchors[a].m_body));
}

// A body that is pushed for the first time in this step gets the next number.
int FastBody::number_of(const btRigidBody& rigid, btScalar time_step) {
  for (std::size_t b = 0; b < pushed_.size(); ++b) {
    if (pushed_[b] == &rigid) return static_cast<int>(b);
  }
  pushed_.push_back(&rigid);
  fast::RigidInertia<btScalar> given;
  const auto [first, last] = std::equal_range(all_pushed_.begin(), all_pushed_.end(), &rigid);
  const auto share = 1 / static_cast<btScalar>(std::max<std::ptrdiff_t>(1, last - first));
  given.mass = share / rigid.getInvMass();
  given.inertia = share * inertia_of(rigid);
  given.motion = from_bullet<btScalar>(time_step * rigid.getLinearVelocity());
  given.turn = from_bullet<btScalar>(time_step * rigid.getAngularVelocity());
  inertias_.push_back(given);
  return static_cast<int>(pushed_.size()) - 1;
}

void FastBody::read_constraints(const btSoftBody& body, btScalar time_step) {
  pushed_.clear();
  inertias_.clear();
  const auto arm_of = [](const btRigidBody& rigid, const btVector3& place) {
    return from_bullet<btScalar>(place - rigid.getCenterOfMassPosition());
  };
  plane_contacts_.clear();
  for (const RigidContact& contact : contacts_) {
    fast::PlaneContact<btScalar> plane;
    plane.node = contact.node;
    plane.normal = from_bullet<btScalar>(contact.normal);
    plane.offset = contact.offset - plane.normal.dot(origin_);
    plane.motion = from_bullet<btScalar>(contact.motion);
    plane.friction = body.m_cfg.kDF * contact.object->getFriction();
    if (const btRigidBody* const rigid = movable(contact.object)) {
      plane.body = number_of(*rigid, time_step);
      plane.arm = arm_of(*rigid, body.m_nodes[contact.node].m_x);
    }
    plane_contacts_.push_back(plane);
  }
  led_.clear();
  for (int a = 0; a < body.m_anchors.size(); ++a) {
    const btSoftBody::Anchor& anchor = body.m_anchors[a];
    const auto node = static_cast<int>(anchor.m_node - &body.m_nodes[0]);
    if (!is_free_[static_cast<std::size_t>(node)]) continue;
    const btVector3 place = anchor.m_body->getWorldTransform() * anchor.m_local;
    fast::LedNode<btScalar> led;
    led.node = node;
    led.place = from_bullet<btScalar>(place) - origin_;
    if (const btRigidBody* const rigid = movable(anchor.m_body)) {
      led.body = number_of(*rigid, time_step);
      led.arm = arm_of(*rigid, place);
    }
    led_.push_back(led);
  }
}

// A body gets the momentum of the motion that the solution has given to it.
void FastBody::give_impulses(btSoftBody& body, btScalar time_step) {
  for (std::size_t b = 0; b < pushed_.size(); ++b) {
    const auto motion = solver_->body_motion(static_cast<int>(b));
    if (motion.isZero(0)) continue;
    auto& rigid = const_cast<btRigidBody&>(*pushed_[b]);
    const btScalar rate = time_step / (inertia_step_ * inertia_step_);
    rigid.activate();
    rigid.applyCentralImpulse(to_bullet(rate * inertias_[b].mass * motion.template head<3>()));
    rigid.applyTorqueImpulse(to_bullet(rate * (inertias_[b].inertia * motion.template tail<3>())));
  }
  for (int a = 0; a < body.m_anchors.size(); ++a) {  // that push with a part only
    const btSoftBody::Anchor& anchor = body.m_anchors[a];
    if (anchor.m_influence == 1 || movable(anchor.m_body) == nullptr) continue;
    const auto node = static_cast<int>(anchor.m_node - &body.m_nodes[0]);
    const btVector3 impulse = time_step * to_bullet(solver_->holding_force(node));
    push(*anchor.m_body, (1 - anchor.m_influence) * impulse, in_world(node));
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
