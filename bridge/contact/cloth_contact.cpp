#include <weft/bridge/contact/cloth_contact.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <weft/bridge/contact/surface/outward_faces.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using Node = btSoftBody::Node;
using Face = btSoftBody::Face;

/// A node beside a face by up to this share of it still counts as over it [-]: between two faces
/// that bend away from each other it would be over none.
constexpr btScalar kOverlap = btScalar(0.1);
/// A node that is beside a face by that overlap and nearer than the thickness lies within this share
/// of the thickness of the face's box [-]: the overlap is at most .4 of the thickness.
constexpr btScalar kReach = btScalar(1.1);
/// How fast layers that are closer than their thickness part, while they are pressed together [1/s].
constexpr btScalar kRecoveryRate = 5;
/// A node that begins a step behind the outside of a face by more than this share of the thickness is inside [-].
constexpr btScalar kBehind = btScalar(0.1);

btVector3 weighted_sum(const btVector3& weights, const btVector3& a, const btVector3& b,
                       const btVector3& c) {
  return weights.x() * a + weights.y() * b + weights.z() * c;
}

/// The barycentric weights of the point of a face below a node; none if the node is beside the face.
std::optional<btVector3> weights_below(const Face& face, const Node& node,
                                       const btVector3& normal) {
  const btVector3 &a = face.m_n[0]->m_x, &b = face.m_n[1]->m_x, &c = face.m_n[2]->m_x;
  const btScalar squared = normal.length2();
  btVector3 weights(btDot(btCross(c - b, node.m_x - b), normal),
                    btDot(btCross(a - c, node.m_x - c), normal),
                    btDot(btCross(b - a, node.m_x - a), normal));
  weights /= squared;
  if (weights[weights.minAxis()] < -kOverlap) return std::nullopt;
  weights.setMax(btVector3(0, 0, 0));
  return weights / (weights.x() + weights.y() + weights.z());
}

/// Bullet removes this share of the sliding at each of its iterations; together what Coulomb's law
/// allows for the normal correction.
btScalar friction_share(const btVector3& sliding, btScalar correction, const ContactRules& rules) {
  const btScalar distance = sliding.length();
  if (!(distance > 0)) return 0;
  const btScalar all = std::min(btScalar(1), rules.friction * correction / distance);
  return 1 - std::pow(1 - all, btScalar(1) / static_cast<btScalar>(rules.iterations));
}

/// Shares of a correction that move the node and, by their weights, the nodes of the face. False if
/// nothing can move.
bool share_out(const Node& node, const Face& face, btSoftBody::SContact& contact) {
  btScalar face_mobility = 0;
  for (int k = 0; k < 3; ++k) {
    if (face.m_n[k]->m_im <= 0) {
      face_mobility = 0;  // as Bullet: a face with a pinned corner stands still
      break;
    }
    face_mobility += contact.m_weights[k] * face.m_n[k]->m_im;
  }
  const btScalar sum = node.m_im + face_mobility * contact.m_weights.length2();
  if (!(sum > 0)) return false;
  contact.m_cfm[0] = node.m_im / sum;
  contact.m_cfm[1] = face_mobility / sum;
  return true;
}

/// The side of a face on which a node belongs.
enum class FaceSide {
  kOfStart,   ///< where it began the step
  kPositive,  ///< that of its normal
  kNegative
};

