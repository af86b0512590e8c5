#include <weft/bridge/contact/backed_nodes.hpp>

#include <algorithm>
#include <numeric>
#include <string>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// The frequency of a body on what backs the nodes that it presses, critically damped [rad/s]: its weight sinks in by 0.1 mm, in
/// steps of any length, and an impact of 10 m/s by 12 mm. A stiffer one would be lost in the rounding of positions.
constexpr btScalar kBackingFrequency = 300;
/// How fast a body that a step begins inside of what is behind the cloth is pushed out at most [m/s].
constexpr btScalar kFastestRecovery = btScalar(0.1);

bool may_press(const RigidContact& contact) {
  return MovableObject(contact.object).rigid() != nullptr;
}

/// Whether the plane of one surface alone may let the node into the other: they face each other, or they meet in a corner, whose angle is
/// 90 degrees at most, and the node is on its way into both.
bool holds_in(const RigidContact& one, const RigidContact& other, const btSoftBody& body) {
  if (are_opposite(one, other)) return true;
  const btVector3& position = body.m_nodes[one.node].m_x;
  return btDot(one.normal, other.normal) <= 0 && btDot(one.normal, position) < one.offset &&
         btDot(other.normal, position) < other.offset;
}

/// Whether the first of two that are pressed on each other yields to the other: the lighter one.
bool yields(const RigidContact& one, const RigidContact& other) {
  const btScalar inverse_mass = MovableObject(one.object).inverse_mass();
  const MovableObject behind{other.object};
  return !behind || inverse_mass >= behind.inverse_mass();
}

/// Nodes that begin inside of something come out to 1/e^2 in the substeps of a step, at twice the speed of a whole step. At once, they
/// would be thrown out; with 1, boxes on joints sank through a trampoline; with 3, some that tumble gain energy.
constexpr btScalar kRecoveries = 2;

/// How much of the depth at which a node begins a step inside of what is behind it is left at the end [m]. inertia_step: h' [s].
btScalar depth_after(btScalar depth, btScalar inertia_step) {
  const btScalar recovered = kBackingFrequency / (kBackingFrequency + 2 / inertia_step) * depth;
  return depth - std::min(recovered, kFastestRecovery * inertia_step);
}

}  // namespace

