#include <weft/bridge/rigid/coupled_bodies.hpp>

#include <algorithm>
#include <utility>

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
constexpr btScalar kTouchDistance = btScalar(1e-3);
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
  couplings_.clear();
  multibodies_.clear();
}

btScalar CoupledBodies::share_of(const MovableObject& object) const {
  const auto [first, last] =
      std::equal_range(of_all_.begin(), of_all_.end(), object.inertia_owner());
  return 1 / static_cast<btScalar>(std::max<std::ptrdiff_t>(1, last - first));
}

int CoupledBodies::number_of(const MovableObject& object, btDispatcher* dispatcher,
                             btScalar time_step, bool is_again) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b] == object) return static_cast<int>(b);
  }
  bodies_.push_back(object);
  fast::RigidInertia<btScalar> given;
  const btScalar share = share_of(object);
  if (const btRigidBody* const rigid = object.rigid()) {
    given.mass = share * mass_of(*rigid);
    given.inertia = share * inertia_of(*rigid);
  }
  const RigidVelocity velocity = object.velocity();
  given.motion = from_bullet<btScalar>(time_step * velocity.linear);
  given.turn = from_bullet<btScalar>(time_step * velocity.angular);
  if (is_again) given.guess = displacement_of(object);
  given.held = share * inertia_of_supports(object, supports_of(object, dispatcher, time_step));
  inertias_.push_back(given);
  return static_cast<int>(bodies_.size()) - 1;
}

void CoupledBodies::couple_links() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const btMultiBodyLinkCollider* const link = bodies_[b].link();
    if (link == nullptr) continue;
    const btMultiBody* const owner = link->m_multiBody;
    auto known = std::find_if(multibodies_.begin(), multibodies_.end(),
                              [&](const auto& one) { return &one.inertia.multibody() == owner; });
    if (known == multibodies_.end()) {
      multibodies_.push_back({MultiBodyInertia(*owner), {}, {}});
      known = multibodies_.end() - 1;
    }
    known->bodies.push_back(static_cast<int>(b));
  }
  for (PushedMultiBody& one : multibodies_) {
    std::vector<int> links;
    for (const int b : one.bodies) {
      links.push_back(bodies_[static_cast<std::size_t>(b)].link()->m_link);
    }
    const MovableObject& first = bodies_[static_cast<std::size_t>(one.bodies[0])];
    one.of_links = static_cast<double>(share_of(first)) * one.inertia.inertia_of(links);
    for (std::size_t i = 0; i < one.bodies.size(); ++i) {
      for (std::size_t j = i; j < one.bodies.size(); ++j) {
        const Eigen::Matrix<btScalar, 6, 6> block =
            one.of_links
                .block<6, 6>(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(j))
                .cast<btScalar>();
        if (i == j) {
          fast::RigidInertia<btScalar>& inertia =
              inertias_[static_cast<std::size_t>(one.bodies[i])];
          inertia.of_link = block;
          inertia.has_base = !is_base_free(one.inertia.multibody());
        } else {
          couplings_.push_back({one.bodies[i], one.bodies[j], block});
        }
      }
    }
  }
}

VectorX<double> CoupledBodies::impulse_on(const PushedMultiBody& pushed, btScalar time_step) const {
  VectorX<double> displacements(pushed.of_links.cols());
  for (std::size_t k = 0; k < pushed.bodies.size(); ++k) {
    const MovableObject& link = bodies_[static_cast<std::size_t>(pushed.bodies[k])];
    displacements.segment<6>(6 * static_cast<Eigen::Index>(k)) =
        displacement_of(link).template cast<double>();
  }
  const VectorX<double> of_links = pushed.of_links * displacements / static_cast<double>(time_step);
  VectorX<double> sum = VectorX<double>::Zero(6 + pushed.inertia.multibody().getNumDofs());
  for (std::size_t k = 0; k < pushed.bodies.size(); ++k) {
    const int link = bodies_[static_cast<std::size_t>(pushed.bodies[k])].link()->m_link;
    sum += pushed.inertia.jacobian_of(link).transpose() *
           of_links.segment<6>(6 * static_cast<Eigen::Index>(k));
  }
  return sum;
}