/// Returns whether the node began the step well behind the side on which it belongs.
bool try_contact(btSoftBody& body, Node& node, Face& face, const ContactRules& rules,
                 FaceSide side = FaceSide::kOfStart) {
  const Node &a = *face.m_n[0], &b = *face.m_n[1], &c = *face.m_n[2];
  const btVector3 normal = btCross(b.m_x - a.m_x, c.m_x - a.m_x);
  const btVector3 start_normal = btCross(b.m_q - a.m_q, c.m_q - a.m_q);
  if (!(normal.length2() > 0) || !(start_normal.length2() > 0)) return false;
  const std::optional<btVector3> weights = weights_below(face, node, normal);
  if (!weights) return false;
  const btVector3 point = weighted_sum(*weights, a.m_x, b.m_x, c.m_x);
  const btVector3 start_point = weighted_sum(*weights, a.m_q, b.m_q, c.m_q);
  // The side on which the step began: a node that would pass the face is held back.
  const btScalar start_height = btDot(node.m_q - start_point, start_normal.normalized());
  const bool is_negative =
      side == FaceSide::kOfStart ? start_height < 0 : side == FaceSide::kNegative;
  const btVector3 outward = normal.normalized() * (is_negative ? btScalar(-1) : btScalar(1));
  const btScalar start_gap = is_negative ? -start_height : start_height;
  const bool is_behind = start_gap < -kBehind * rules.thickness;
  const btScalar gap = btDot(node.m_x - point, outward);
  const btScalar recovery = std::min(btScalar(1), kRecoveryRate * rules.time_step);
  const btScalar wanted =
      std::min(rules.thickness, start_gap + recovery * (rules.thickness - start_gap));
  const btScalar target = start_gap < rules.thickness ? wanted : rules.thickness;
  if (gap >= target) return is_behind;
  btSoftBody::SContact contact;
  contact.m_node = &node;
  contact.m_face = &face;
  contact.m_weights = *weights;
  contact.m_normal = outward;
  contact.m_margin = target;
  if (!share_out(node, face, contact)) return is_behind;
  const btVector3 motion = (node.m_x - node.m_q) - (point - start_point);
  const btVector3 sliding = motion - outward * btDot(motion, outward);
  contact.m_friction = friction_share(sliding, target - gap, rules);
  body.m_scontacts.push_back(contact);
  return is_behind;
}

btVector3 mean_motion(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    sum += body.m_nodes[i].m_x - body.m_nodes[i].m_q;
  }
  return sum / static_cast<btScalar>(std::max(1, body.m_nodes.size()));
}

btScalar squared_distance(const btVector3& point, const Face& face) {
  const btVector3 from[] = {face.m_n[0]->m_x, face.m_n[1]->m_x, face.m_n[2]->m_x};
  const btVector3 normal = btCross(from[1] - from[0], from[2] - from[0]);
  btScalar best = SIMD_INFINITY;
  bool is_over = normal.length2() > 0;
  for (int k = 0; k < 3; ++k) {
    const btVector3 along = from[(k + 1) % 3] - from[k];
    const btVector3 to_point = point - from[k];
    is_over = is_over && btDot(btCross(along, to_point), normal) >= 0;
    const btScalar t =
        btClamped(btDot(to_point, along) / std::max(along.length2(), SIMD_EPSILON * SIMD_EPSILON),
                  btScalar(0), btScalar(1));
    best = std::min(best, (to_point - t * along).length2());
  }
  if (!is_over) return best;
  const btScalar height = btDot(point - from[0], normal.normalized());
  return height * height;
}

void check(const ClothContactSettings& settings) {
  const auto require = [](bool ok, const char* name, double value, const char* rest) {
    if (ok) return;
    throw InvalidArgument(std::string("cloth contact: ") + name + " = " + std::to_string(value) +
                          rest);
  };
  require(std::isfinite(settings.self_thickness) && settings.self_thickness > 0, "self_thickness",
          settings.self_thickness, " [m], expected > 0 and finite");
  require(std::isfinite(settings.margin) && settings.margin > 0, "margin", settings.margin,
          " [m], expected > 0 and finite");
  require(std::isfinite(settings.friction) && settings.friction >= 0, "friction", settings.friction,
          " [1], expected >= 0 and finite");
}

}  // namespace

ClothContact::ClothContact(const btSoftBody& body, const ClothContactSettings& settings)
    : settings_(settings), outward_(outward_faces(body)) {
  check(settings);
  if (settings.with_itself) note_near(body);
}

