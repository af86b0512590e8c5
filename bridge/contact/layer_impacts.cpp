#include <weft/bridge/contact/layer_impacts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/parallel/parallel_for.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// The share of the distance at the start, or of the thickness if that is less, that parts keep on their way [-], and the share
/// beyond it that an impulse gives them.
constexpr double kNearestPart = 0.2;
constexpr double kBeyond = 0.1;
/// Rounds of impulses, sweeps over the impacts of a round, and rounds in which zones grow.
constexpr int kImpulseRounds = 6;
constexpr int kSweeps = 8;
constexpr int kZoneRounds = 30;
/// Leaves of a tree that one search looks at.
constexpr std::size_t kLeavesTogether = 16;
/// Faces that may be near one in a mean over some faces, and distances of parts that may be asked for of each: several times what
/// crumpled cloth has. Cloth that explodes has all of it near all of it.
constexpr std::int64_t kMostNear = 300;
constexpr std::int64_t kDistancesOfEach = 10;
/// Each face of the other layer may be near so many besides: it may be much finer.
constexpr std::int64_t kMostNearOfOther = 8;
/// An impulse that acts on nodes that are nearly all pinned would throw the others far away: the least share of what is free [-].
constexpr double kLeastFree = 0.05;
/// Rounding moves nodes by less than so many units in the last place of the farthest from the world's origin.
constexpr double kRoundings = 8;

std::array<int, 2> sorted(int a, int b) {
  return a < b ? std::array<int, 2>{a, b} : std::array<int, 2>{b, a};
}

template <std::size_t kCount>
MotionBox around(const std::array<int, kCount>& nodes, const std::vector<MotionBox>& boxes) {
  MotionBox all = boxes[static_cast<std::size_t>(nodes[0])];
  for (std::size_t k = 1; k < kCount; ++k) all.include(boxes[static_cast<std::size_t>(nodes[k])]);
  return all;
}

template <std::size_t kCount>
bool has(const std::array<int, kCount>& nodes, int node) {
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

/// Whether a direction parts what moves by more than a distance all the time: most pairs are apart along the line through their
/// centers.
bool are_apart(PairKind kind, const FourPoints& from, const FourPoints& way, double distance) {
  const bool is_point = kind == PairKind::kPointTriangle;
  const Eigen::Vector4d weights = is_point ? Eigen::Vector4d(1, -1.0 / 3, -1.0 / 3, -1.0 / 3)
                                           : Eigen::Vector4d(0.5, 0.5, -0.5, -0.5);
  const Vector3<double> axis = from * weights;
  const Eigen::RowVector4d start = axis.transpose() * from;
  const Eigen::RowVector4d end = start + axis.transpose() * way;
  const int split = is_point ? 1 : 2;
  const double lowest = std::min(start.head(split).minCoeff(), end.head(split).minCoeff());
  const double highest = std::max(start.tail(4 - split).maxCoeff(), end.tail(4 - split).maxCoeff());
  const double gap = lowest - highest;
  return gap > 0 && gap * gap > distance * distance * axis.squaredNorm();
}

/// Numbers of layers by what they meet, directly or by way of others.
std::vector<std::vector<std::size_t>> groups_of(
    std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  std::vector<std::size_t> group_of(count);
  std::iota(group_of.begin(), group_of.end(), 0);
  for (const auto& [one, other] : pairs) {
    const auto [low, high] = std::minmax({group_of[one], group_of[other]});
    std::replace(group_of.begin(), group_of.end(), high, low);
  }
  std::vector<std::vector<std::size_t>> groups(count);
  for (std::size_t l = 0; l < count; ++l) groups[group_of[l]].push_back(l);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

}  // namespace

// It is found anew where a body has torn, or where that number was another body's.
void LayerImpacts::find_surface(std::size_t layer) {
  const btSoftBody& body = *layers_[layer].body;
  Surface& surface = surfaces_[layer];
  std::vector<std::array<int, 3>> faces(static_cast<std::size_t>(body.m_faces.size()));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      faces[f][k] = static_cast<int>(body.m_faces[static_cast<int>(f)].m_n[k] - &body.m_nodes[0]);
  }
  if (surface.faces == faces) return;
  surface = {};
  surface.faces = std::move(faces);
  surface.nodes_of_face.resize(surface.faces.size());
  surface.edges_of_face.resize(surface.faces.size());
  std::vector<char> is_known(static_cast<std::size_t>(body.m_nodes.size()), 0);
  std::set<std::array<int, 2>> edges;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int node = surface.faces[f][k];
      if (std::exchange(is_known[static_cast<std::size_t>(node)], 1) == 0)
        surface.nodes_of_face[f].push_back(node);
      const auto edge = sorted(node, surface.faces[f][(k + 1) % 3]);
      if (!edges.insert(edge).second) continue;
      surface.edges_of_face[f].push_back(static_cast<int>(surface.edges.size()));
      surface.edges.push_back(edge);
    }
  }
}

