#include <weft/bridge/contact/known_contacts.hpp>

#include <cmath>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Planes whose normals have this cosine at least are alike: 8 degrees.
constexpr btScalar kAlike = btScalar(0.99);

}  // namespace

void KnownContacts::list(const std::vector<RigidContact>& contacts, int num_nodes) {
  last_of_node_.assign(static_cast<std::size_t>(num_nodes), -1);
  one_before_.resize(contacts.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    int& last = last_of_node_[static_cast<std::size_t>(contacts[c].node)];
    one_before_[c] = last;
    last = static_cast<int>(c);
  }
}

RigidContact* KnownContacts::find(const RigidContact& found, const btVector3& position,
                                  btScalar margin, std::vector<RigidContact>& contacts) const {
  const btScalar gap = btDot(found.normal, position) - found.offset;
  for (int c = last_of_node_[static_cast<std::size_t>(found.node)]; c >= 0;
       c = one_before_[static_cast<std::size_t>(c)]) {
    RigidContact& known = contacts[static_cast<std::size_t>(c)];
    if (known.collider != found.collider) continue;
    if (known.triangle == found.triangle) return &known;
    const btScalar known_gap = btDot(known.normal, position) - known.offset;
    const bool is_same_plane = std::abs(gap - known_gap) <= kPlaneShare * margin &&
                               btDot(found.normal, known.normal) > kAlike;
    if (is_same_plane) return &known;
  }
  return nullptr;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
