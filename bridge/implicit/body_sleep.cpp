#include <weft/bridge/implicit/body_sleep.hpp>

#include <algorithm>

#include <weft/bridge/implicit/node_anchors.hpp>
#include <weft/core/index.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
void BodySleep::wake() {
  is_asleep_ = false;
  rest_time_ = 0;
}

bool BodySleep::is_disturbed(const btSoftBody& body) const {
  if (meets_motion_ || met_.size() != neighbors_.size()) return true;
  for (const Neighbor& now : met_) {
    const bool is_known =
        std::any_of(neighbors_.begin(), neighbors_.end(), [&](const Neighbor& before) {
          return before.object == now.object && before.pose == now.pose;
        });
    if (!is_known) return true;
  }
  if (at(body.m_anchors.size() + body.m_deformableAnchors.size()) != anchors_.size()) return true;
  bool are_same = true;
  std::size_t a = 0;
  for_anchors(body, [&](const NodeAnchor& anchor) {
    const Neighbor& known = anchors_[a++];
    are_same = are_same && anchor.object == known.object &&
               anchor.object->getWorldTransform() == known.pose;
  });
  if (!are_same) return true;
  if (body.m_worldInfo->m_gravity != gravity_ || body.m_windVelocity != wind_) return true;
  if (at(body.m_nodes.size()) != positions_.size()) return true;
  const btVector3 zero(0, 0, 0);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_x != positions_[at(i)] || node.m_v != zero || node.m_f != zero ||
        node.m_im != inverse_masses_[at(i)]) {
      return true;
    }
  }
  return false;
}

bool BodySleep::begin_step(const btSoftBody& body) {
  const bool wakes = is_asleep_ && is_disturbed(body);
  if (wakes) wake();
  met_.clear();
  meets_motion_ = false;
  return wakes;
}

void BodySleep::meet(const btCollisionObject& object, const btTransform& pose) {
  met_.push_back({&object, pose});
  // One that moves without our knowing why, or will, for nothing has put it to sleep.
  if (!object.isStaticOrKinematicObject() && object.isActive()) meets_motion_ = true;
}

void BodySleep::notify_cloth(bool is_at_rest) {
  if (!is_at_rest) meets_motion_ = true;
}

void BodySleep::remember(const btSoftBody& body) {
  neighbors_ = met_;
  anchors_.clear();
  for_anchors(body, [&](const NodeAnchor& anchor) {
    anchors_.push_back({anchor.object, anchor.object->getWorldTransform()});
  });
  positions_.clear();
  inverse_masses_.clear();
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    positions_.push_back(body.m_nodes[i].m_x);
    inverse_masses_.push_back(body.m_nodes[i].m_im);
  }
  gravity_ = body.m_worldInfo->m_gravity;
  wind_ = body.m_windVelocity;
}

void BodySleep::end_step(btSoftBody& body, btScalar time_step, const FastSettings& settings) {
  if (is_asleep_) return;
  const auto limit = static_cast<btScalar>(settings.sleep_speed * settings.sleep_speed);
  bool is_slow = settings.may_sleep && !meets_motion_;
  for (int i = 0; is_slow && i < body.m_nodes.size(); ++i) {
    is_slow = body.m_nodes[i].m_v.length2() < limit;
  }
  rest_time_ = is_slow ? rest_time_ + static_cast<double>(time_step) : 0.0;
  if (!is_at_rest(settings) || !is_slow) return;
  for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_v.setZero();
  remember(body);
  is_asleep_ = true;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