void BackedNodes::find(std::span<const RigidContact> contacts, const btSoftBody& body,
                       const Pinches& pinches) {
  backings_.clear();
  is_behind_.clear();
  presses_.clear();
  if (std::none_of(contacts.begin(), contacts.end(), may_press)) return;
  order_.resize(contacts.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto at = [&](int c) -> const RigidContact& {
    return contacts[static_cast<std::size_t>(c)];
  };
  std::sort(order_.begin(), order_.end(), [&](int one, int other) {
    return at(one).node != at(other).node ? at(one).node < at(other).node : one < other;
  });
  for (auto first = order_.begin(); first != order_.end();) {
    const int node = at(*first).node;
    const auto last = std::find_if(first, order_.end(), [&](int c) { return at(c).node != node; });
    Backing best;
    btScalar least_room = 0;
    for (auto one = first; one != last && !pinches.has(node); ++one) {
      if (!may_press(at(*one))) continue;
      for (auto other = first; other != last; ++other) {
        if (at(*one).object == at(*other).object || link_of(at(*other).object) != nullptr) continue;
        if (!holds_in(at(*one), at(*other), body)) continue;
        if (!yields(at(*one), at(*other))) continue;
        const btScalar room = room_between(at(*one), at(*other), body);
        if (!(room < least_room)) continue;
        least_room = room;
        best = {node, *one, *other};
      }
    }
    if (least_room < 0) {
      backings_.push_back(best);
      is_behind_.resize(contacts.size(), 0);
      is_behind_[static_cast<std::size_t>(best.behind)] = 1;
      const btCollisionObject* const object = at(best.contact).object;
      const auto known = std::find_if(presses_.begin(), presses_.end(),
                                      [&](const Press& one) { return one.object == object; });
      if (known == presses_.end()) {
        presses_.push_back({object, 1});
      } else {
        ++known->num_nodes;
      }
    }
    first = last;
  }
}

void BackedNodes::make_supports(std::span<const RigidContact> contacts,
                                std::span<const fast::PlaneContact<btScalar>> planes,
                                const Matrix3X<btScalar>& starts, const Vector3<btScalar>& origin,
                                btScalar inertia_step, bool is_again, CoupledBodies& pushed,
                                std::vector<fast::NodeSupport<btScalar>>& supports) const {
  supports.clear();
  const btScalar spring = kBackingFrequency * kBackingFrequency;
  const btScalar damper = 2 * kBackingFrequency / inertia_step;
  for (const Backing& backing : backings_) {
    const auto pressed = static_cast<std::size_t>(backing.contact);
    const fast::PlaneContact<btScalar>& plane = planes[static_cast<std::size_t>(backing.behind)];
    const fast::PlaneContact<btScalar>& pressing = planes[pressed];
    const btScalar mass =
        pushed.inertias()[static_cast<std::size_t>(pressing.body)].mass.minCoeff();
    const auto num_nodes = static_cast<btScalar>(num_pressed_by(*contacts[pressed].object));
    fast::NodeSupport<btScalar> support;
    support.node = backing.node;
    support.normal = plane.normal;
    support.motion = plane.motion;
    support.stiffness = (spring + damper) * mass / num_nodes;
    support.friction = plane.friction;
    support.body = plane.body;
    support.lever_arm = plane.lever_arm;
    support.offset =
        contacts[static_cast<std::size_t>(backing.behind)].offset - plane.normal.dot(origin);
    const Vector3<btScalar> start = starts.col(backing.node);
    const auto gap_at_start = [&](const fast::PlaneContact<btScalar>& one, btScalar offset) {
      return std::min(btScalar(0), one.normal.dot(start + one.motion) - offset);
    };
    const btScalar depth =
        -gap_at_start(plane, support.offset) - gap_at_start(pressing, pressing.offset);
    support.offset -= depth_after(depth, inertia_step);
    supports.push_back(support);
    // A body that has been moved on through the node comes to where it meets it.
    const btScalar gap = pressing.normal.dot(start + plane.motion) - pressing.offset;
    if (!is_again && gap < 0) pushed.add_to_guess(pressing.body, gap / num_nodes * pressing.normal);
  }
}

btScalar BackedNodes::depth_to_keep(const RigidContact& contact,
                                    const fast::PlaneContact<btScalar>& plane,
                                    const Matrix3X<btScalar>& starts, btScalar inertia_step,
                                    btScalar step_share, btScalar least) const {
  const Vector3<btScalar> start = starts.col(contact.node) + plane.motion;
  const btScalar depth = std::max(btScalar(0), plane.offset - plane.normal.dot(start));
  const btScalar sunken = is_sunken(contact.node) ? depth_after(depth, inertia_step) : btScalar(0);
  const btScalar kept = std::max(sunken, std::min(depth, least));
  const bool is_behind_body = has(contact.node) && !contact.is_dynamic;
  return is_behind_body
             ? kept
             : kept + (depth - kept) * std::max(btScalar(0), 1 - kRecoveries * step_share);
}

void BackedNodes::serialize(StateArchive& archive, int num_nodes) {
  archive.value(sunken_);
  for (const int node : sunken_) {
    if (node >= 0 && node < num_nodes) continue;
    archive.refuse("sunken node " + std::to_string(node) + ", expected less than " +
                   std::to_string(num_nodes));
  }
  if (!archive.is_reading()) return;
  std::sort(sunken_.begin(), sunken_.end());
  backings_.clear();
  is_behind_.clear();
}

int BackedNodes::num_pressed_by(const btCollisionObject& object) const {
  const auto known = std::find_if(presses_.begin(), presses_.end(),
                                  [&](const Press& one) { return one.object == &object; });
  return known == presses_.end() ? 0 : known->num_nodes;
}

bool BackedNodes::has(int node) const {
  const auto found =
      std::lower_bound(backings_.begin(), backings_.end(), node,
                       [](const Backing& one, int sought) { return one.node < sought; });
  return (found != backings_.end() && found->node == node) || is_sunken(node);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
