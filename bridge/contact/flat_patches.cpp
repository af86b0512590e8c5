#include <weft/bridge/contact/flat_patches.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include <weft/bridge/bullet/bullet_vector.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Half the angle of the cone [rad]: places are at most a tenth farther apart on the surface than straight.
constexpr btScalar kHalfAngle = btScalar(0.44);
/// Edges of the boundary that follow each other are looked at so far.
constexpr int kFollowing = 8;
/// A boundary that has come less far than this share of its length turns back [-].
constexpr btScalar kStraight = btScalar(0.5);

using Edge = std::array<int, 2>;

int number_of(const btSoftBody::Node* node, const btSoftBody& body) {
  return static_cast<int>(node - &body.m_nodes[0]);
}

std::array<Edge, 3> edges_of(const btSoftBody& body, int f) {
  std::array<Edge, 3> edges;
  for (std::size_t k = 0; k < 3; ++k) {
    const int a = number_of(body.m_faces[f].m_n[k], body);
    const int b = number_of(body.m_faces[f].m_n[(k + 1) % 3], body);
    edges[k] = {std::min(a, b), std::max(a, b)};
  }
  return edges;
}

/// Whether all of these faces are joined by what parts_of(face) has of each.
template <class PartsOf>
bool is_one_piece(std::span<const int> faces, const PartsOf& parts_of) {
  std::vector<int> left(faces.begin(), faces.end());
  std::set<typename decltype(parts_of(0))::value_type> reached;
  while (!left.empty()) {
    const auto next = std::find_if(left.begin(), left.end(), [&](int f) {
      const auto parts = parts_of(f);
      return left.size() == faces.size() ||
             std::any_of(parts.begin(), parts.end(),
                         [&](const auto& part) { return reached.contains(part); });
    });
    if (next == left.end()) return false;
    for (const auto& part : parts_of(*next)) reached.insert(part);
    left.erase(next);
  }
  return true;
}

/// The edges of one face only, each with that face's leaf.
class Boundary {
 public:
  Boundary(const btSoftBody& body, const FaceTree& tree) : body_(body) {
    std::map<Edge, int> faces_at;
    for (std::size_t leaf = 0; leaf < tree.num_leaves(); ++leaf)
      for (const int f : tree.faces_of_leaf(leaf))
        for (const Edge& edge : edges_of(body_, f)) ++faces_at[edge];
    edges_.resize(tree.num_leaves());
    for (std::size_t leaf = 0; leaf < tree.num_leaves(); ++leaf) {
      for (const int f : tree.faces_of_leaf(leaf)) {
        for (const Edge& edge : edges_of(body_, f)) {
          if (faces_at[edge] == 1) edges_[leaf].push_back(edge);
        }
      }
      for (const Edge& edge : edges_[leaf]) {
        at_node_[edge[0]].push_back(edge);
        at_node_[edge[1]].push_back(edge);
      }
    }
  }

  /// Whether edges of two leaves are near each other that do not follow each other straight on.
  [[nodiscard]] bool comes_back(std::size_t one, std::size_t other, btScalar distance) const {
    for (const Edge& edge : edges_[one]) {
      const std::map<Edge, btScalar> lengths = following(edge);
      for (const Edge& near : edges_[other]) {
        const btScalar apart = (middle(edge) - middle(near)).length();
        const btScalar reach = distance + (length(edge) + length(near)) / 2;
        if (near == edge || apart >= reach) continue;
        const auto found = lengths.find(near);
        if (found == lengths.end() || apart < kStraight * found->second) return true;
      }
    }
    return false;
  }

 private:
  [[nodiscard]] btVector3 middle(const Edge& edge) const {
    return (body_.m_nodes[edge[0]].m_x + body_.m_nodes[edge[1]].m_x) / 2;
  }
  [[nodiscard]] btScalar length(const Edge& edge) const {
    return (body_.m_nodes[edge[0]].m_x - body_.m_nodes[edge[1]].m_x).length();
  }
  /// The edges that follow one, and how far it is to their middles along the boundary [m].
  [[nodiscard]] std::map<Edge, btScalar> following(const Edge& first) const {
    std::map<Edge, btScalar> lengths{{first, btScalar(0)}};
    std::vector<Edge> last{first};
    for (int step = 0; step < kFollowing; ++step) {
      std::vector<Edge> next;
      for (const Edge& edge : last) {
        for (const int node : edge) {
          for (const Edge& one : at_node_.at(node)) {
            const btScalar way = lengths[edge] + (length(edge) + length(one)) / 2;
            if (lengths.emplace(one, way).second) next.push_back(one);
          }
        }
      }
      last = next;
    }
    return lengths;
  }

  const btSoftBody& body_;
  std::vector<std::vector<Edge>> edges_;  ///< by leaf
  std::map<int, std::vector<Edge>> at_node_;
};