void LayerImpacts::read_nodes() {
  first_nodes_.assign(1, 0);
  for (const Layer& layer : layers_)
    first_nodes_.push_back(first_nodes_.back() + layer.body->m_nodes.size());
  const int count = first_nodes_.back();
  starts_.resize(3, count);
  ends_.resize(3, count);
  inverse_masses_.resize(count);
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const btSoftBody& body = *layers_[l].body;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      const btSoftBody::Node& node = body.m_nodes[i];
      starts_.col(first_nodes_[l] + i) = from_bullet<double>(node.m_q);
      ends_.col(first_nodes_[l] + i) = from_bullet<double>(node.m_x);
      inverse_masses_[first_nodes_[l] + i] = static_cast<double>(node.m_im);
    }
  }
  is_moved_.assign(static_cast<std::size_t>(count), 1);  // all are looked at first
}

// If not, a body has exploded, and others will find that out.
bool LayerImpacts::is_finite(const Group& group) const {
  return std::all_of(group.begin(), group.end(), [this](std::size_t l) {
    const int first = first_nodes_[l];
    const int count = first_nodes_[l + 1] - first;
    return starts_.middleCols(first, count).allFinite() &&
           ends_.middleCols(first, count).allFinite();
  });
}

void LayerImpacts::write_nodes(const Group& group) {
  for (const std::size_t l : group) {
    btSoftBody& body = *layers_[l].body;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      const int node = first_nodes_[l] + i;
      if (is_moved_[static_cast<std::size_t>(node)] != 0)
        body.m_nodes[i].m_x = to_bullet(ends_.col(node).eval());
    }
  }
}

std::vector<LayerImpacts::Outcome> LayerImpacts::resolve() {
  if (surfaces_.size() < layers_.size()) surfaces_.resize(layers_.size());
  for (std::size_t l = 0; l < layers_.size(); ++l) find_surface(l);
  read_nodes();
  faces_.clear();
  for (const Layer& layer : layers_) faces_.push_back(layer.contact->faces(*layer.body));
  std::vector<Outcome> outcomes(layers_.size());
  for (const Group& group : groups_of(layers_.size(), pairs_)) {
    const Outcome outcome = resolve(group);
    for (const std::size_t l : group) outcomes[l] = outcome;
  }
  return outcomes;
}

LayerImpacts::Outcome LayerImpacts::resolve(const Group& group) {
  Outcome outcome{.is_clear = is_finite(group)};
  zones_.clear();
  while (outcome.is_clear) {
    outcome.is_clear = find_impacts(group);
    if (impacts_.empty() || !outcome.is_clear) break;
    outcome.num_impacts += static_cast<int>(impacts_.size());
    outcome.is_clear = outcome.num_rounds < kImpulseRounds + kZoneRounds;
    if (!outcome.is_clear) break;
    std::fill(is_moved_.begin(), is_moved_.end(), 0);
    for (const Impact& impact : impacts_) {  // also where no impulse was needed: it may take a zone
      for (const int node : impact.nodes) is_moved_[static_cast<std::size_t>(node)] = 1;
    }
    if (outcome.num_rounds < kImpulseRounds) {
      apply_impulses();
    } else {
      move_zones_together();
    }
    write_nodes(group);
    ++outcome.num_rounds;
  }
  std::fill(is_moved_.begin(), is_moved_.end(), 1);  // for the next group
  return outcome;
}

