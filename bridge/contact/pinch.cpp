#include <weft/bridge/contact/pinch.hpp>

#include <algorithm>
#include <iterator>
#include <optional>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// [N] Of surfaces that the program leads: more than any cloth pulls with.
constexpr btScalar kUnyielding = btScalar(1e6);

/// The product of the normals of fingers' surfaces that face each other [-]: round ones are far from parallel a few millimeters
/// beside the line where they touch.
constexpr btScalar kFacing = btScalar(-0.3);

/// [N] Of nodes between surfaces that do not press yet: they are held from both sides.
constexpr btScalar kLeastSqueeze = btScalar(1e-9);

bool is_kinematic(const btCollisionObject& object) {
  return object.isKinematicObject() || (link_of(&object) != nullptr && !MovableObject(&object));
}

bool may_pinch(const btCollisionObject& one, const btCollisionObject& other) {
  return &one != &other &&
         (is_jointed(&one) || is_jointed(&other) || (is_kinematic(one) && is_kinematic(other)));
}

/// [N] With which Bullet presses two objects on each other, 0 if they are only near; none if they are not, or pass through each
/// other, as neighboring links of a robot do.
std::optional<btScalar> force_between(const btCollisionObject* one, const btCollisionObject* other,
                                      btDispatcher* dispatcher, btScalar time_step) {
  std::optional<btScalar> impulse;
  const int num_manifolds = dispatcher != nullptr ? dispatcher->getNumManifolds() : 0;
  for (int m = 0; m < num_manifolds; ++m) {
    const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(m);
    const bool is_theirs = (manifold.getBody0() == one && manifold.getBody1() == other) ||
                           (manifold.getBody0() == other && manifold.getBody1() == one);
    if (!is_theirs) continue;
    if (!impulse) impulse = btScalar(0);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      *impulse += manifold.getContactPoint(p).getAppliedImpulse();
    }
  }
  return impulse ? std::optional(*impulse / time_step) : std::nullopt;
}

}  // namespace

Pinches::Pair& Pinches::pair_of(const btCollisionObject* one, const btCollisionObject* other) {
  const auto found = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    return (pair.first == one && pair.second == other) ||
           (pair.first == other && pair.second == one);
  });
  return found != pairs_.end() ? *found : pairs_.emplace_back(Pair{.first = one, .second = other});
}

void Pinches::find(std::span<const RigidContact> contacts, const btSoftBody& body,
                   btScalar time_step) {
  held_.clear();
  nodes_.clear();
  pairs_.clear();
  const btCollisionObject* known = nullptr;  // contacts come object by object
  const bool is_any = std::any_of(contacts.begin(), contacts.end(), [&](const RigidContact& one) {
    if (one.object == known) return false;
    known = one.object;
    return is_jointed(one.object) || is_kinematic(*one.object);
  });
  if (!is_any) return;
  held_.assign(contacts.size(), {});
  first_of_.assign(static_cast<std::size_t>(body.m_nodes.size()), -1);
  std::vector<std::pair<std::size_t, std::size_t>> found;
  std::vector<std::pair<std::size_t, std::size_t>> beside;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    int& first = first_of_[static_cast<std::size_t>(contacts[c].node)];
    if (first < 0) {
      first = static_cast<int>(c);
      continue;
    }
    const auto other = static_cast<std::size_t>(first);
    const RigidContact& a = contacts[other];
    const RigidContact& b = contacts[c];
    if (!may_pinch(*a.object, *b.object)) continue;
    const btScalar room = room_between(a, b, body);
    const bool is_on_joint = is_jointed(a.object) || is_jointed(b.object);
    const bool are_facing = is_on_joint ? btDot(a.normal, b.normal) <= kFacing : are_opposite(a, b);
    if (!are_facing || room > 0) {
      if (is_on_joint) beside.emplace_back(other, c);
      continue;
    }
    // Both surfaces bear their share of what nodes pull with: every other node.
    const bool by_first = a.node % 2 == 0;
    found.emplace_back(by_first ? other : c, by_first ? c : other);
    Pair& pair = pair_of(a.object, b.object);
    ++pair.num_nodes;
  }
  for (Pair& pair : pairs_) {
    const bool yields = MovableObject(pair.first) || MovableObject(pair.second);
    const std::optional<btScalar> force =
        yields ? force_between(pair.first, pair.second, body.m_worldInfo->m_dispatcher, time_step)
               : kUnyielding;
    pair.may_press = force.has_value();
    pair.force = force.value_or(btScalar(0));
  }
  for (const auto& [holding, replaced] : found) {
    const RigidContact& contact = contacts[holding];
    const RigidContact& other = contacts[replaced];
    const Pair& pair = pair_of(contact.object, other.object);
    if (!pair.may_press) continue;
    if (nodes_.empty()) nodes_.assign(static_cast<std::size_t>(body.m_nodes.size()), 0);
    nodes_[static_cast<std::size_t>(contact.node)] = 1;
    Held& held = held_[holding];
    held.is_holding = true;
    held.squeeze = kLeastSqueeze + pair.force / static_cast<btScalar>(pair.num_nodes);
    // Where both surfaces are as far away.
    const btVector3 across = contact.normal - other.normal;
    const btScalar length = across.length();
    held.normal = across / length;
    held.offset = (contact.offset - other.offset) / length;
    held.other_friction = other.object->getFriction();
    held_[replaced].is_replaced = true;
  }
  if (!nodes_.empty()) find_beside(contacts, body, beside);
}

void Pinches::find_beside(std::span<const RigidContact> contacts, const btSoftBody& body,
                          std::span<const std::pair<std::size_t, std::size_t>> of_nodes) {
  std::vector<char> is_next(nodes_.size(), 0);
  for (int f = 0; f < body.m_faces.size() && !of_nodes.empty(); ++f) {
    const auto& corners = body.m_faces[f].m_n;
    const auto number = [&](const btSoftBody::Node* node) {
      return static_cast<int>(node - &body.m_nodes[0]);
    };
    const bool is_any = std::any_of(std::begin(corners), std::end(corners),
                                    [&](const auto* node) { return has(number(node)); });
    for (const auto* const node : corners) {
      if (is_any) is_next[static_cast<std::size_t>(number(node))] = 1;
    }
  }
  for (const auto& [one, other] : of_nodes) {
    const bool may_press = pair_of(contacts[one].object, contacts[other].object).may_press;
    const bool is_beside = is_next[static_cast<std::size_t>(contacts[one].node)] != 0;
    held_[one].is_beside = held_[other].is_beside = may_press && is_beside;
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
