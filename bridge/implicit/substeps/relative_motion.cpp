#include <weft/bridge/implicit/substeps/relative_motion.hpp>

#include <cstddef>

#include <Eigen/Eigenvalues>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Points whose moment of inertia about an axis is a smaller share than this of the whole lie on that axis, but for rounding [-].
constexpr double kLeastMoment = 1e-6;

/// Sums over the points where one body meets nodes, from which the best fit follows.
struct Sums {
  double count = 0;
  Vector3<double> points = Vector3<double>::Zero();         ///< [m]
  Vector3<double> velocities = Vector3<double>::Zero();     ///< [m/s]
  Vector3<double> momentum = Vector3<double>::Zero();       ///< point x velocity [m^2/s]
  Matrix3<double> second_moment = Matrix3<double>::Zero();  ///< point point^T [m^2]
};

RigidVelocity fit(const Sums& sums) {
  RigidVelocity result;
  if (sums.count == 0) return result;
  const Vector3<double> center = sums.points / sums.count;
  const Vector3<double> mean = sums.velocities / sums.count;
  const Matrix3<double> spread = sums.second_moment - sums.count * center * center.transpose();
  const Vector3<double> momentum = sums.momentum - sums.count * center.cross(mean);
  result.center = to_bullet(center);
  result.linear = to_bullet(mean);
  const Matrix3<double> inertia = spread.trace() * Matrix3<double>::Identity() - spread;
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> axes(inertia);
  Vector3<double> angular = Vector3<double>::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vector3<double> axis = axes.eigenvectors().col(k);
    if (axes.eigenvalues()[k] > kLeastMoment * inertia.trace()) {
      angular += axis * (axis.dot(momentum) / axes.eigenvalues()[k]);
    }
  }
  result.angular = to_bullet(angular);
  return result;
}

}  // namespace

RelativeMotion::RelativeMotion(std::span<const RigidContact> contacts,
                               const Matrix3X<btScalar>& velocities) {
  std::vector<Sums> sums;
  // Far from the origin squares of coordinates would lose what matters.
  const Vector3<double> origin =
      contacts.empty() ? Vector3<double>::Zero() : from_bullet<double>(contacts[0].met);
  for (const RigidContact& contact : contacts) {
    const auto collider = static_cast<std::size_t>(contact.collider);
    if (collider >= sums.size()) sums.resize(collider + 1);
    const MovableObject object{contact.object};
    if (!object) continue;
    const Vector3<double> point = from_bullet<double>(contact.met) - origin;
    const Vector3<double> velocity = from_bullet<double>(object.velocity().at(contact.met)) -
                                     velocities.col(contact.node).template cast<double>();
    Sums& of_body = sums[collider];
    of_body.count += 1;
    of_body.points += point;
    of_body.velocities += velocity;
    of_body.momentum += point.cross(velocity);
    of_body.second_moment += point * point.transpose();
  }
  for (const Sums& of_body : sums) {
    of_collider_.push_back(fit(of_body));
    of_collider_.back().center += to_bullet(origin);
  }
}

btVector3 RelativeMotion::at(const RigidContact& contact) const {
  return of_collider_.at(static_cast<std::size_t>(contact.collider)).at(contact.met);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
