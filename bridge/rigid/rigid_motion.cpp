#include <weft/bridge/rigid/rigid_motion.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Inertia of a loaded support over the body's mass: what is left of its way is pushed out again by Bullet. With a thousand
/// a body and light cloth are too uneven for conjugate gradients in single precision.
constexpr btScalar kImmovable = 30;

/// Speed of a place of an object, out of another.
btScalar speed_out(const btCollisionObject& object, const btVector3& place, const btVector3& out) {
  const btRigidBody* const rigid = btRigidBody::upcast(&object);
  if (rigid == nullptr) return 0;
  return btDot(out, rigid->getVelocityInLocalPoint(place - rigid->getCenterOfMassPosition()));
}

}  // namespace

btScalar Support::way_out(const RigidWay& way) const {
  return out.dot(way.head<3>() + way.tail<3>().cross(lever_arm));
}

void add_supports(const btRigidBody& body, btDispatcher* dispatcher, btScalar time_step,
                  btScalar reach, std::vector<Support>& supports) {
  const int num_manifolds = dispatcher != nullptr ? dispatcher->getNumManifolds() : 0;
  for (int m = 0; m < num_manifolds; ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    const bool is_first = manifold.getBody0() == &body;
    if (!is_first && manifold.getBody1() != &body) continue;
    const btCollisionObject& other = is_first ? *manifold.getBody1() : *manifold.getBody0();
    if (!other.isStaticOrKinematicObject() || !dispatcher->needsResponse(&body, &other)) continue;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      const btVector3 place =
          body.getCenterOfMassTransform() * (is_first ? point.m_localPointA : point.m_localPointB);
      const btVector3 out = is_first ? point.m_normalWorldOnB : -point.m_normalWorldOnB;
      const btScalar speed = speed_out(body, place, out) - speed_out(other, place, out);
      if (point.getDistance() > reach || std::abs(time_step * speed) > reach) continue;
      supports.push_back({&body, from_bullet<btScalar>(place - body.getCenterOfMassPosition()),
                          from_bullet<btScalar>(out)});
    }
  }
}

bool update_loads(const btRigidBody& body, const RigidWay& way, btScalar least,
                  std::vector<Support>& supports) {
  bool has_changed = false;
  for (Support& support : supports) {
    if (support.body != &body) continue;
    const btScalar out = support.way_out(way);
    // Once loaded it lets go of what pulls, not of what rocks.
    const bool is_loaded = out < (support.is_loaded ? least / kImmovable : -least);
    has_changed = has_changed || is_loaded != support.is_loaded;
    support.is_loaded = is_loaded;
  }
  return has_changed;
}

Eigen::Matrix<btScalar, 6, 6> inertia_of_supports(const btRigidBody& body,
                                                  const std::vector<Support>& supports) {
  Eigen::Matrix<btScalar, 6, 6> inertia = Eigen::Matrix<btScalar, 6, 6>::Zero();
  for (const Support& support : supports) {
    if (support.body != &body || !support.is_loaded) continue;
    RigidWay way;
    way << support.out, support.lever_arm.cross(support.out);
    inertia += kImmovable / body.getInvMass() * way * way.transpose();
  }
  return inertia;
}

void move_at_once(btRigidBody& body, const btVector3& last_velocity,
                  const btVector3& last_angular_velocity, btScalar time_step) {
  if (body.getActivationState() == DISABLE_SIMULATION || body.getNumConstraintRefs() > 0) return;
  btTransform place = body.getCenterOfMassTransform();
  place.setOrigin(place.getOrigin() + time_step * (body.getLinearVelocity() - last_velocity));
  const btVector3 turn = time_step * (body.getAngularVelocity() - last_angular_velocity);
  const btScalar angle = turn.length();
  if (angle > 0) place.setRotation(btQuaternion(turn / angle, angle) * place.getRotation());
  body.setCenterOfMassTransform(place);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
