// What touches or leads a fast body, as its solver sees it, and what that gets from it.
#include <algorithm>

#include <weft/bridge/bullet_vector.hpp>
#include <weft/bridge/fast_body.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// [m^2] Inertia over mass of a body that cannot be turned, far above that of any that can.
constexpr btScalar kNoTurn = 100;
/// Over the mass: that in a direction in which a body cannot be moved.
constexpr btScalar kNoWay = 1e4;

/// With what Bullet makes of impulses: in the world, factors included [kg].
Vector3<btScalar> mass_of(const btRigidBody& rigid) {
  const btScalar mass = 1 / rigid.getInvMass();
  const Vector3<btScalar> factor = from_bullet<btScalar>(rigid.getLinearFactor());
  return mass * factor.cwiseMax(1 / kNoWay).cwiseInverse();
}

/// Likewise [kg m^2].
Matrix3<btScalar> inertia_of(const btRigidBody& rigid) {
  Matrix3<btScalar> inverse;
  for (int k = 0; k < 3; ++k) {
    inverse.row(k) = from_bullet<btScalar>(rigid.getInvInertiaTensorWorld().getRow(k)).transpose();
  }
  const Vector3<btScalar> factor = from_bullet<btScalar>(rigid.getAngularFactor());
  inverse = (factor.asDiagonal() * inverse * factor.asDiagonal()).eval();
  inverse.diagonal().array() += rigid.getInvMass() / kNoTurn;
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

void push(btRigidBody& rigid, const btVector3& impulse, const btVector3& place) {
  rigid.activate();
  rigid.applyImpulse(impulse, place - rigid.getCenterOfMassPosition());
}

/// Of the margin: how far below its plane a node may end a step.
constexpr btScalar kDepthShare = btScalar(0.5);
/// Of the margin: by how much a plane may be wrong where the node has come to.
constexpr btScalar kPlaneShare = btScalar(0.02);
/// [m] How near to a rigid object a body touches it.
constexpr btScalar kTouch = btScalar(1e-3);
/// [m/s^2] From which acceleration on it is pushed into it.
constexpr btScalar kLeastPush = btScalar(0.05);

}  // namespace

void FastBody::find_contacts(const btSoftBody& body, const Obstacle& obstacle, btScalar time_step,
                             std::vector<RigidContact>& contacts) {
  ways_.update(body, &team_);
  add_rigid_contacts(body, ways_, obstacle, time_step, PinnedNodes::kLeftOut, contacts, &team_);
}

// Where a rigid body is at the end of the step: as Bullet has moved it, and as the last solution moves it further.
btTransform FastBody::solved_place(const btRigidBody& rigid) const {
  btTransform place = rigid.getCenterOfMassTransform();
  const RigidWay way = way_of(rigid);
  if (way.isZero(0)) return place;
  place.setOrigin(place.getOrigin() + to_bullet(way.head<3>().eval()));
  const btScalar angle = way.tail<3>().norm();
  if (angle > 0) {
    const btVector3 axis = to_bullet((way.tail<3>() / angle).eval());
    place.setBasis(btMatrix3x3(btQuaternion(axis, angle)) * place.getBasis());
  }
  return place;
}

void FastBody::follow_obstacles(bool to_solution) {
  for (Obstacle& obstacle : obstacles_) {
    const btRigidBody* const rigid = movable(obstacle.object);
    if (rigid == nullptr) continue;
    const btTransform end = to_solution ? solved_place(*rigid) : rigid->getCenterOfMassTransform();
    obstacle.motion = end * obstacle.object_place.inverse();
  }
}

// The contact that is known of a node and an obstacle, after list_known().
RigidContact* FastBody::known_contact(const RigidContact& found) {
  for (int c = last_contact_[static_cast<std::size_t>(found.node)]; c >= 0;
       c = contact_before_[static_cast<std::size_t>(c)]) {
    RigidContact& known = contacts_[static_cast<std::size_t>(c)];
    if (known.obstacle == found.obstacle) return &known;
  }
  return nullptr;
}

void FastBody::list_known(const btSoftBody& body) {
  last_contact_.assign(static_cast<std::size_t>(body.m_nodes.size()), -1);
  contact_before_.resize(contacts_.size());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    int& last = last_contact_[static_cast<std::size_t>(contacts_[c].node)];
    contact_before_[c] = last;
    last = static_cast<int>(c);
  }
}

