#include <weft/bridge/implicit/substeps/pin_pull.hpp>

#include <algorithm>
#include <cstddef>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

PinPull::PinPull(std::span<const int> pins, const Matrix3X<btScalar>& ends,
                 const Matrix3X<btScalar>& starts, std::span<const RigidContact> contacts) {
  if (ends.cols() != starts.cols()) return;
  for (const int pin : pins) {
    const Vector3<btScalar> motion = starts.col(pin) - ends.col(pin);
    if (motion.squaredNorm() > motion_.squaredNorm()) motion_ = motion;
  }
  if (motion_.isZero(0)) return;
  const auto num_nodes = static_cast<std::size_t>(starts.cols());
  is_between_.assign(num_nodes, 0);
  std::vector<const btCollisionObject*> first(num_nodes, nullptr);
  for (const RigidContact& contact : contacts) {
    const auto node = static_cast<std::size_t>(contact.node);
    if (first[node] == nullptr) first[node] = contact.object;
    if (first[node] != contact.object) is_between_[node] = 1;
  }
}

btScalar PinPull::on(int node, const Vector3<btScalar>& way) const {
  if (is_between_.empty() || is_between_[static_cast<std::size_t>(node)] == 0) return 0;
  return std::min((motion_ - way).norm(), 2 * motion_.norm());
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
