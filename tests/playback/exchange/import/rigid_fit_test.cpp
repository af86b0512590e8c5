#include <weft/playback/exchange/import/rigid_fit.hpp>

#include <gtest/gtest.h>

#include <weft/mesh/icosphere.hpp>

namespace weft::scenes {
namespace {

Matrix3X<double> ellipsoid() {
  return Vector3<double>(1.2, 0.6, 1.0).asDiagonal() *
         make_icosphere(Icosphere{.radius = 0.2}).rest_positions;
}

TEST(RigidFit, FindsPlaceAndOrientation) {
  const Pose pose{
      {1.0, -2.0, 0.5},
      Eigen::Quaterniond(Eigen::AngleAxisd(2.5, Vector3<double>(1, 2, -1).normalized()))};
  const Matrix3X<double> own = ellipsoid();
  const RigidFit fit =
      fit_rigid(own, (pose.orientation.toRotationMatrix() * own).colwise() + pose.position);
  EXPECT_LT((fit.pose.position - pose.position).norm(), 1e-14);
  EXPECT_LT(fit.pose.orientation.angularDistance(pose.orientation), 1e-7);
  EXPECT_LT(fit.largest_residual, 1e-14);
}

TEST(RigidFit, LeavesAResidualWhereNoRigidMotionIs) {
  const Matrix3X<double> own = ellipsoid();
  EXPECT_GT(fit_rigid(own, 1.02 * own).largest_residual, 3e-3);
  const Matrix3X<double> mirrored = Vector3<double>(1, 1, -1).asDiagonal() * own;
  Matrix3X<double> skew = own;
  skew.row(0) += 0.1 * own.row(1);
  EXPECT_GT(fit_rigid(own, skew).largest_residual, 1e-3);
  // An ellipsoid's mirror image is the same surface, but its points are others.
  EXPECT_GT(fit_rigid(own, mirrored).largest_residual, 1e-2);
}

}  // namespace
}  // namespace weft::scenes
