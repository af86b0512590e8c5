#include <weft/bridge/energy_limit.hpp>

#include <algorithm>
#include <cmath>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

double energy_put_in(const StepMotion& motion, const btSoftBody& body) {
  double sum = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im <= 0) continue;
    const Vector3<btScalar> before = motion.start_velocities.col(i);
    const Vector3<btScalar> predicted(node.m_v.x(), node.m_v.y(), node.m_v.z());
    const Vector3<btScalar> way = motion.places.col(i) - motion.starts.col(i);
    sum += motion.masses[i] * static_cast<double>(before.squaredNorm() / 2 +
                                                  (predicted - before).dot(way) / motion.time_step);
  }
  return sum;
}

double kinetic_energy(const VectorX<double>& masses, const btSoftBody& body,
                      const Matrix3X<btScalar>& velocities) {
  double sum = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    if (body.m_nodes[i].m_im <= 0) continue;
    sum += 0.5 * masses[i] * static_cast<double>(velocities.col(i).squaredNorm());
  }
  return sum;
}

void limit_energy(const VectorX<double>& masses, const btSoftBody& body, double most,
                  bool keeps_momentum, Matrix3X<btScalar>& velocities) {
  Vector3<double> mean = Vector3<double>::Zero();
  double of_mean = 0;
  if (keeps_momentum) {
    mean = velocities.template cast<double>() * masses / masses.sum();
    of_mean = 0.5 * masses.sum() * mean.squaredNorm();
  }
  const double now = kinetic_energy(masses, body, velocities);
  const double share = now > of_mean ? std::max(0.0, most - of_mean) / (now - of_mean) : 0.0;
  const auto factor = static_cast<btScalar>(std::sqrt(std::min(1.0, share)));
  const Vector3<btScalar> kept = mean.cast<btScalar>();
  for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
    velocities.col(i) = kept + factor * (velocities.col(i) - kept);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
