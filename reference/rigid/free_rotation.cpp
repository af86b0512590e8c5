#include <weft/reference/rigid/free_rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace weft::reference {
namespace {

/// Yoshida (1990), order 6, solution A: parts of a step, of which the sum is 1.
constexpr std::array<double, 4> kYoshida6 = {
    0.784513610477557263819497633866349876, 0.235573213359358133684793182978534602,
    -1.17767998417887100694641568096431573, 1.31518632068391121888424972823886251};

Eigen::Quaterniond turn(const Vector3<double>& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0.0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

/// The energy without its first part: inverse moments of two axes over that of the one between.
struct Tumbling {
  Tumbling(const Vector3<double>& inverse_inertia, const Vector3<double>& momentum) {
    std::array<int, 3> axes = {0, 1, 2};
    std::sort(axes.begin(), axes.end(),
              [&](int a, int b) { return inverse_inertia[a] < inverse_inertia[b]; });
    heavy = axes[0];
    light = axes[2];
    middle = inverse_inertia[axes[1]];
    heavy_gain = inverse_inertia[heavy] - middle;
    light_gain = inverse_inertia[light] - middle;
    // The largest components that momentum and energy allow.
    const double range = light_gain - heavy_gain;
    if (heavy_gain == 0.0 || light_gain == 0.0) return;
    const double between = momentum[axes[1]];
    rate = light_gain * std::hypot(momentum[light], between * std::sqrt(-heavy_gain / range)) -
           heavy_gain * std::hypot(momentum[heavy], between * std::sqrt(light_gain / range));
  }

  int heavy, light;               // axes of the largest and the smallest moment
  double middle;                  // [1/(kg m^2)]
  double heavy_gain, light_gain;  // [1/(kg m^2)], <= 0 and >= 0
  double rate = 0.0;              // [rad/s]; 0: one of the gains is, so that the parts commute
};

/// Turns a body in its own axes as one part of the energy does alone.
void turn_about(int axis, double gain, double time, Eigen::Quaterniond& turned,
                Vector3<double>& momentum) {
  const double angle = time * gain * momentum[axis];
  const Eigen::Quaterniond part(Eigen::AngleAxisd(angle, Vector3<double>::Unit(axis)));
  turned = turned * part;
  momentum = part.conjugate() * momentum;
}

}  // namespace

Eigen::Quaterniond FreeRotation::advance(const Eigen::Quaterniond& orientation, double time) const {
  Vector3<double> momentum = orientation.conjugate() * angular_momentum_;
  const Tumbling parts(inverse_inertia_, momentum);
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  if (parts.rate > 0.0) {
    const double angle = std::min(parts.rate * std::abs(time), kMaxTumbling);
    const int substeps = std::max(1, static_cast<int>(std::ceil(angle / kTumblingSubstep)));
    for (int n = 0; n < substeps; ++n) {
      for (const int stage : {0, 1, 2, 3, 2, 1, 0}) {
        const double h = kYoshida6[static_cast<std::size_t>(stage)] * time / substeps;
        turn_about(parts.light, parts.light_gain, 0.5 * h, turned, momentum);
        turn_about(parts.heavy, parts.heavy_gain, h, turned, momentum);
        turn_about(parts.light, parts.light_gain, 0.5 * h, turned, momentum);
      }
      turned.normalize();
    }
  } else {
    turn_about(parts.light, parts.light_gain, time, turned, momentum);
    turn_about(parts.heavy, parts.heavy_gain, time, turned, momentum);
  }
  return (turn(time * parts.middle * angular_momentum_) * orientation * turned).normalized();
}

double FreeRotation::tumbling(const Eigen::Quaterniond& orientation, double time) const {
  const Vector3<double> momentum = orientation.conjugate() * angular_momentum_;
  return std::abs(time) * Tumbling(inverse_inertia_, momentum).rate;
}

Vector3<double> FreeRotation::angular_velocity(const Eigen::Quaterniond& orientation) const {
  const Vector3<double> momentum = orientation.conjugate() * angular_momentum_;
  return orientation * inverse_inertia_.cwiseProduct(momentum);
}

Matrix3<double> FreeRotation::inverse_inertia(const Eigen::Quaterniond& orientation) const {
  const Matrix3<double> rotation = orientation.toRotationMatrix();
  return rotation * inverse_inertia_.asDiagonal() * rotation.transpose();
}

}  // namespace weft::reference