void ClothContact::note_near(const btSoftBody& body) {
  const auto thickness = static_cast<btScalar>(settings_.self_thickness);
  windows_.forget();
  look(body);
  refit_tree(body);
  note_leaves(body);
  flat_.find_neighbors(body, tree_, thickness);
  flat_.refit(body, tree_);
  if (loose_nodes_.empty()) windows_.find(body);
  near_at_rest_.assign(static_cast<std::size_t>(body.m_nodes.size()), {});
  num_near_faces_ = body.m_faces.size();
  for_candidates(body, thickness, *this, [&](int i, std::span<const int> slots) {
    for (const int slot : slots) {
      const btScalar squared =
          squared_distance(body.m_nodes[i].m_x, body.m_faces[tree_.face(slot)]);
      if (squared > thickness * thickness) continue;
      near_at_rest_[static_cast<std::size_t>(i)].push_back(slot);
    }
  });
}

void ClothContact::note_leaves(const btSoftBody& body) {
  nodes_of_leaf_.assign(tree_.num_leaves(), {});
  std::vector<char> is_known(static_cast<std::size_t>(body.m_nodes.size()), 0);
  for (std::size_t leaf = 0; leaf < nodes_of_leaf_.size(); ++leaf) {
    for (const int f : tree_.faces_of_leaf(leaf)) {
      for (const Node* const node : body.m_faces[f].m_n) {
        const auto number = static_cast<std::size_t>(node - &body.m_nodes[0]);
        if (std::exchange(is_known[number], 1) == 0)
          nodes_of_leaf_[leaf].push_back(static_cast<int>(number));
      }
    }
    std::sort(nodes_of_leaf_[leaf].begin(), nodes_of_leaf_[leaf].end());
  }
  loose_nodes_.clear();
  for (std::size_t i = 0; i < is_known.size(); ++i) {
    if (is_known[i] == 0) loose_nodes_.push_back(static_cast<int>(i));
  }
}

/// use(node, slots of faces that it may meet) for all nodes, in the order of their groups.
template <class Use>
void ClothContact::for_candidates(const btSoftBody& body, btScalar reach, const ClothContact& faces,
                                  const Use& use) {
  const auto box_of = [&](int i) {
    return MotionBox::of(body.m_nodes[i], faces.motion_).grown(reach);
  };
  if (groups_.num_nodes() != body.m_nodes.size())
    groups_.arrange(body);  // at first, and after a tear
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    MotionBox all = MotionBox::nowhere();
    for (const int i : groups_[g]) all.include(box_of(i));
    faces.tree_.find(all, nearby_);
    if (nearby_.leaves.empty()) continue;
    for (const int i : groups_[g]) use(i, faces.tree_.collect(box_of(i), nearby_));
  }
}

void ClothContact::look_if_moved(const btSoftBody& body) {
  bool is_seen = is_of_this_step_ && seen_.size() == static_cast<std::size_t>(body.m_nodes.size());
  for (int i = 0; is_seen && i < body.m_nodes.size(); ++i) {
    const auto& [start, end] = seen_[static_cast<std::size_t>(i)];
    is_seen = body.m_nodes[i].m_x == end && body.m_nodes[i].m_q == start;
  }
  if (!is_seen) look(body);
}

void ClothContact::look(const btSoftBody& body) {
  const auto num_faces = static_cast<std::size_t>(body.m_faces.size());
  if (!outward_.empty() && outward_.size() != num_faces) outward_ = outward_faces(body);
  motion_ = mean_motion(body);
  seen_.resize(static_cast<std::size_t>(body.m_nodes.size()));
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const Node& node = body.m_nodes[static_cast<int>(i)];
    seen_[i] = {node.m_q, node.m_x};
  }
  windows_.refit(seen_, motion_, kReach * static_cast<btScalar>(settings_.self_thickness));
  is_tree_fitted_ = false;
  is_known_apart_ = false;
  is_of_this_step_ = true;
}

