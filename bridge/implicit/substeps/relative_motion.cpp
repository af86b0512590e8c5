#include <weft/bridge/implicit/substeps/relative_motion.hpp>

#include <cstddef>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/rigid/movable_object.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

RelativeMotion::RelativeMotion(std::span<const RigidContact> contacts,
                               const Matrix3X<btScalar>& velocities) {
  for (const RigidContact& contact : contacts) {
    const auto collider = static_cast<std::size_t>(contact.collider);
    if (collider >= of_collider_.size()) of_collider_.resize(collider + 1);
    const MovableObject object{contact.object};
    if (!object) continue;
    of_collider_[collider].velocities +=
        object.velocity().at(contact.met) - to_bullet(velocities.col(contact.node).eval());
    ++of_collider_[collider].count;
  }
}

btVector3 RelativeMotion::of(const RigidContact& contact) const {
  const Sum& sum = of_collider_.at(static_cast<std::size_t>(contact.collider));
  return sum.count > 0 ? sum.velocities / static_cast<btScalar>(sum.count) : btVector3(0, 0, 0);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
