// What touches or leads a fast body, as its solver sees it, and what that gets from it.
// Tested by tests/bridge/implicit/fast_body_anchor_test.cpp, tests/bridge/implicit/fast_body_impact_test.cpp.
#include <algorithm>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/implicit/node_anchors.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

Vector3<btScalar> lever_arm(const MovableObject& object, const btVector3& point) {
  return from_bullet<btScalar>(point - object.center());
}

MovableObject movable_of(const RigidContact& contact) {
  return contact.is_dynamic ? MovableObject(contact.object) : MovableObject();
}

/// How far below its plane a node may end a step, as a share of the margin [-].
constexpr btScalar kProjectedShare = btScalar(0.5);
static_assert(SettledNodes::kDepthShare < kProjectedShare);

}  // namespace

void FastBody::find_contacts(const btSoftBody& body, const Collider& collider, btScalar time_step,
                             std::vector<RigidContact>& contacts,
                             std::span<const char> is_left_out) {
  swept_.update(body, &team_);
  add_rigid_contacts(body, swept_, collider, time_step, PinnedNodes::kLeftOut, contacts, &team_,
                     is_left_out);
}

// The pose of a rigid body at the end of the step: as Bullet has moved it, and as the last solution moves it further.
btTransform FastBody::solved_pose(const MovableObject& object) const {
  btTransform end = object.pose();
  const GeneralizedDisplacement displacement = pushed_.displacement_of(object);
  if (displacement.isZero(0)) return end;
  end.setOrigin(end.getOrigin() + to_bullet(displacement.head<3>().eval()));
  const btScalar angle = displacement.tail<3>().norm();
  if (angle > 0) {
    const btVector3 axis = to_bullet((displacement.tail<3>() / angle).eval());
    end.setBasis(btMatrix3x3(btQuaternion(axis, angle)) * end.getBasis());
  }
  return end;
}

void FastBody::follow_colliders(bool to_solution) {
  for (Collider& collider : colliders_) {
    const MovableObject object{collider.object};
    if (object) {
      const btTransform end = to_solution ? solved_pose(object) : object.pose();
      collider.motion = end * collider.object_pose.inverse();
    } else if (link_of(collider.object) != nullptr) {
      led_links_.follow(collider);
    }
  }
}

// Whether the solution needs contacts that are not known. Those that it keeps to anyway are left out. Where a dynamic object
// was met at another position of the node than it has come to, the plane there counts from now on.
bool FastBody::find_missed_contacts(btSoftBody& body, btScalar time_step) {
  deep_.clear();
  if (colliders_.empty()) return false;
  write_positions(body);
  found_.clear();
  swept_.invalidate();
  for (const Collider& collider : colliders_) {
    settled_.find(body, contacts_, collider);
    if (!settled_.are_all()) find_contacts(body, collider, time_step, found_, settled_.flags());
  }
  if (found_.empty()) return false;
  known_.list(contacts_, body.m_nodes.size());
  const btScalar margin = body.getCollisionShape()->getMargin();
  const std::size_t num_known = contacts_.size();
  bool is_any_wrong = false;
  for (RigidContact& found : found_) {
    if (pinches_.has(found.node)) continue;
    if (backed_.has(found.node) && !found.is_dynamic) continue;
    const btVector3& position = body.m_nodes[found.node].m_x;
    const btScalar gap = btDot(found.normal, position) - found.offset;
    const MovableObject object = movable_of(found);
    if (gap < -kProjectedShare * margin && !object) deep_.push_back(found);
    RigidContact* const known = known_.find(found, position, margin, contacts_);
    if (known != nullptr && object) {
      RigidContact solved = *known;
      follow_object(solved, solved_pose(object));
      const btScalar known_gap = btDot(solved.normal, position) - solved.offset;
      if (std::abs(std::min(gap, known_gap)) < margin &&
          std::abs(gap - known_gap) > KnownContacts::kPlaneShare * margin) {
        *known = found;
        is_any_wrong = true;
      }
    } else if (known == nullptr && gap < 0) {
      contacts_.push_back(found);
    }
  }
  for (RigidContact& contact : contacts_) {
    if (contact.is_dynamic) follow_object(contact, MovableObject(contact.object).pose());
  }
  return is_any_wrong || contacts_.size() > num_known;
}