// Most cloth is known to be apart from itself without its tree.
void ClothContact::refit_tree(const btSoftBody& body) {
  if (std::exchange(is_tree_fitted_, true)) return;
  tree_.refit(body, motion_);
  flat_.refit(body, tree_);
  marks_.assign(tree_.num_leaves(), 0);
  for (std::size_t leaf = 0; leaf < marks_.size(); ++leaf) {
    const std::span<const int> faces = tree_.faces_of_leaf(leaf);
    const bool is_apart = std::all_of(faces.begin(), faces.end(),
                                      [this](int face) { return windows_.is_apart(face); });
    if (is_apart) marks_[leaf] = kApart;
  }
}

// What was near the whole node at rest is near both of its halves.
void ClothContact::add_copies(const btSoftBody& body, const std::vector<int>& origins) {
  outward_ = outward_faces(body);
  flat_.forget();
  windows_.forget();
  nodes_of_leaf_.clear();
  if (!settings_.with_itself) return;
  for (const int origin : origins) {
    near_at_rest_.push_back(std::vector<int>(near_at_rest_.at(static_cast<std::size_t>(origin))));
  }
}

void ClothContact::add_self_contacts(btSoftBody& body, btScalar time_step) {
  if (!settings_.with_itself) return;
  const ContactRules rules{static_cast<btScalar>(settings_.self_thickness),
                           static_cast<btScalar>(settings_.friction * settings_.friction),
                           time_step, body.m_cfg.piterations};
  // Bullet has cut or refined the body: what is near now counts as near at rest.
  const bool is_another = near_at_rest_.size() != static_cast<std::size_t>(body.m_nodes.size()) ||
                          num_near_faces_ != body.m_faces.size();
  if (is_another) note_near(body);
  look_if_moved(body);
  is_known_apart_ = is_known_apart_ || windows_.are_all_apart();
  if (is_known_apart_) return;
  refit_tree(body);
  const int num_before = body.m_scontacts.size();
  if (nodes_of_leaf_.size() != tree_.num_leaves()) note_leaves(body);  // it has torn
  const auto box_of = [&](int i) {
    return MotionBox::of(body.m_nodes[i], motion_).grown(kReach * rules.thickness);
  };
  for (std::size_t leaf = 0; leaf < tree_.num_leaves(); ++leaf) {
    if (marks_[leaf] == kApart) continue;
    MotionBox all = MotionBox::nowhere();
    for (const int i : nodes_of_leaf_[leaf]) all.include(box_of(i));
    flat_.mark(leaf, marks_);
    tree_.find(all, nearby_, marks_);
    flat_.unmark(leaf, marks_);
    if (nearby_.leaves.empty()) continue;
    for (const int i : nodes_of_leaf_[leaf])
      add_self_contacts(body, i, tree_.collect(box_of(i), nearby_), rules);
  }
  for (const int i : loose_nodes_) {
    tree_.find(box_of(i), nearby_);
    add_self_contacts(body, i, tree_.collect(box_of(i), nearby_), rules);
  }
  is_known_apart_ = body.m_scontacts.size() == num_before;
}

void ClothContact::add_self_contacts(btSoftBody& body, int node, std::span<const int> slots,
                                     const ContactRules& rules) const {
  const std::vector<int>& near = near_at_rest_[static_cast<std::size_t>(node)];
  auto next = near.begin();  // both lists ascend
  for (const int slot : slots) {
    while (next != near.end() && *next < slot) ++next;
    if (next != near.end() && *next == slot) continue;
    if (!tree_.may_be_over(slot, body.m_nodes[node].m_x, kOverlap)) continue;
    (void)try_contact(body, body.m_nodes[node], body.m_faces[tree_.face(slot)], rules);
  }
}

ClothContact::Faces ClothContact::faces(const btSoftBody& body) {
  look_if_moved(body);
  refit_tree(body);
  return {tree_, flat_, marks_, motion_};
}

