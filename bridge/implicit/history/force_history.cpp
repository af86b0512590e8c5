#include <weft/bridge/implicit/history/force_history.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void ForceHistory::begin_step(btScalar time_step) {
  if (step_ == time_step && has_filtered_) return;
  filtered_ = last_;
  filtered_before_ = last_;
  has_filtered_ = true;
}

Vector3<btScalar> ForceHistory::known(Eigen::Index node) const {
  return -kBeta * kAlpha * last_.col(node) +
         (btScalar(0.5) + kGamma - 2 * kBeta) * filtered_.col(node) +
         (btScalar(0.5) - kGamma + kBeta) * filtered_before_.col(node);
}

void ForceHistory::resize(Eigen::Index num_nodes, btScalar time_step) {
  const bool goes_on = step_ == time_step && last_.cols() == num_nodes;
  if (!goes_on) has_filtered_ = false;
  step_ = time_step;
  if (last_.cols() == num_nodes) return;
  for (Matrix3X<btScalar>* forces : {&last_, &filtered_, &filtered_before_, &coming_}) {
    forces->setZero(3, num_nodes);
  }
}

void ForceHistory::add(Eigen::Index first, Eigen::Index count) {
  const auto forces = coming(first, count);
  if (has_filtered_) {
    filtered_before_.middleCols(first, count) = filtered_.middleCols(first, count);
    filtered_.middleCols(first, count) =
        (1 + kAlpha) * forces - kAlpha * last_.middleCols(first, count);
  }
  last_.middleCols(first, count) = forces;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
