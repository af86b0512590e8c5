#include <weft/bridge/rigid/multibody_inertia.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/symmetric_matrix.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

constexpr int kBaseDofs = 6;
/// Effective mass over a link's mass in a direction in which joints do not let it move [-].
constexpr double kNoBaseTranslation = 1e4;
/// [m] Rotations count like translations at the end of this lever arm.
constexpr double kLeverArm = 0.1;
/// The least mass of a link over all that moves in its multibody [-].
constexpr double kLeastMassShare = 0.01;
/// Inertia of a coordinate that moves no mass, over the largest one [-].
constexpr double kLeastInertia = 1e-9;

std::size_t entry_of(int link) {
  return static_cast<std::size_t>(link) + 1;
}

Matrix3<double> rotation_of(const btQuaternion& q) {
  return Eigen::Quaterniond(static_cast<double>(q.w()), static_cast<double>(q.x()),
                            static_cast<double>(q.y()), static_cast<double>(q.z()))
      .toRotationMatrix();
}

Matrix3<double> cross_matrix(const Vector3<double>& v) {
  Matrix3<double> cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

}  // namespace

bool is_base_free(const btMultiBody& multibody) {
  return !multibody.hasFixedBase() && !multibody.isBaseStaticOrKinematic();
}

bool is_link_movable(const btMultiBody& multibody, int link) {
  for (int k = link; k >= 0; k = multibody.getParent(k)) {
    if (multibody.getLink(k).m_dofCount > 0 && !multibody.isLinkStaticOrKinematic(k)) return true;
  }
  return is_base_free(multibody);
}

double reference_mass(const btMultiBody& multibody, int link) {
  double total = is_base_free(multibody) ? static_cast<double>(multibody.getBaseMass()) : 0;
  for (int k = 0; k < multibody.getNumLinks(); ++k) {
    total += static_cast<double>(multibody.getLinkMass(k));
  }
  const double own =
      static_cast<double>(link < 0 ? multibody.getBaseMass() : multibody.getLinkMass(link));
  return std::max(own, kLeastMassShare * total);
}

// Velocities are summed from the base outwards, as positions are.
RigidVelocity link_velocity(const btMultiBody& multibody, int link) {
  std::vector<int> chain;
  for (int k = link; k >= 0; k = multibody.getParent(k)) chain.push_back(k);
  RigidVelocity velocity{multibody.getBaseVel(), multibody.getBaseOmega(), {}};
  btQuaternion world_to_local = multibody.getWorldToBaseRot();
  std::for_each(chain.rbegin(), chain.rend(), [&](int k) {
    world_to_local = multibody.getParentToLocalRot(k) * world_to_local;
    const btQuaternion local_to_world = world_to_local.inverse();
    const btVector3 arm = quatRotate(local_to_world, multibody.getRVector(k));
    velocity.linear += velocity.angular.cross(arm);
    const btMultibodyLink& joint = multibody.getLink(k);
    const btScalar* const rates = multibody.getVelocityVector() + kBaseDofs + joint.m_dofOffset;
    for (int d = 0; d < joint.m_dofCount; ++d) {
      velocity.angular += rates[d] * quatRotate(local_to_world, joint.getAxisTop(d));
      velocity.linear += rates[d] * quatRotate(local_to_world, joint.getAxisBottom(d));
    }
  });
  return velocity;
}

MultiBodyInertia::MultiBodyInertia(const btMultiBody& multibody) : multibody_(&multibody) {
  const int num_links = multibody.getNumLinks();
  frames_.resize(entry_of(num_links));
  frames_[0] = {rotation_of(multibody.getWorldToBaseRot()).transpose(),
                from_bullet(multibody.getBasePos())};
  for (int k = 0; k < num_links; ++k) {
    const Frame& parent = frames_[entry_of(multibody.getParent(k))];
    Frame& frame = frames_[entry_of(k)];
    frame.rotation = parent.rotation * rotation_of(multibody.getParentToLocalRot(k)).transpose();
    frame.center = parent.center + frame.rotation * from_bullet(multibody.getRVector(k));
  }
  const int size = kBaseDofs + multibody.getNumDofs();
  inertia_.setZero(size, size);
  for (int link = -1; link < num_links; ++link) add_link(link);

  std::vector<int> free;
  if (is_base_free(multibody)) {
    for (int k = 0; k < kBaseDofs; ++k) free.push_back(k);
  }
  for (int k = 0; k < num_links; ++k) {
    if (multibody.isLinkStaticOrKinematic(k)) continue;
    const btMultibodyLink& joint = multibody.getLink(k);
    for (int d = 0; d < joint.m_dofCount; ++d) free.push_back(kBaseDofs + joint.m_dofOffset + d);
  }
  inverse_.setZero(size, size);
  if (free.empty()) return;
  Eigen::MatrixXd of_free = inertia_(free, free);
  of_free.diagonal().array() += kLeastInertia * of_free.diagonal().maxCoeff();
  const Eigen::MatrixXd inverse =
      solve_symmetric(of_free, Eigen::MatrixXd::Identity(of_free.rows(), of_free.cols()));
  inverse_(free, free) = inverse;
}