bool ClothContact::is_apart_from_itself(const btSoftBody& body) {
  look_if_moved(body);
  return windows_.are_all_apart();
}

// The height of a point over the plane of a face of the body [m], negative on the inside.
btScalar ClothContact::height_over(const btVector3& point, const btSoftBody& body, int face) const {
  const auto& n = body.m_faces[face].m_n;
  const btVector3 normal = btCross(n[1]->m_x - n[0]->m_x, n[2]->m_x - n[0]->m_x);
  const btScalar size = normal.length();
  if (!(size > 0)) return 0;
  const auto sign = btScalar(outward_[static_cast<std::size_t>(face)]);
  return sign * btDot(point - n[0]->m_x, normal) / size;
}

// If several are as near, because an edge or a corner is, the one whose plane is farthest from the node says on which side of the
// surface the node is.
int ClothContact::nearest_face(const btVector3& point, const btSoftBody& body,
                               std::span<const int> slots) const {
  constexpr btScalar kSame = btScalar(1e-4);  // of a squared distance [-]
  int nearest = -1;
  btScalar least = SIMD_INFINITY;
  btScalar height_of_nearest = 0;
  for (const int slot : slots) {
    const int face = tree_.face(slot);
    const btScalar squared = squared_distance(point, body.m_faces[face]);
    if (squared > least * (1 + kSame)) continue;
    const btScalar height = btFabs(height_over(point, body, face));
    if (squared >= least * (1 - kSame) && height <= height_of_nearest) continue;
    nearest = face;
    least = squared;
    height_of_nearest = height;
  }
  return nearest;
}

// Faces that enclose a volume have an outside. A node that comes over an edge was behind the plane of the face that it comes to,
// and one that has got in must come out again: where the step began says nothing of either.
bool ClothContact::add_contacts_outside(btSoftBody& body, Node& node, btSoftBody& other,
                                        std::span<const int> slots,
                                        const ContactRules& rules) const {
  const int nearest = nearest_face(node.m_x, other, slots);
  if (nearest < 0) return false;
  const auto add = [&](int face) {
    const bool is_out = outward_[static_cast<std::size_t>(face)] > 0;
    return try_contact(body, node, other.m_faces[face], rules,
                       is_out ? FaceSide::kPositive : FaceSide::kNegative);
  };
  if (height_over(node.m_x, other, nearest) < 0) return add(nearest);
  bool is_behind = false;
  for (const int slot : slots) {
    const int face = tree_.face(slot);
    if (!tree_.may_be_over(slot, node.m_x, kOverlap)) continue;
    if (height_over(node.m_x, other, face) >= 0) is_behind = add(face) || is_behind;
  }
  return is_behind;
}

bool ClothContact::add_contacts(btSoftBody& body, btSoftBody& other, ClothContact& other_contact,
                                btScalar time_step) {
  const ClothContactSettings& theirs = other_contact.settings_;
  const ContactRules rules{static_cast<btScalar>(settings_.margin + theirs.margin),
                           static_cast<btScalar>(settings_.friction * theirs.friction), time_step,
                           body.m_cfg.piterations};
  other_contact.look_if_moved(other);
  other_contact.refit_tree(other);
  bool is_inside = false;
  for_candidates(
      body, kReach * rules.thickness, other_contact, [&](int i, std::span<const int> slots) {
        if (!other_contact.outward_.empty()) {
          const bool is_behind =
              other_contact.add_contacts_outside(body, body.m_nodes[i], other, slots, rules);
          is_inside = is_inside || is_behind;
          return;
        }
        for (const int slot : slots) {
          if (!other_contact.tree_.may_be_over(slot, body.m_nodes[i].m_x, kOverlap)) {
            continue;
          }
          btSoftBody::Face& face = other.m_faces[other_contact.tree_.face(slot)];
          (void)try_contact(body, body.m_nodes[i], face, rules);
        }
      });
  return is_inside;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
