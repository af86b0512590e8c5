#include <weft/bridge/contact/backed_nodes.hpp>

#include <algorithm>
#include <numeric>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Cosine of the angle between the normals of two surfaces that press on each other, at most: 37 degrees from opposite.
constexpr btScalar kOpposite = btScalar(-0.8);

bool is_dynamic_rigid(const RigidContact& contact) {
  return MovableObject(contact.object).rigid() != nullptr;
}

bool is_link(const RigidContact& contact) {
  return link_of(contact.object) != nullptr;
}

/// [m] Between two planes, with the margins of the node taken off.
btScalar room_between(const RigidContact& one, const RigidContact& other, const btSoftBody& body) {
  const btVector3& position = body.m_nodes[one.node].m_x;
  return btDot(one.normal + other.normal, position) - one.offset - other.offset;
}

/// Whether the first of two that are pressed on each other yields to the other: the lighter one.
bool yields(const RigidContact& one, const RigidContact& other) {
  const btScalar inverse_mass = MovableObject(one.object).inverse_mass();
  const MovableObject behind{other.object};
  return !behind || inverse_mass >= behind.inverse_mass();
}

}  // namespace

void BackedNodes::find(std::span<const RigidContact> contacts, const btSoftBody& body) {
  backings_.clear();
  is_behind_.clear();
  presses_.clear();
  if (std::none_of(contacts.begin(), contacts.end(), is_dynamic_rigid)) return;
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
    for (auto one = first; one != last; ++one) {
      if (!is_dynamic_rigid(at(*one))) continue;
      for (auto other = first; other != last; ++other) {
        if (at(*one).object == at(*other).object || is_link(at(*other))) continue;
        if (btDot(at(*one).normal, at(*other).normal) > kOpposite) continue;
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

int BackedNodes::num_pressed_by(const btCollisionObject& object) const {
  const auto known = std::find_if(presses_.begin(), presses_.end(),
                                  [&](const Press& one) { return one.object == &object; });
  return known == presses_.end() ? 0 : known->num_nodes;
}

bool BackedNodes::has(int node) const {
  const auto found =
      std::lower_bound(backings_.begin(), backings_.end(), node,
                       [](const Backing& one, int sought) { return one.node < sought; });
  return found != backings_.end() && found->node == node;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