// Those of a body that was held in the last step are likely to hold it again: the others have to be found out.
const std::vector<Support>& CoupledBodies::supports_of(const MovableObject& object,
                                                       btDispatcher* dispatcher,
                                                       btScalar time_step) {
  const bool is_known = std::find(supported_.begin(), supported_.end(), object) != supported_.end();
  if (is_known) return supports_;
  supported_.push_back(object);
  const std::size_t first = supports_.size();
  add_supports(object, dispatcher, time_step, kTouchDistance, supports_);
  const bool was_held = std::find(last_held_.begin(), last_held_.end(), object) != last_held_.end();
  for (std::size_t k = first; k < supports_.size(); ++k) supports_[k].is_loaded = was_held;
  return supports_;
}

// Whether rigid bodies were pushed into others that had not held them in the last solution, or the other way round.
bool CoupledBodies::are_supports_wrong(btScalar time_step) {
  const btScalar least = kLeastPush * time_step * time_step;
  bool are_wrong = false;
  for (std::size_t b = 0; b < bodies_.size() && !supports_.empty(); ++b) {
    const GeneralizedDisplacement displacement = displacement_of(bodies_[b]);
    are_wrong = update_loads(bodies_[b], displacement, least, supports_) || are_wrong;
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

GeneralizedDisplacement CoupledBodies::displacement_of(const MovableObject& object) const {
  const auto found = std::find(last_.begin(), last_.end(), object);
  return found == last_.end()
             ? GeneralizedDisplacement(GeneralizedDisplacement::Zero())
             : last_displacements_[static_cast<std::size_t>(found - last_.begin())];
}

btScalar CoupledBodies::push_in(const MovableObject& object, btScalar time_step) const {
  const btScalar steps = last_step_ > 0 ? time_step / last_step_ : 0;
  return steps * steps * displacement_of(object).template head<3>().norm();
}

bool CoupledBodies::has_borne(const MovableObject& object, btScalar time_step) const {
  const btScalar fall = time_step * time_step * object.gravity().length();
  const btScalar pushed = push_in(object, time_step);
  return pushed > fall / 2 && pushed < fall + fall / 2;
}

double CoupledBodies::kinetic_energy() const {
  double sum = 0;
  for (const MovableObject& object : bodies_) {
    if (object.rigid() != nullptr) sum += kinetic_energy_of(*object.rigid());
  }
  for (const PushedMultiBody& one : multibodies_) sum += one.inertia.kinetic_energy();
  return sum;
}

double CoupledBodies::energy_to_come(btScalar time_step) const {
  double sum = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].rigid() == nullptr) continue;
    const btRigidBody& rigid = *bodies_[b].rigid();
    const GeneralizedDisplacement displacement = displacement_of(bodies_[b]);
    const btVector3 impulse = to_bullet(
        (inertias_[b].mass.cwiseProduct(displacement.template head<3>()) / time_step).eval());
    const btVector3 turning =
        to_bullet((inertias_[b].inertia * displacement.template tail<3>() / time_step).eval());
    const btVector3 turned = rigid.getInvInertiaTensorWorld() * turning;
    sum += static_cast<double>(
        btDot(rigid.getLinearVelocity(), impulse) + rigid.getInvMass() * impulse.length2() / 2 +
        btDot(rigid.getAngularVelocity(), turning) + btDot(turned, turning) / 2);
  }
  for (const PushedMultiBody& one : multibodies_) {
    sum += one.inertia.energy_gain(impulse_on(one, time_step));
  }
  return sum;
}

void CoupledBodies::exchange_impulses(btScalar time_step) {
  velocities_before_.clear();
  for (const MovableObject& object : bodies_) velocities_before_.push_back(object.velocity());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const GeneralizedDisplacement displacement = displacement_of(bodies_[b]);
    if (displacement.isZero(0)) continue;
    bodies_[b].activate();
    if (bodies_[b].rigid() == nullptr) continue;
    btRigidBody& rigid = *bodies_[b].rigid();
    const fast::RigidInertia<btScalar>& inertia = inertias_[b];
    const Vector3<btScalar> impulse = inertia.mass.cwiseProduct(displacement.template head<3>());
    const Vector3<btScalar> turning = inertia.inertia * displacement.template tail<3>();
    rigid.applyCentralImpulse(to_bullet((impulse / time_step).eval()));
    rigid.applyTorqueImpulse(to_bullet((turning / time_step).eval()));
  }
  for (const PushedMultiBody& one : multibodies_) {
    const VectorX<btScalar> change =
        one.inertia.response_to(impulse_on(one, time_step)).cast<btScalar>();
    if (change.isZero(0)) continue;
    bodies_[static_cast<std::size_t>(one.bodies[0])].link()->m_multiBody->applyDeltaVeeMultiDof(
        change.data(), 1);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