void LayerImpacts::find_boxes(std::size_t layer) {
  const btSoftBody& body = *layers_[layer].body;
  Surface& surface = surfaces_[layer];
  surface.boxes.resize(static_cast<std::size_t>(body.m_nodes.size()));
  for (std::size_t i = 0; i < surface.boxes.size(); ++i)
    surface.boxes[i] = MotionBox::of(body.m_nodes[static_cast<int>(i)], faces_[layer].motion);
  surface.is_changed.resize(surface.faces.size());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto& face = surface.faces[f];
    surface.is_changed[f] = static_cast<char>(std::any_of(face.begin(), face.end(), [&](int node) {
      const int number = first_nodes_[layer] + node;
      return is_moved_[static_cast<std::size_t>(number)] != 0;
    }));
  }
}

void LayerImpacts::list_searches(const Group& group) {
  searches_.clear();
  for (const auto& [one, other] : pairs_) {
    if (std::find(group.begin(), group.end(), one) == group.end()) continue;
    const std::size_t count = faces_[one].tree.num_leaves();
    for (std::size_t leaf = 0; leaf < count; leaf += kLeavesTogether)
      searches_.push_back({one, other, leaf, std::min(count, leaf + kLeavesTogether)});
  }
  if (found_.size() < searches_.size()) found_.resize(searches_.size());
}

bool LayerImpacts::find_impacts(const Group& group) {
  parallel_for(group.size(), [&](std::size_t g) {
    const std::size_t l = group[g];
    faces_[l].motion = layers_[l].contact->faces(*layers_[l].body).motion;
    find_boxes(l);
  });
  list_searches(group);
  parallel_for(searches_.size(), [&](std::size_t s) {
    found_[s].impacts.clear();
    found_[s].is_too_much = false;
    search(searches_[s], found_[s]);
  });
  impacts_.clear();
  bool is_all = true;
  for (std::size_t s = 0; s < searches_.size(); ++s) {
    impacts_.insert(impacts_.end(), found_[s].impacts.begin(), found_[s].impacts.end());
    is_all = is_all && !found_[s].is_too_much;
  }
  // Not in the order of the trees, which are older than the step.
  std::sort(impacts_.begin(), impacts_.end(), [](const Impact& a, const Impact& b) {
    return std::tie(a.nodes, a.kind) < std::tie(b.nodes, b.kind);
  });
  return is_all;
}

/// The nodes and edges of two faces that are near each other.
class LayerImpacts::FacePair {
 public:
  FacePair(const LayerImpacts& impacts, const Search& search, Found& found)
      : impacts_(impacts),
        mine_(impacts.surfaces_[search.one]),
        theirs_(impacts.surfaces_[search.other]),
        my_first_(impacts.first_nodes_[search.one]),
        their_first_(impacts.first_nodes_[search.other]),
        is_self_(search.one == search.other),
        found_(found) {
    const ClothContactSettings& one = impacts.layers_[search.one].contact->settings();
    const ClothContactSettings& other = impacts.layers_[search.other].contact->settings();
    thickness_ = is_self_ ? one.self_thickness : one.margin + other.margin;
    reach_ = static_cast<btScalar>(kNearestPart * thickness_);
  }
  [[nodiscard]] btScalar reach() const { return reach_; }

  void look(int f, int g) const {
    const auto& face = mine_.faces[static_cast<std::size_t>(f)];
    const auto& their_face = theirs_.faces[static_cast<std::size_t>(g)];
    const MotionBox around_theirs = around(their_face, theirs_.boxes).grown(reach_);
    for (const int node : mine_.nodes_of_face[static_cast<std::size_t>(f)]) {
      const bool is_near = meet(found_.boxes[static_cast<std::size_t>(node)], around_theirs);
      if (is_near && !(is_self_ && has(their_face, node)))
        try_node(my_first_ + node, their_first_, their_face);
    }
    for (const int e : mine_.edges_of_face[static_cast<std::size_t>(f)]) look_at_edge(e, g);
    if (is_self_) return;  // the other way round it is another pair
    const MotionBox around_mine = around(face, found_.boxes).grown(reach_);
    for (const int node : theirs_.nodes_of_face[static_cast<std::size_t>(g)]) {
      if (meet(theirs_.boxes[static_cast<std::size_t>(node)], around_mine))
        try_node(their_first_ + node, my_first_, face);
    }
  }

