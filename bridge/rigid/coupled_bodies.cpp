#include <weft/bridge/rigid/coupled_bodies.hpp>

#include <algorithm>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// [m^2] Inertia over mass of a body that cannot rotate, far above that of any that can.
constexpr btScalar kNoRotation = 100;
/// Effective mass over mass in a direction in which a body cannot move [-].
constexpr btScalar kNoTranslation = 1e4;

/// With what Bullet makes of impulses: in the world, factors included [kg].
Vector3<btScalar> mass_of(const btRigidBody& rigid) {
  const btScalar mass = 1 / rigid.getInvMass();
  const Vector3<btScalar> factor = from_bullet<btScalar>(rigid.getLinearFactor());
  return mass * factor.cwiseMax(1 / kNoTranslation).cwiseInverse();
}

/// Likewise [kg m^2].
Matrix3<btScalar> inertia_of(const btRigidBody& rigid) {
  Matrix3<btScalar> inverse;
  for (int k = 0; k < 3; ++k) {
    inverse.row(k) = from_bullet<btScalar>(rigid.getInvInertiaTensorWorld().getRow(k)).transpose();
  }
  const Vector3<btScalar> factor = from_bullet<btScalar>(rigid.getAngularFactor());
  inverse = (factor.asDiagonal() * inverse * factor.asDiagonal()).eval();
  inverse.diagonal().array() += rigid.getInvMass() / kNoRotation;
  return inverse.inverse();
}

/// [J]
double kinetic_energy_of(const btRigidBody& rigid) {
  const btVector3 turning =
      rigid.getCenterOfMassTransform().getBasis().transpose() * rigid.getAngularVelocity();
  const btVector3 inertia = rigid.getLocalInertia();
  return 0.5 * (static_cast<double>(rigid.getLinearVelocity().length2() / rigid.getInvMass()) +
                static_cast<double>(btDot(inertia * turning, turning)));
}

/// [m] How near to a rigid object a body touches it.
constexpr btScalar kTouch = btScalar(1e-3);
/// [m/s^2] From which acceleration on it is pushed into it.
constexpr btScalar kLeastPush = btScalar(0.05);

}  // namespace

void CoupledBodies::begin_step() {
  last_held_.clear();
  for (const Support& support : supports_) {
    if (support.is_loaded) last_held_.push_back(support.body);
  }
  supports_.clear();
  supported_.clear();
}

void CoupledBodies::clear() {
  bodies_.clear();
  inertias_.clear();
}

int CoupledBodies::number_of(const btRigidBody& rigid, btDispatcher* dispatcher, btScalar time_step,
                             bool is_again) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b] == &rigid) return static_cast<int>(b);
  }
  bodies_.push_back(&rigid);
  fast::RigidInertia<btScalar> given;
  const auto [first, last] = std::equal_range(of_all_.begin(), of_all_.end(), &rigid);
  const auto share = 1 / static_cast<btScalar>(std::max<std::ptrdiff_t>(1, last - first));
  given.mass = share * mass_of(rigid);
  given.inertia = share * inertia_of(rigid);
  given.motion = from_bullet<btScalar>(time_step * rigid.getLinearVelocity());
  given.turn = from_bullet<btScalar>(time_step * rigid.getAngularVelocity());
  if (is_again) given.guess = displacement_of(rigid);
  given.held = share * inertia_of_supports(rigid, supports_of(rigid, dispatcher, time_step));
  inertias_.push_back(given);
  return static_cast<int>(bodies_.size()) - 1;
}

// Those of a body that was held in the last step are likely to hold it again: the others have to be found out.
const std::vector<Support>& CoupledBodies::supports_of(const btRigidBody& rigid,
                                                       btDispatcher* dispatcher,
                                                       btScalar time_step) {
  const bool is_known = std::find(supported_.begin(), supported_.end(), &rigid) != supported_.end();
  if (is_known) return supports_;
  supported_.push_back(&rigid);
  const std::size_t first = supports_.size();
  add_supports(rigid, dispatcher, time_step, kTouch, supports_);
  const bool was_held = std::find(last_held_.begin(), last_held_.end(), &rigid) != last_held_.end();
  for (std::size_t k = first; k < supports_.size(); ++k) supports_[k].is_loaded = was_held;
  return supports_;
}

