#include <weft/bridge/rigid/rigid_motion.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Inertia of a loaded support over the body's mass: Bullet pushes the displacement that is left out again. With a thousand
/// a body and light cloth are too uneven for conjugate gradients in single precision.
constexpr btScalar kImmovable = 30;

/// Speed of a point of an object, out of another.
btScalar speed_out(const btCollisionObject& object, const btVector3& point, const btVector3& out) {
  return btDot(out, velocity_of(object).at(point));
}

}  // namespace

btScalar Support::displacement_out(const GeneralizedDisplacement& displacement) const {
  return out.dot(displacement.head<3>() + displacement.tail<3>().cross(lever_arm));
}

void add_supports(const MovableObject& body, btDispatcher* dispatcher, btScalar time_step,
                  btScalar reach, std::vector<Support>& supports) {
  const int num_manifolds = dispatcher != nullptr ? dispatcher->getNumManifolds() : 0;
  for (int m = 0; m < num_manifolds; ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    const bool is_first = manifold.getBody0() == body.object();
    if (!is_first && manifold.getBody1() != body.object()) continue;
    const btCollisionObject& other = is_first ? *manifold.getBody1() : *manifold.getBody0();
    if (!other.isStaticOrKinematicObject() || !dispatcher->needsResponse(body.object(), &other))
      continue;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& contact = manifold.getContactPoint(p);
      const btVector3 point =
          body.pose() * (is_first ? contact.m_localPointA : contact.m_localPointB);
      const btVector3 out = is_first ? contact.m_normalWorldOnB : -contact.m_normalWorldOnB;
      const btVector3 other_point =
          other.getWorldTransform() * (is_first ? contact.m_localPointB : contact.m_localPointA);
      const btScalar distance = btDot(out, point - other_point);
      const btScalar speed = speed_out(*body.object(), point, out) - speed_out(other, point, out);
      if (distance > reach || std::abs(time_step * speed) > reach) continue;
      supports.push_back(
          {body, from_bullet<btScalar>(point - body.center()), from_bullet<btScalar>(out)});
    }
  }
}

bool update_loads(const MovableObject& body, const GeneralizedDisplacement& displacement,
                  btScalar least, std::vector<Support>& supports) {
  bool has_changed = false;
  for (Support& support : supports) {
    if (!(support.body == body)) continue;
    const btScalar out = support.displacement_out(displacement);
    // Once loaded it lets go of what pulls, not of what rocks.
    const bool is_loaded = out < (support.is_loaded ? least / kImmovable : -least);
    has_changed = has_changed || is_loaded != support.is_loaded;
    support.is_loaded = is_loaded;
  }
  return has_changed;
}

Eigen::Matrix<btScalar, 6, 6> inertia_of_supports(const MovableObject& body,
                                                  const std::vector<Support>& supports) {
  Eigen::Matrix<btScalar, 6, 6> inertia = Eigen::Matrix<btScalar, 6, 6>::Zero();
  for (const Support& support : supports) {
    if (!(support.body == body) || !support.is_loaded) continue;
    GeneralizedDisplacement direction;
    direction << support.out, support.lever_arm.cross(support.out);
    inertia += kImmovable / body.inverse_mass() * direction * direction.transpose();
  }
  return inertia;
}

void move_at_once(const MovableObject& body, const RigidVelocity& last_velocity,
                  btScalar time_step) {
  if (!body.is_placeable()) return;
  const RigidVelocity velocity = body.velocity();
  btTransform pose = body.pose();
  pose.setOrigin(pose.getOrigin() + time_step * (velocity.linear - last_velocity.linear));
  const btVector3 turn = time_step * (velocity.angular - last_velocity.angular);
  const btScalar angle = turn.length();
  if (angle > 0) pose.setRotation(btQuaternion(turn / angle, angle) * pose.getRotation());
  body.set_pose(pose);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