// Whether the solution needs contacts that are not known. Those that it keeps to anyway are left out. Where a dynamic object
// was met by another place of the node than it has come to, the plane there counts from now on.
bool FastBody::find_missed_contacts(btSoftBody& body, btScalar time_step) {
  deep_.clear();
  if (obstacles_.empty()) return false;
  write_places(body);
  found_.clear();
  ways_.outdate();
  for (const Obstacle& obstacle : obstacles_) find_contacts(body, obstacle, time_step, found_);
  if (found_.empty()) return false;
  list_known(body);
  const btScalar margin = body.getCollisionShape()->getMargin();
  const std::size_t num_known = contacts_.size();
  bool is_any_wrong = false;
  for (RigidContact& found : found_) {
    const btVector3& place = body.m_nodes[found.node].m_x;
    const btScalar gap = btDot(found.normal, place) - found.offset;
    const btRigidBody* const rigid = movable(found.object);
    if (gap < -kDepthShare * margin && rigid == nullptr) deep_.push_back(found);
    RigidContact* const known = known_contact(found);
    if (known != nullptr && rigid != nullptr) {
      RigidContact solved = *known;
      follow_object(solved, solved_place(*rigid));
      const btScalar known_gap = btDot(solved.normal, place) - solved.offset;
      if (std::abs(std::min(gap, known_gap)) < margin &&
          std::abs(gap - known_gap) > kPlaneShare * margin) {
        *known = found;
        is_any_wrong = true;
      }
    } else if (known == nullptr && gap < 0) {
      contacts_.push_back(found);
    }
  }
  for (RigidContact& contact : contacts_) {
    if (const btRigidBody* const rigid = movable(contact.object)) {
      follow_object(contact, rigid->getCenterOfMassTransform());
    }
  }
  return is_any_wrong || contacts_.size() > num_known;
}

// What the last solution needs too: nodes that slide from one facet into the next. Not out of dynamic objects, which would have
// to be pushed for that: a node that is left inside of one comes out in the next step.
void FastBody::keep_out_of_missed(btSoftBody& body, btScalar time_step) {
  if (!is_unfinished()) return;
  const std::size_t num_solved = contacts_.size();
  for (int look = 0; look <= kMostLooks && find_missed_contacts(body, time_step); ++look) {
    for (const RigidContact& contact : contacts_) {
      if (movable(contact.object) != nullptr) continue;
      is_projected_ = true;
      if (look == kMostLooks && &contact >= &contacts_[num_solved]) {  // between two facets
        places_.col(contact.node) =
            starts_.col(contact.node) + from_bullet<btScalar>(contact.motion);
        continue;
      }
      const Vector3<btScalar> normal = from_bullet<btScalar>(contact.normal);
      const btScalar gap = normal.dot(places_.col(contact.node) + origin_) - contact.offset;
      if (gap < 0) places_.col(contact.node) -= gap * normal;
    }
  }
  contacts_.resize(num_solved);  // the others have no force in the solution
}

// A node is held by one plane at a time; where facets meet, that of one may let it into another. Where the step
// began it was outside.
void FastBody::leave_depths() {
  is_projected_ = is_projected_ || !deep_.empty();
  for (const RigidContact& contact : deep_) {
    const Vector3<btScalar> normal = from_bullet<btScalar>(contact.normal);
    const Vector3<btScalar> start =
        starts_.col(contact.node) + from_bullet<btScalar>(contact.motion);
    if (normal.dot(start) > normal.dot(places_.col(contact.node)))
      places_.col(contact.node) = start;
  }
}

// Other cloth may have pushed nodes into what does not give way.
void FastBody::stay_outside(btSoftBody& body) const {
  for (const RigidContact& contact : contacts_) {
    if (movable(contact.object) != nullptr) continue;
    btSoftBody::Node& node = body.m_nodes[contact.node];
    const btScalar gap = btDot(contact.normal, node.m_x) - contact.offset;
    if (gap < 0 && node.m_im > 0) node.m_x -= gap * contact.normal;
  }
}