// Whether rigid bodies were pushed into others that had not held them in the last solution, or the other way round.
bool CoupledBodies::are_supports_wrong(btScalar time_step) {
  const btScalar least = kLeastPush * time_step * time_step;
  bool are_wrong = false;
  for (std::size_t b = 0; b < bodies_.size() && !supports_.empty(); ++b) {
    const GeneralizedDisplacement displacement = displacement_of(*bodies_[b]);
    are_wrong = update_loads(*bodies_[b], displacement, least, supports_) || are_wrong;
  }
  return are_wrong;
}

void CoupledBodies::read_displacements(const fast::ImplicitSolver<btScalar>& solver,
                                       btScalar time_step) {
  last_.assign(bodies_.begin(), bodies_.end());
  last_displacements_.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    last_displacements_.push_back(solver.body_motion(static_cast<int>(b)));
  }
  last_step_ = time_step;
}

GeneralizedDisplacement CoupledBodies::displacement_of(const btRigidBody& rigid) const {
  const auto found = std::find(last_.begin(), last_.end(), &rigid);
  return found == last_.end()
             ? GeneralizedDisplacement(GeneralizedDisplacement::Zero())
             : last_displacements_[static_cast<std::size_t>(found - last_.begin())];
}

btScalar CoupledBodies::push_in(const btRigidBody& rigid, btScalar time_step) const {
  const btScalar steps = last_step_ > 0 ? time_step / last_step_ : 0;
  return steps * steps * displacement_of(rigid).template head<3>().norm();
}

double CoupledBodies::kinetic_energy() const {
  double sum = 0;
  for (const btRigidBody* const rigid : bodies_) sum += kinetic_energy_of(*rigid);
  return sum;
}

double CoupledBodies::energy_to_come(btScalar time_step) const {
  double sum = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const btRigidBody& rigid = *bodies_[b];
    const GeneralizedDisplacement displacement = displacement_of(rigid);
    const btVector3 impulse = to_bullet(
        (inertias_[b].mass.cwiseProduct(displacement.template head<3>()) / time_step).eval());
    const btVector3 turning =
        to_bullet((inertias_[b].inertia * displacement.template tail<3>() / time_step).eval());
    const btVector3 turned = rigid.getInvInertiaTensorWorld() * turning;
    sum += static_cast<double>(
        btDot(rigid.getLinearVelocity(), impulse) + rigid.getInvMass() * impulse.length2() / 2 +
        btDot(rigid.getAngularVelocity(), turning) + btDot(turned, turning) / 2);
  }
  return sum;
}

void CoupledBodies::exchange_impulses(btScalar time_step) {
  velocities_before_.clear();
  for (const btRigidBody* const rigid : bodies_) {
    velocities_before_.emplace_back(rigid->getLinearVelocity(), rigid->getAngularVelocity());
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const GeneralizedDisplacement displacement = displacement_of(*bodies_[b]);
    if (displacement.isZero(0)) continue;
    auto& rigid = const_cast<btRigidBody&>(*bodies_[b]);
    const fast::RigidInertia<btScalar>& inertia = inertias_[b];
    const Vector3<btScalar> impulse = inertia.mass.cwiseProduct(displacement.template head<3>());
    const Vector3<btScalar> turning = inertia.inertia * displacement.template tail<3>();
    rigid.activate();
    rigid.applyCentralImpulse(to_bullet((impulse / time_step).eval()));
    rigid.applyTorqueImpulse(to_bullet((turning / time_step).eval()));
  }
}

void CoupledBodies::move_at_once(btScalar time_step) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const bool touches = std::any_of(supports_.begin(), supports_.end(),
                                     [&](const Support& one) { return one.body == bodies_[b]; });
    if (touches) continue;
    bridge::move_at_once(const_cast<btRigidBody&>(*bodies_[b]), velocities_before_[b].first,
                         velocities_before_[b].second, time_step);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