// Contacts that only the last solution shows: nodes that slide from one facet into the next. Not out of dynamic objects, which would have
// to be pushed for that: a node that is left inside of one comes out in the next step.
void FastBody::project_out_of_missed_colliders(btSoftBody& body, btScalar time_step) {
  if (!is_unfinished()) return;
  const std::size_t num_solved = contacts_.size();
  for (int look = 0; look <= kMostRedetections && find_missed_contacts(body, time_step); ++look) {
    for (const RigidContact& contact : contacts_) {
      if (contact.is_dynamic || is_between(contact.node)) continue;
      is_projected_ = true;
      if (look == kMostRedetections && &contact >= &contacts_[num_solved]) {  // between two facets
        positions_.col(contact.node) =
            starts_.col(contact.node) + from_bullet<btScalar>(contact.motion);
        continue;
      }
      const Vector3<btScalar> normal = from_bullet<btScalar>(contact.normal);
      const btScalar gap = normal.dot(positions_.col(contact.node) + origin_) - contact.offset;
      if (gap < 0) positions_.col(contact.node) -= gap * normal;
    }
  }
  contacts_.resize(num_solved);  // the others have no force in the solution
}

// A node is held by one plane at a time; where facets meet, that of one may let it into another. Where the step
// began it was outside.
void FastBody::project_out_of_planes() {
  is_projected_ = is_projected_ || !deep_.empty();
  for (const RigidContact& contact : deep_) {
    const Vector3<btScalar> normal = from_bullet<btScalar>(contact.normal);
    const Vector3<btScalar> start =
        starts_.col(contact.node) + from_bullet<btScalar>(contact.motion);
    if (normal.dot(start) > normal.dot(positions_.col(contact.node)))
      positions_.col(contact.node) = start;
  }
}

// Other cloth may have pushed nodes into what does not move.
void FastBody::project_out_of_colliders(btSoftBody& body) const {
  for (const RigidContact& contact : contacts_) {
    if (contact.is_dynamic || is_between(contact.node)) continue;
    btSoftBody::Node& node = body.m_nodes[contact.node];
    const btScalar gap = btDot(contact.normal, node.m_x) - contact.offset;
    if (gap < 0 && node.m_im > 0) node.m_x -= gap * contact.normal;
  }
}

// Those that are only near are not meant: a cloth that holds a body alone has to move all of it.
void FastBody::list_coupled(const btSoftBody& body, std::vector<const void*>& list) const {
  const std::size_t num_before = list.size();
  const auto add = [&](const MovableObject& object) {
    const void* const owner = object.inertia_owner();
    const auto mine = list.begin() + static_cast<std::ptrdiff_t>(num_before);
    if (owner != nullptr && std::find(mine, list.end(), owner) == list.end()) list.push_back(owner);
  };
  for_anchors(body, [&](const NodeAnchor& anchor) { add(MovableObject(anchor.object)); });
  for (const RigidContact& contact : contacts_) {
    if (!contact.is_dynamic) continue;
    const MovableObject object{contact.object};
    const bool is_inside = btDot(contact.normal, body.m_nodes[contact.node].m_x) < contact.offset;
    if (is_inside || !pushed_.displacement_of(object).isZero(0)) add(object);
  }
}