/// Directions of which those of a face's normal in a step are a positive sum.
std::array<btVector3, 3> normals_of(const btSoftBody::Face& face) {
  const btSoftBody::Node &a = *face.m_n[0], &b = *face.m_n[1], &c = *face.m_n[2];
  const btVector3 first = b.m_q - a.m_q, second = c.m_q - a.m_q;
  const btVector3 first_end = b.m_x - a.m_x, second_end = c.m_x - a.m_x;
  return {unit(btCross(first, second)),
          unit(btCross(first, second_end) + btCross(first_end, second)),
          unit(btCross(first_end, second_end))};
}

btScalar angle_between(const btVector3& a, const btVector3& b) {
  return std::acos(btClamped(btDot(a, b), btScalar(-1), btScalar(1)));
}

}  // namespace

void FlatPatches::find_neighbors(const btSoftBody& body, const FaceTree& tree, btScalar distance) {
  const Boundary boundary(body, tree);
  num_faces_ = body.m_faces.size();
  neighbors_.assign(tree.num_leaves(), {});
  std::vector<std::vector<int>> faces_at(static_cast<std::size_t>(body.m_nodes.size()));
  for (int f = 0; f < num_faces_; ++f) {
    for (const btSoftBody::Node* const node : body.m_faces[f].m_n)
      faces_at[static_cast<std::size_t>(number_of(node, body))].push_back(f);
  }
  // Layers of one body may be in a leaf together, and joined at a node alone: nodes count whose faces are one piece.
  std::vector<char> joins(faces_at.size());
  for (std::size_t i = 0; i < joins.size(); ++i) {
    joins[i] =
        static_cast<char>(is_one_piece(faces_at[i], [&](int f) { return edges_of(body, f); }));
  }
  const auto joints_of = [&](int f) {
    std::vector<int> nodes;
    for (const btSoftBody::Node* const node : body.m_faces[f].m_n) {
      const int number = number_of(node, body);
      if (joins[static_cast<std::size_t>(number)] != 0) nodes.push_back(number);
    }
    return nodes;
  };
  std::vector<std::set<int>> leaves_at(faces_at.size());
  for (std::size_t leaf = 0; leaf < tree.num_leaves(); ++leaf) {
    const std::span<const int> faces = tree.faces_of_leaf(leaf);
    if (!is_one_piece(faces, joints_of) || boundary.comes_back(leaf, leaf, distance)) continue;
    for (const int f : faces) {
      for (const int node : joints_of(f))
        leaves_at[static_cast<std::size_t>(node)].insert(static_cast<int>(leaf));
    }
  }
  std::vector<std::set<int>> near(tree.num_leaves());
  for (const std::set<int>& leaves : leaves_at) {
    for (const int leaf : leaves)
      near[static_cast<std::size_t>(leaf)].insert(leaves.begin(), leaves.end());
  }
  for (std::size_t leaf = 0; leaf < near.size(); ++leaf) {
    for (const int other : near[leaf]) {
      if (!boundary.comes_back(leaf, static_cast<std::size_t>(other), distance))
        neighbors_[leaf].push_back(other);
    }
  }
}

void FlatPatches::refit(const btSoftBody& body, const FaceTree& tree) {
  // A program has removed or added faces.
  if (num_faces_ != body.m_faces.size() || neighbors_.size() != tree.num_leaves()) forget();
  if (neighbors_.empty()) return;
  cones_.resize(neighbors_.size());
  std::array<std::array<btVector3, 3>, FaceTree::kWidth> normals;
  for (std::size_t leaf = 0; leaf < cones_.size(); ++leaf) {
    const std::span<const int> faces = tree.faces_of_leaf(leaf);
    btVector3 sum(0, 0, 0);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      normals[i] = normals_of(body.m_faces[faces[i]]);
      for (const btVector3& normal : normals[i]) sum += normal;
    }
    const btVector3 axis = unit(sum);
    btScalar least = 1;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (const btVector3& normal : normals[i]) least = std::min(least, btDot(axis, normal));
    }
    cones_[leaf] = {axis, least > 0 ? std::acos(least) : SIMD_PI};
  }
}

void FlatPatches::mark(std::size_t leaf, std::vector<char>& marks) const {
  if (leaf >= neighbors_.size()) return;
  const Cone& cone = cones_[leaf];
  for (const int other : neighbors_[leaf]) {
    const Cone& near = cones_[static_cast<std::size_t>(other)];
    // About the middle of both axes.
    const btScalar farthest = std::max(cone.angle, near.angle);
    const bool may_be = farthest < kHalfAngle;
    if (may_be && farthest + angle_between(cone.axis, near.axis) / 2 < kHalfAngle)
      marks[static_cast<std::size_t>(other)] |= kFlat;
  }
}

void FlatPatches::unmark(std::size_t leaf, std::vector<char>& marks) const {
  if (leaf >= neighbors_.size()) return;
  for (const int other : neighbors_[leaf])
    marks[static_cast<std::size_t>(other)] &= static_cast<char>(~kFlat);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