// Those that are only near are not meant: a cloth that holds a body alone has to move all of it.
void FastBody::list_pushed(const btSoftBody& body, std::vector<const btRigidBody*>& list) const {
  const std::size_t num_before = list.size();
  const auto add = [&](const btRigidBody* rigid) {
    const auto mine = list.begin() + static_cast<std::ptrdiff_t>(num_before);
    if (rigid != nullptr && std::find(mine, list.end(), rigid) == list.end()) list.push_back(rigid);
  };
  for (int a = 0; a < body.m_anchors.size(); ++a) add(movable(body.m_anchors[a].m_body));
  for (const RigidContact& contact : contacts_) {
    const btRigidBody* const rigid = movable(contact.object);
    if (rigid == nullptr) continue;
    const bool is_inside = btDot(contact.normal, body.m_nodes[contact.node].m_x) < contact.offset;
    if (is_inside || !way_of(*rigid).isZero(0)) add(rigid);
  }
}

/// How far a rigid body gave way in the last solution.
RigidWay FastBody::way_of(const btRigidBody& rigid) const {
  for (std::size_t b = 0; b < last_pushed_.size(); ++b) {
    if (last_pushed_[b] == &rigid) return last_ways_[b];
  }
  return RigidWay::Zero();
}

void FastBody::remember_ways() {
  last_pushed_.assign(pushed_.begin(), pushed_.end());
  last_ways_.clear();
  for (std::size_t b = 0; b < pushed_.size(); ++b) {
    last_ways_.push_back(solver_->body_motion(static_cast<int>(b)));
  }
}

// A body that is pushed for the first time in this step gets the next number.
int FastBody::number_of(const btSoftBody& body, const btRigidBody& rigid, btScalar time_step,
                        bool is_again) {
  for (std::size_t b = 0; b < pushed_.size(); ++b) {
    if (pushed_[b] == &rigid) return static_cast<int>(b);
  }
  pushed_.push_back(&rigid);
  fast::RigidInertia<btScalar> given;
  const auto [first, last] = std::equal_range(all_pushed_.begin(), all_pushed_.end(), &rigid);
  const auto share = 1 / static_cast<btScalar>(std::max<std::ptrdiff_t>(1, last - first));
  given.mass = share * mass_of(rigid);
  given.inertia = share * inertia_of(rigid);
  given.motion = from_bullet<btScalar>(time_step * rigid.getLinearVelocity());
  given.turn = from_bullet<btScalar>(time_step * rigid.getAngularVelocity());
  if (is_again) given.guess = way_of(rigid);
  given.held = share * inertia_of_supports(rigid, supports_of(body, rigid, time_step));
  inertias_.push_back(given);
  pushed_places_.push_back(rigid.getCenterOfMassTransform());
  return static_cast<int>(pushed_.size()) - 1;
}

// Those of a body that was held in the last step are likely to hold it again: the others have to be found out.
const std::vector<Support>& FastBody::supports_of(const btSoftBody& body, const btRigidBody& rigid,
                                                  btScalar time_step) {
  const bool is_known = std::find(supported_.begin(), supported_.end(), &rigid) != supported_.end();
  if (is_known) return supports_;
  supported_.push_back(&rigid);
  const std::size_t first = supports_.size();
  add_supports(rigid, body.m_worldInfo->m_dispatcher, time_step, kTouch, supports_);
  const bool was_held = std::find(last_held_.begin(), last_held_.end(), &rigid) != last_held_.end();
  for (std::size_t k = first; k < supports_.size(); ++k) supports_[k].is_loaded = was_held;
  return supports_;
}

// Whether rigid bodies were pushed into others that had not held them in the last solution, or the other way round.
bool FastBody::are_supports_wrong(btScalar time_step) {
  const btScalar least = kLeastPush * time_step * time_step;
  bool are_wrong = false;
  for (std::size_t b = 0; b < pushed_.size() && !supports_.empty(); ++b) {
    const RigidWay way = solver_->body_motion(static_cast<int>(b));
    are_wrong = update_loads(*pushed_[b], way, least, supports_) || are_wrong;
  }
  return are_wrong;
}

void FastBody::forget_supports() {
  last_held_.clear();
  for (const Support& support : supports_) {
    if (support.is_loaded) last_held_.push_back(support.body);
  }
  supports_.clear();
  supported_.clear();
}