 private:
  void try_node(int node, int first, const std::array<int, 3>& face) const {
    impacts_.try_pair(PairKind::kPointTriangle,
                      {node, first + face[0], first + face[1], first + face[2]}, thickness_,
                      found_);
  }
  void look_at_edge(int e, int g) const {
    const std::array<int, 2>& edge = mine_.edges[static_cast<std::size_t>(e)];
    const MotionBox box = around(edge, found_.boxes).grown(reach_);
    for (const int n : theirs_.edges_of_face[static_cast<std::size_t>(g)]) {
      const std::array<int, 2>& other = theirs_.edges[static_cast<std::size_t>(n)];
      if (is_self_ && (n <= e || has(other, edge[0]) || has(other, edge[1]))) continue;
      if (!meet(box, around(other, theirs_.boxes))) continue;
      impacts_.try_pair(PairKind::kEdges,
                        {my_first_ + edge[0], my_first_ + edge[1], their_first_ + other[0],
                         their_first_ + other[1]},
                        thickness_, found_);
    }
  }

  const LayerImpacts& impacts_;
  const Surface& mine_;
  const Surface& theirs_;
  int my_first_, their_first_;
  bool is_self_;
  Found& found_;
  double thickness_ = 0;  ///< [m]
  btScalar reach_ = 0;    ///< [m]
};

void LayerImpacts::search(const Search& what, Found& found) const {
  const Surface& mine = surfaces_[what.one];
  const Surface& theirs = surfaces_[what.other];
  const FaceTree& my_tree = faces_[what.one].tree;
  const FaceTree& their_tree = faces_[what.other].tree;
  const FacePair pair(*this, what, found);
  const bool is_self = what.one == what.other;
  // The other's motion is taken away from both.
  const btSoftBody& body = *layers_[what.one].body;
  found.boxes.resize(mine.boxes.size());
  found.marks = is_self ? faces_[what.one].marks : std::vector<char>();
  std::int64_t num_near = 0;
  const std::int64_t of_other = is_self ? 0 : kMostNearOfOther * std::ssize(theirs.faces);
  std::int64_t num_faces = FaceTree::kWidth;
  found.num_distances = 0;
  for (std::size_t leaf = what.first_leaf; leaf < what.last_leaf; ++leaf) {
    if (is_self && found.marks[leaf] == ClothContact::kApart) continue;
    MotionBox all = MotionBox::nowhere();
    for (const int f : my_tree.faces_of_leaf(leaf)) {
      for (const int node : mine.faces[static_cast<std::size_t>(f)]) {
        MotionBox& box = found.boxes[static_cast<std::size_t>(node)];
        box = is_self ? mine.boxes[static_cast<std::size_t>(node)]
                      : MotionBox::of(body.m_nodes[node], faces_[what.other].motion);
        all.include(box);
      }
    }
    if (is_self) faces_[what.one].flat.mark(leaf, found.marks);
    their_tree.find(all.grown(pair.reach()), found.nearby, found.marks);
    if (is_self) faces_[what.one].flat.unmark(leaf, found.marks);
    if (found.nearby.leaves.empty()) continue;
    for (const int f : my_tree.faces_of_leaf(leaf)) {
      const auto& face = mine.faces[static_cast<std::size_t>(f)];
      const bool is_changed = mine.is_changed[static_cast<std::size_t>(f)] != 0;
      const MotionBox box = around(face, found.boxes).grown(pair.reach());
      const std::span<const int> slots = their_tree.collect(box, found.nearby);
      num_near += std::ssize(slots);
      for (const int slot : slots) {
        const int g = their_tree.face(slot);
        const bool is_known = !is_changed && theirs.is_changed[static_cast<std::size_t>(g)] == 0;
        if (!is_known && !(is_self && f == g)) pair.look(f, g);
      }
      const std::int64_t most = kMostNear * num_faces + of_other;
      found.is_too_much = num_near > most || found.num_distances > kDistancesOfEach * most;
      if (found.is_too_much) return;
      ++num_faces;
    }
  }
}

