#include <weft/bridge/implicit/substeps/mean_velocities.hpp>

#include <cstddef>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

MeanVelocities::MeanVelocities(std::span<const RigidContact> contacts,
                               const Matrix3X<btScalar>& velocities) {
  for (const RigidContact& contact : contacts) {
    const auto collider = static_cast<std::size_t>(contact.collider);
    if (collider >= of_collider_.size()) of_collider_.resize(collider + 1);
    of_collider_[collider].velocities += velocities.col(contact.node);
    ++of_collider_[collider].count;
  }
}

btVector3 MeanVelocities::at(const RigidContact& contact) const {
  const Sum& sum = of_collider_.at(static_cast<std::size_t>(contact.collider));
  return to_bullet((sum.velocities / static_cast<btScalar>(sum.count)).eval());
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