void FastBody::read_constraints(const btSoftBody& body, btScalar time_step, bool is_again) {
  pushed_.clear();
  plane_contacts_.clear();
  pinches_.find(contacts_, body, body.m_sst.sdt);
  backed_.find(contacts_, body, pinches_);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const RigidContact& contact = contacts_[c];
    fast::PlaneContact<btScalar> plane;
    plane.node = contact.node;
    plane.normal = from_bullet<btScalar>(contact.normal);
    plane.offset = contact.offset - plane.normal.dot(origin_);
    plane.motion = from_bullet<btScalar>(contact.motion);
    plane.friction = body.m_cfg.kDF * contact.object->getFriction();
    pinches_.press(c, body.m_cfg.kDF, origin_, plane);
    if (pinches_.is_replaced(c) || backed_.is_behind(c)) plane.offset -= BackedNodes::kFarAway;
    if (!pinches_.has(contact.node))
      plane.offset -=
          backed_.depth_to_keep(contact, plane, starts_, inertia_step_, time_step / body.m_sst.sdt,
                                pinches_.margin_beside(c, body));
    const MovableObject object = movable_of(contact);
    if (object && !pinches_.has(contact.node)) {
      plane.body = pushed_.number_of(object, body.m_worldInfo->m_dispatcher, time_step, is_again);
      // The surface holds the node there, which is predicted to be deep inside.
      const btVector3& point = body.m_nodes[contact.node].m_x;
      const btScalar gap = btDot(contact.normal, point) - contact.offset;
      plane.lever_arm = lever_arm(object, point - std::min(btScalar(0), gap) * contact.normal);
      if (const btVector3* const local = sticking_points_.find(contact.node, object)) {
        plane.motion =
            from_bullet<btScalar>(object.pose() * *local) - origin_ - starts_.col(contact.node);
      }
    }
    plane_contacts_.push_back(plane);
  }
  backed_.make_supports(contacts_, plane_contacts_, starts_, origin_, inertia_step_, is_again,
                        pushed_, supports_);
  kinematic_.clear();
  for_anchors(body, [&](const NodeAnchor& anchor) {
    if (!is_free_[static_cast<std::size_t>(anchor.node)]) return;
    const bool is_kinematic =
        std::any_of(kinematic_.begin(), kinematic_.end(),
                    [&](const auto& other) { return other.node == anchor.node; });
    if (is_kinematic) return;  // by an anchor before
    const bool is_movable = bool(MovableObject(anchor.object));
    const btVector3 point = (is_movable ? anchor.object->getWorldTransform()
                                        : kinematic_pose(*anchor.object, time_left_)) *
                            anchor.local;
    fast::KinematicNode<btScalar> led;
    led.node = anchor.node;
    led.position = from_bullet<btScalar>(point) - origin_;
    if (const MovableObject object{anchor.object}) {
      led.body = pushed_.number_of(object, body.m_worldInfo->m_dispatcher, time_step, is_again);
      led.lever_arm = lever_arm(object, point);
    }
    kinematic_.push_back(led);
  });
  pushed_.couple_links();
}

void FastBody::exchange_impulses(btSoftBody& body, btScalar time_step) {
  // Forces that act with the whole step.
  const btScalar whole_step = inertia_step_ * inertia_step_ / time_step;
  sticking_points_.begin_update();
  for (std::size_t c = 0; c < plane_contacts_.size(); ++c) {
    RigidContact& contact = contacts_[c];
    const MovableObject object = movable_of(contact);
    const auto [active, state] =
        active_solver().contact_of(static_cast<std::size_t>(contacts_[c].node));
    if (active != static_cast<int>(c)) continue;
    contact.impulse = whole_step * to_bullet(active_solver().constraint_force(contact.node));
    contact.is_sticking = active_solver().is_held_by_friction(contact.node);
    if (plane_contacts_[c].body < 0) continue;
    sticking_points_.add(contacts_[c].node, object, state == fast::ContactState::kFixed,
                         solved_pose(object), in_world(contacts_[c].node));
  }
  sticking_points_.end_update();
  for (std::size_t k = 0; k < supports_.size(); ++k) {
    contacts_[static_cast<std::size_t>(backed_.all()[k].behind)].impulse =
        whole_step * to_bullet(active_solver().support_force(k));
  }
  const auto impulse_on = [&](int node) -> btVector3 {
    return whole_step * to_bullet(active_solver().constraint_force(node));
  };
  const auto gap_of = [&](RigidContact contact) {
    if (const MovableObject object = movable_of(contact))
      follow_object(contact, solved_pose(object));
    return btDot(contact.normal, in_world(contact.node)) - contact.offset;
  };
  backed_.end_step(contacts_, pinches_, body.getCollisionShape()->getMargin(), gap_of);
  pinches_.push_back(contacts_, impulse_on, [&](int node) { return in_world(node); });
  given_to_bodies_ = -pushed_.kinetic_energy();
  pushed_.exchange_impulses(time_step);
  for (int a = 0; a < body.m_anchors.size(); ++a) {  // that push with a share only
    const btSoftBody::Anchor& anchor = body.m_anchors[a];
    const MovableObject object{anchor.m_body};
    if (anchor.m_influence == 1 || !object) continue;
    const auto node = static_cast<int>(anchor.m_node - &body.m_nodes[0]);
    // A force that acts with the whole step.
    const btScalar share = inertia_step_ * inertia_step_ / (time_step * time_step);
    const btVector3 impulse = share * time_step * to_bullet(active_solver().constraint_force(node));
    object.activate();
    object.rigid()->applyImpulse((1 - anchor.m_influence) * impulse,
                                 in_world(node) - object.center());
  }
  given_to_bodies_ += pushed_.kinetic_energy();
  pushed_.move_at_once(time_step, [&](const MovableObject& one) { return moves_freely(one); });
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