void MultiBodyInertia::add_link(int link) {
  const double mass =
      static_cast<double>(link < 0 ? multibody_->getBaseMass() : multibody_->getLinkMass(link));
  const Vector3<double> principal =
      from_bullet(link < 0 ? multibody_->getBaseInertia() : multibody_->getLinkInertia(link));
  const Matrix3<double>& rotation = frames_[entry_of(link)].rotation;
  const Eigen::MatrixXd jacobian = jacobian_of(link);
  inertia_ += mass * jacobian.topRows<3>().transpose() * jacobian.topRows<3>();
  inertia_ += jacobian.bottomRows<3>().transpose() *
              (rotation * principal.asDiagonal() * rotation.transpose()) * jacobian.bottomRows<3>();
}

Eigen::MatrixXd MultiBodyInertia::jacobian_of(int link) const {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(6, kBaseDofs + multibody_->getNumDofs());
  const Vector3<double>& center = frames_[entry_of(link)].center;
  jacobian.block<3, 3>(0, 0) = -cross_matrix(center - frames_[0].center);
  jacobian.block<3, 3>(3, 0).setIdentity();
  jacobian.block<3, 3>(0, 3).setIdentity();
  for (int k = link; k >= 0; k = multibody_->getParent(k)) {
    const btMultibodyLink& joint = multibody_->getLink(k);
    const Frame& frame = frames_[entry_of(k)];
    for (int d = 0; d < joint.m_dofCount; ++d) {
      const Vector3<double> axis = frame.rotation * from_bullet(joint.getAxisTop(d));
      const Vector3<double> along = frame.rotation * from_bullet(joint.getAxisBottom(d));
      const int column = kBaseDofs + joint.m_dofOffset + d;
      jacobian.col(column).head<3>() = along + axis.cross(center - frame.center);
      jacobian.col(column).tail<3>() = axis;
    }
  }
  return jacobian;
}

VectorX<double> MultiBodyInertia::response_to(const VectorX<double>& impulse) const {
  return inverse_ * impulse;
}

VectorX<double> MultiBodyInertia::velocities() const {
  return Eigen::Map<const VectorX<btScalar>>(multibody_->getVelocityVector(), inertia_.rows())
      .cast<double>();
}

double MultiBodyInertia::kinetic_energy() const {
  const VectorX<double> now = velocities();
  return 0.5 * now.dot(inertia_ * now);
}

double MultiBodyInertia::energy_gain(const VectorX<double>& impulse) const {
  return impulse.dot(velocities()) + 0.5 * impulse.dot(inverse_ * impulse);
}

// The units make a link's own inertia about one, so that one threshold serves translations and rotations.
Eigen::MatrixXd MultiBodyInertia::inertia_of(std::span<const int> links) const {
  const auto size = 6 * static_cast<Eigen::Index>(links.size());
  Eigen::MatrixXd jacobians(size, inertia_.cols());
  VectorX<double> units(size);
  for (std::size_t k = 0; k < links.size(); ++k) {
    const auto row = 6 * static_cast<Eigen::Index>(k);
    jacobians.middleRows<6>(row) = jacobian_of(links[k]);
    const double unit = std::sqrt(reference_mass(*multibody_, links[k]));
    units.segment<3>(row).setConstant(unit);
    units.segment<3>(row + 3).setConstant(unit * kLeverArm);
  }
  const Eigen::MatrixXd mobility =
      units.asDiagonal() * (jacobians * inverse_ * jacobians.transpose()) * units.asDiagonal();
  const SymmetricModes modes = symmetric_modes(mobility);
  const VectorX<double> inertia = modes.values.cwiseMax(1 / kNoBaseTranslation).cwiseInverse();
  return units.asDiagonal() * (modes.vectors * inertia.asDiagonal() * modes.vectors.transpose()) *
         units.asDiagonal();
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
