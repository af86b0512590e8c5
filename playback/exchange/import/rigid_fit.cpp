#include <weft/playback/exchange/import/rigid_fit.hpp>

namespace weft::scenes {

RigidFit fit_rigid(const Matrix3X<double>& own, const Matrix3X<double>& found) {
  const Eigen::Matrix4d motion = Eigen::umeyama(own, found, false);
  const Matrix3<double> rotation = motion.topLeftCorner<3, 3>();
  RigidFit fit;
  fit.pose.position = motion.topRightCorner<3, 1>();
  fit.pose.orientation = Eigen::Quaterniond(rotation).normalized();
  const Matrix3X<double> places = (rotation * own).colwise() + fit.pose.position;
  fit.largest_residual = (places - found).colwise().norm().maxCoeff();
  return fit;
}

}  // namespace weft::scenes