void FastBody::read_constraints(const btSoftBody& body, btScalar time_step, bool is_again) {
  pushed_.clear();
  pushed_places_.clear();
  inertias_.clear();
  const auto arm_of = [](const btRigidBody& rigid, const btVector3& place) {
    return from_bullet<btScalar>(place - rigid.getCenterOfMassPosition());
  };
  plane_contacts_.clear();
  for (const RigidContact& contact : contacts_) {
    fast::PlaneContact<btScalar> plane;
    plane.node = contact.node;
    plane.normal = from_bullet<btScalar>(contact.normal);
    plane.offset = contact.offset - plane.normal.dot(origin_);
    plane.motion = from_bullet<btScalar>(contact.motion);
    plane.friction = body.m_cfg.kDF * contact.object->getFriction();
    if (const btRigidBody* const rigid = movable(contact.object)) {
      plane.body = number_of(body, *rigid, time_step, is_again);
      // Where the surface holds the node, which is predicted to be deep inside.
      const btVector3& place = body.m_nodes[contact.node].m_x;
      const btScalar gap = btDot(contact.normal, place) - contact.offset;
      plane.arm = arm_of(*rigid, place - std::min(btScalar(0), gap) * contact.normal);
    }
    plane_contacts_.push_back(plane);
  }
  led_.clear();
  for (int a = 0; a < body.m_anchors.size(); ++a) {
    const btSoftBody::Anchor& anchor = body.m_anchors[a];
    const auto node = static_cast<int>(anchor.m_node - &body.m_nodes[0]);
    if (!is_free_[static_cast<std::size_t>(node)]) continue;
    const bool is_led = std::any_of(led_.begin(), led_.end(),
                                    [&](const auto& other) { return other.node == node; });
    if (is_led) continue;  // by an anchor before
    const btVector3 place = anchor.m_body->getWorldTransform() * anchor.m_local;
    fast::LedNode<btScalar> led;
    led.node = node;
    led.place = from_bullet<btScalar>(place) - origin_;
    if (const btRigidBody* const rigid = movable(anchor.m_body)) {
      led.body = number_of(body, *rigid, time_step, is_again);
      led.arm = arm_of(*rigid, place);
    }
    led_.push_back(led);
  }
}

// A body gets the momentum of the motion that the solution has given to it, and that motion: Bullet has moved it before, and
// would leave nodes inside of it until the next step.
void FastBody::give_impulses(btSoftBody& body, btScalar time_step) {
  velocities_before_.clear();
  for (const btRigidBody* const rigid : pushed_) {
    velocities_before_.emplace_back(rigid->getLinearVelocity(), rigid->getAngularVelocity());
  }
  given_to_bodies_ = 0;
  for (const btRigidBody* const rigid : pushed_) given_to_bodies_ -= kinetic_energy_of(*rigid);
  for (std::size_t b = 0; b < pushed_.size(); ++b) {
    const auto motion = solver_->body_motion(static_cast<int>(b));
    if (motion.isZero(0)) continue;
    auto& rigid = const_cast<btRigidBody&>(*pushed_[b]);
    const fast::RigidInertia<btScalar>& inertia = inertias_[b];
    const Vector3<btScalar> impulse = inertia.mass.cwiseProduct(motion.template head<3>());
    const Vector3<btScalar> turning = inertia.inertia * motion.template tail<3>();
    rigid.activate();
    rigid.applyCentralImpulse(to_bullet((impulse / time_step).eval()));
    rigid.applyTorqueImpulse(to_bullet((turning / time_step).eval()));
  }
  for (int a = 0; a < body.m_anchors.size(); ++a) {  // that push with a part only
    const btSoftBody::Anchor& anchor = body.m_anchors[a];
    if (anchor.m_influence == 1 || movable(anchor.m_body) == nullptr) continue;
    const auto node = static_cast<int>(anchor.m_node - &body.m_nodes[0]);
    const btVector3 impulse = time_step * to_bullet(solver_->holding_force(node));
    push(*anchor.m_body, (1 - anchor.m_influence) * impulse, in_world(node));
  }
  for (const btRigidBody* const rigid : pushed_) given_to_bodies_ += kinetic_energy_of(*rigid);
  for (std::size_t b = 0; b < pushed_.size(); ++b) {
    const bool touches = std::any_of(supports_.begin(), supports_.end(),
                                     [&](const Support& one) { return one.body == pushed_[b]; });
    if (touches) continue;  // friction may hold it
    move_at_once(const_cast<btRigidBody&>(*pushed_[b]), velocities_before_[b].first,
                 velocities_before_[b].second, time_step);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
