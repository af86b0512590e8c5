#include <weft/bridge/implicit/substeps/pin_pull.hpp>

#include <algorithm>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

PinPull::PinPull(std::span<const int> pins, const Matrix3X<btScalar>& ends,
                 const Matrix3X<btScalar>& starts) {
  if (ends.cols() != starts.cols()) return;
  for (const int pin : pins) {
    const Vector3<btScalar> motion = starts.col(pin) - ends.col(pin);
    if (motion.squaredNorm() > motion_.squaredNorm()) motion_ = motion;
  }
}

btScalar PinPull::on(const RigidContact& contact, const Vector3<btScalar>& way,
                     std::span<const RigidContact> contacts) const {
  if (motion_.isZero(0)) return 0;
  const bool is_between =
      std::any_of(contacts.begin(), contacts.end(), [&](const RigidContact& other) {
        return other.node == contact.node && other.object != contact.object;
      });
  return is_between ? (motion_ - way).norm() : btScalar(0);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