void LayerImpacts::try_pair(PairKind kind, const std::array<int, 4>& nodes, double thickness,
                            Found& found) const {
  FourPoints from;
  FourPoints way;
  double mobility = 0;
  double farthest = 0;
  for (int k = 0; k < 4; ++k) {
    const int node = nodes[static_cast<std::size_t>(k)];
    farthest = std::max(farthest, ends_.col(node).cwiseAbs().maxCoeff());
    from.col(k) = starts_.col(node) - starts_.col(nodes[0]);
    way.col(k) = ends_.col(node) - starts_.col(node);
    mobility += inverse_masses_[node];
  }
  if (!(mobility > 0)) return;
  way.colwise() -= way.rowwise().mean().eval();
  if (are_apart(kind, from, way, kNearestPart * thickness)) return;
  const Nearest before = nearest(kind, from);
  const double at_start = before.distance();
  if (!(at_start > 0)) return;  // no side to keep to
  constexpr double kUnit = std::numeric_limits<btScalar>::epsilon();
  const double closest = std::max(kNearestPart * std::min(at_start, thickness),
                                  std::min(at_start / 2, kRoundings * kUnit * farthest));
  const auto hit = first_approach(kind, from, way, closest, &found.num_distances);
  if (!hit) return;
  Nearest place = nearest(kind, from + *hit * way);
  if (!(place.distance() > 0)) place = before;
  double free = 0;
  for (std::size_t k = 0; k < 4; ++k)
    free += std::abs(place.weights[k]) * inverse_masses_[nodes[k]];
  if (!(free > 0)) return;  // it is all on pins
  found.impacts.push_back(
      {kind, nodes, place.weights, place.separation / place.distance(), (1 + kBeyond) * closest});
}

// To where Bullet can have it.
void LayerImpacts::move(int node, const Vector3<double>& end) {
  ends_.col(node) = end.cast<btScalar>().cast<double>();
  is_moved_[static_cast<std::size_t>(node)] = 1;
}

// Gauss-Seidel over the impacts of this round, whose impulses only push.
void LayerImpacts::apply_impulses() {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Impact& impact : impacts_) {
      double gap = -impact.least;
      double mobility = 0;
      double most = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const double weight = impact.weights[k];
        gap += weight * impact.normal.dot(ends_.col(impact.nodes[k]));
        mobility += weight * weight * inverse_masses_[impact.nodes[k]];
        most = std::max(most, inverse_masses_[impact.nodes[k]]);
      }
      if (!(mobility > kLeastFree * most)) continue;  // a zone is left to settle it
      const double impulse = std::max(0.0, impact.impulse - gap / mobility);
      const double change = impulse - impact.impulse;
      impact.impulse = impulse;
      for (std::size_t k = 0; k < 4 && change != 0; ++k) {
        const int node = impact.nodes[k];
        const double by = change * impact.weights[k] * inverse_masses_[node];
        if (by != 0) move(node, ends_.col(node) + by * impact.normal);
      }
    }
  }
}

int LayerImpacts::zone_of(int node) const {
  while (zones_[static_cast<std::size_t>(node)] != node)
    node = zones_[static_cast<std::size_t>(node)];
  return node;
}

// The nodes of impacts that share one are a zone. What it meets in the next round joins it.
void LayerImpacts::move_zones_together() {
  if (zones_.empty()) {
    zones_.resize(static_cast<std::size_t>(starts_.cols()));
    std::iota(zones_.begin(), zones_.end(), 0);
  }
  for (const Impact& impact : impacts_) {
    int zone = zone_of(impact.nodes[0]);
    for (const int node : impact.nodes) {
      const auto [low, high] = std::minmax({zone, zone_of(node)});
      zones_[static_cast<std::size_t>(high)] = low;
      zone = low;
    }
  }
  std::map<int, std::vector<int>> members;
  for (int i = 0; i < static_cast<int>(zones_.size()); ++i) {
    const int zone = zone_of(i);
    zones_[static_cast<std::size_t>(i)] = zone;
    if (zone == i) continue;
    std::vector<int>& nodes = members[zone];
    if (nodes.empty()) nodes.push_back(zone);
    nodes.push_back(i);
  }
  for (const auto& [zone, nodes] : members) move_together(nodes);
}

// As their momentum leads them, or their pins.
void LayerImpacts::move_together(const std::vector<int>& nodes) {
  Vector3<double> momentum = Vector3<double>::Zero();
  Vector3<double> of_pins = Vector3<double>::Zero();
  double mass = 0;
  int num_pins = 0;
  for (const int node : nodes) {
    const Vector3<double> way = ends_.col(node) - starts_.col(node);
    if (inverse_masses_[node] > 0) {
      momentum += way / inverse_masses_[node];
      mass += 1 / inverse_masses_[node];
    } else {
      of_pins += way;
      ++num_pins;
    }
  }
  const Vector3<double> way = num_pins > 0 ? (of_pins / num_pins).eval() : (momentum / mass).eval();
  for (const int node : nodes) {
    if (inverse_masses_[node] > 0) move(node, starts_.col(node) + way);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
