#include <weft/bridge/implicit/history/steady_step.hpp>

#include <cstring>
#include <utility>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/contact/surface/solid_distances.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

bool SteadyStep::has_same_surroundings(const btSoftBody& body, std::span<const Collider> colliders,
                                       btScalar time_step) {
  now_.time_step = time_step;
  now_.margin = body.getCollisionShape()->getMargin();
  now_.friction = body.m_cfg.kDF;
  now_.damping = body.m_cfg.kDP;
  now_.collisions = body.m_cfg.collisions;
  now_.surfaces.clear();
  bool is_plain = body.m_anchors.size() == 0 && body.m_deformableAnchors.size() == 0;
  for (const Collider& collider : colliders) {
    is_plain = is_plain && SolidDistances::has(*collider.shape) && is_still_solid(collider);
    btVector3 low;
    btVector3 high;
    collider.shape->getAabb(btTransform::getIdentity(), low, high);
    now_.surfaces.push_back({collider.object, collider.shape, collider.pose, high - low,
                             collider.object->getFriction(),
                             collider.object->hasContactResponse()});
  }
  std::swap(now_, last_);
  const bool is_same = is_any_ && now_ == last_;
  is_any_ = is_plain;
  is_noted_ = true;
  return is_plain && is_same;
}

bool SteadyStep::is_known(bool is_same, const fast::ImplicitSolver<btScalar>* solver) {
  states_.resize(static_cast<std::size_t>(solver ? solver->num_nodes() : 0),
                 fast::ContactState::kFree);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const fast::ContactState before = std::exchange(states_[i], solver->contact_of(i).second);
    is_same = is_same && before == states_[i];
  }
  num_same_ = is_same ? num_same_ + 1 : 0;
  return num_same_ >= kFewest;
}

bool begins_as_last(const btSoftBody& body, const SteadyStep::State& state) {
  const auto are_same = [&](const Matrix3X<btScalar>& a, const Matrix3X<btScalar>& b) {
    const auto size = static_cast<Eigen::Index>(3) * body.m_nodes.size();
    return a.size() == size && b.size() == size &&
           std::memcmp(a.data(), b.data(), sizeof(btScalar) * static_cast<std::size_t>(size)) == 0;
  };
  if (!are_same(state.starts, state.last_starts) || !are_same(state.starts, state.last_ends) ||
      !are_same(state.velocities, state.last_velocities) ||
      state.last_predicted.size() != state.starts.size() ||
      state.last_solution.size() != state.starts.size()) {
    return false;
  }
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    const btScalar* const predicted = state.last_predicted.col(i).data();
    const bool is_same = std::memcmp(predicted, node.m_v.m_floats, 3 * sizeof(btScalar)) == 0;
    if (!is_same || !(node.m_im > 0)) return false;
  }
  return true;
}

void stay(const Matrix3X<btScalar>& velocities, btSoftBody& body) {
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    node.m_x = node.m_q;
    node.m_v = (1 - body.m_cfg.kDP) * to_bullet(velocities.col(i));
    node.m_f.setZero();
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
