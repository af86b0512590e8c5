#include <weft/mesh/cutting/tear.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/mesh/cutting/torn_springs.hpp>

namespace weft {
namespace {

std::vector<bool> cut_flags(const ClothMesh& mesh, const Neighborhood& near, const Edges& cut) {
  std::vector<std::pair<int, int>> wanted;
  for (Eigen::Index e = 0; e < cut.cols(); ++e) {
    for (const int node : cut.col(e)) {
      if (node < 0 || node >= mesh.num_nodes()) {
        throw InvalidArgument("tear: the cut names node " + std::to_string(node) +
                              ", expected 0 to " + std::to_string(mesh.num_nodes() - 1));
      }
    }
    wanted.push_back(std::minmax({cut(0, e), cut(1, e)}));
  }
  std::sort(wanted.begin(), wanted.end());
  std::vector<bool> flags;
  flags.reserve(near.inner_edges().size());
  for (const InnerEdge& edge : near.inner_edges()) {
    flags.push_back(
        std::binary_search(wanted.begin(), wanted.end(), std::pair(edge.first, edge.second)));
  }
  return flags;
}

double rest_area(const ClothMesh& mesh, int triangle) {
  const Eigen::Vector3i nodes = mesh.triangles.col(triangle);
  const Vector3<double> a = mesh.rest_positions.col(nodes[0]);
  const Vector3<double> b = mesh.rest_positions.col(nodes[1]);
  const Vector3<double> c = mesh.rest_positions.col(nodes[2]);
  return (b - a).cross(c - a).norm() / 2.0;
}

/// Shares are whole multiples of 2^-26 of the mass or so, which leaves 26 bits below them: the shares
/// of shares of a node, down to single triangles, and the low bits of its mass, which one of them
/// carries, are all multiples of the mass's own last bit, so that every sum of them is exact.
constexpr int kShareBits = 26;

void share_mass(const std::vector<int>& copies, const std::vector<double>& areas, double mass,
                VectorX<double>& masses) {
  int exponent = 0;
  (void)std::frexp(mass, &exponent);
  const double unit =
      std::max(std::ldexp(1.0, exponent - kShareBits), std::numeric_limits<double>::denorm_min());
  const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
  double left = mass;
  for (std::size_t k = copies.size() - 1; k > 0; --k) {
    const double part = whole > 0 ? areas[k] / whole : 1.0 / static_cast<double>(copies.size());
    const double largest = left - static_cast<double>(k) * unit;
    const double share = std::clamp(std::round(mass * part / unit) * unit, unit, largest);
    masses[copies[k]] = share;
    left -= share;
  }
  masses[copies[0]] = left;
}

void add_nodes(const ClothMesh& mesh, const Neighborhood& near, const Fans& fans, ClothMesh& torn) {
  const auto old = static_cast<Eigen::Index>(mesh.num_nodes());
  const auto added = static_cast<Eigen::Index>(fans.origins().size());
  torn.rest_positions.resize(3, old + added);
  torn.rest_positions.leftCols(old) = mesh.rest_positions;
  torn.masses.resize(old + added);
  torn.masses.head(old) = mesh.masses;
  torn.corner_texture_coordinates = mesh.corner_texture_coordinates;
  const bool has_texture = mesh.texture_coordinates.cols() > 0;
  if (has_texture) {
    torn.texture_coordinates.resize(2, old + added);
    torn.texture_coordinates.leftCols(old) = mesh.texture_coordinates;
  }
  for (Eigen::Index k = 0; k < added; ++k) {
    const int origin = fans.origins()[static_cast<std::size_t>(k)];
    torn.rest_positions.col(old + k) = mesh.rest_positions.col(origin);
    if (has_texture) torn.texture_coordinates.col(old + k) = mesh.texture_coordinates.col(origin);
  }
  for (const auto& [node, copies] : fans.split_nodes()) {
    std::vector<double> areas(copies.size(), 0.0);
    for (const int t : near.triangles_of(node)) {
      const auto copy = std::find(copies.begin(), copies.end(), fans.copy_at(t, node));
      areas[static_cast<std::size_t>(copy - copies.begin())] += rest_area(mesh, t);
    }
    share_mass(copies, areas, mesh.masses[node], torn.masses);
  }
}

void add_pins(const ClothMesh& mesh, const Fans& fans, ClothMesh& torn) {
  torn.pinned = mesh.pinned;
  torn.pinned_velocities = mesh.pinned_velocities;
  const bool have_velocities = mesh.pinned_velocities.cols() > 0;
  std::vector<Vector3<double>> velocities;
  for (std::size_t k = 0; k < fans.origins().size(); ++k) {
    const auto found = std::lower_bound(mesh.pinned.begin(), mesh.pinned.end(), fans.origins()[k]);
    if (found == mesh.pinned.end() || *found != fans.origins()[k]) continue;
    torn.pinned.push_back(mesh.num_nodes() + static_cast<int>(k));
    velocities.push_back(
        mesh.pinned_velocity(static_cast<std::size_t>(found - mesh.pinned.begin())));
  }
  if (!have_velocities) return;
  const Eigen::Index old = mesh.pinned_velocities.cols();
  torn.pinned_velocities.conservativeResize(3, old + std::ssize(velocities));
  for (std::size_t k = 0; k < velocities.size(); ++k) {
    torn.pinned_velocities.col(old + static_cast<Eigen::Index>(k)) = velocities[k];
  }
}

void add_to_node_sets(const ClothMesh& mesh, const Fans& fans, ClothMesh& torn) {
  torn.node_sets = mesh.node_sets;
  for (NodeSet& set : torn.node_sets) {
    const std::vector<int> before = set.nodes;
    for (std::size_t k = 0; k < fans.origins().size(); ++k) {
      if (std::binary_search(before.begin(), before.end(), fans.origins()[k])) {
        set.nodes.push_back(mesh.num_nodes() + static_cast<int>(k));
      }
    }
  }
}

template <int kNodes>
Eigen::Matrix<int, kNodes, Eigen::Dynamic> columns(const std::vector<int>& nodes) {
  using Elements = Eigen::Matrix<int, kNodes, Eigen::Dynamic>;
  return Eigen::Map<const Elements>(nodes.data(), kNodes, std::ssize(nodes) / kNodes);
}

/// Flags of nodes that belong to an element that is another one after the cut.
class ChangedNodes {
 public:
  explicit ChangedNodes(int num_nodes) : flags_(static_cast<std::size_t>(num_nodes), 0) {}
  template <class Nodes>
  void mark(const Nodes& nodes) {
    for (const int node : nodes) flags_[static_cast<std::size_t>(node)] = 1;
  }
  void mark_all() { std::fill(flags_.begin(), flags_.end(), char{1}); }
  [[nodiscard]] std::vector<int> nodes() const {
    std::vector<int> result;
    for (std::size_t node = 0; node < flags_.size(); ++node) {
      if (flags_[node] != 0) result.push_back(static_cast<int>(node));
    }
    return result;
  }

 private:
  std::vector<char> flags_;
};

void mark_triangles(const Triangles& before, const Triangles& after, ChangedNodes& changed) {
  for (Eigen::Index t = 0; t < before.cols(); ++t) {
    if ((before.col(t).array() == after.col(t).array()).all()) continue;
    changed.mark(before.col(t));
    changed.mark(after.col(t));
  }
}

/// Elements some of which are replaced by others, in their places. Few are, and the rest is copied as it is: the
/// springs of a large cloth are not to be gone through one by one more often than needed.
template <int kNodes>
class Replacement {
 public:
  using Elements = Eigen::Matrix<int, kNodes, Eigen::Dynamic>;
  /// In ascending order of elements.
  void replace(Eigen::Index element, const Elements& before, const std::vector<int>& by,
               ChangedNodes& changed) {
    if (std::equal(by.begin(), by.end(), before.col(element).begin(), before.col(element).end())) {
      return;
    }
    changed.mark(before.col(element));
    changed.mark(by);
    elements_.push_back(element);
    nodes_.insert(nodes_.end(), by.begin(), by.end());
    ends_.push_back(std::ssize(nodes_) / kNodes);
  }
  [[nodiscard]] Elements in(const Elements& before) const {
    const auto num_new = std::ssize(nodes_) / kNodes;
    Elements result(kNodes, before.cols() - std::ssize(elements_) + num_new);
    const Elements by = columns<kNodes>(nodes_);
    Eigen::Index from = 0;
    Eigen::Index to = 0;
    Eigen::Index begin = 0;
    for (std::size_t k = 0; k <= elements_.size(); ++k) {
      const Eigen::Index kept = (k < elements_.size() ? elements_[k] : before.cols()) - from;
      result.middleCols(to, kept) = before.middleCols(from, kept);
      from += kept + 1;
      to += kept;
      if (k == elements_.size()) break;
      result.middleCols(to, ends_[k] - begin) = by.middleCols(begin, ends_[k] - begin);
      to += ends_[k] - begin;
      begin = ends_[k];
    }
    return result;
  }

 private:
  std::vector<Eigen::Index> elements_;
  std::vector<std::ptrdiff_t> ends_;  ///< of what replaces each of them, in columns
  std::vector<int> nodes_;
};

Edges torn_edges(const Edges& edges, const TornSprings& springs, ChangedNodes& changed) {
  Replacement<2> replacement;
  std::vector<int> by;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    if (!springs.is_touched(edges(0, e), edges(1, e))) continue;
    by.clear();
    for (const auto& [i, j] : springs.pairs(edges(0, e), edges(1, e))) {
      by.insert(by.end(), {std::min(i, j), std::max(i, j)});
    }
    replacement.replace(e, edges, by, changed);
  }
  return replacement.in(edges);
}

Triples torn_lines(const Triples& triples, const TornSprings& springs, ChangedNodes& changed) {
  Replacement<3> replacement;
  std::vector<int> by;
  for (Eigen::Index l = 0; l < triples.cols(); ++l) {
    if (!springs.is_touched(triples(0, l), triples(1, l)) &&
        !springs.is_touched(triples(1, l), triples(2, l))) {
      continue;
    }
    by.clear();
    for (const auto& [a, centre] : springs.pairs(triples(0, l), triples(1, l))) {
      for (const auto& [same, b] : springs.pairs(triples(1, l), triples(2, l))) {
        if (same == centre) by.insert(by.end(), {a, centre, b});
      }
    }
    replacement.replace(l, triples, by, changed);
  }
  return replacement.in(triples);
}

/// The triangle of the fan around a node in which the next node is to.
int triangle_along(const ClothMesh& mesh, const Neighborhood& near, int from, int to) {
  for (const int t : near.triangles_of(from)) {
    for (int corner = 0; corner < 3; ++corner) {
      if (mesh.triangles(corner, t) == from && mesh.triangles((corner + 1) % 3, t) == to) return t;
    }
  }
  return -1;
}

/// Flags each node that has a triangle in common with one that falls apart.
std::vector<bool> near_splits(const ClothMesh& mesh, const Neighborhood& near, const Fans& fans) {
  std::vector<bool> is_near(static_cast<std::size_t>(mesh.num_nodes()), false);
  for (const auto& [node, copies] : fans.split_nodes()) {
    for (const int t : near.triangles_of(node)) {
      for (const int other : mesh.triangles.col(t)) is_near[static_cast<std::size_t>(other)] = true;
    }
  }
  return is_near;
}

/// A crossed triangle runs along two sides of its cell, and so along one side of each of the cell's
/// own triangles; their common edge is the cell's diagonal.
Triangles torn_crossed(const ClothMesh& mesh, const Neighborhood& near, const Fans& fans,
                       ChangedNodes& changed) {
  Replacement<3> replacement;
  const std::vector<bool> is_near = near_splits(mesh, near, fans);
  for (Eigen::Index c = 0; c < mesh.crossed_triangles.cols(); ++c) {
    const Eigen::Vector3i crossed = mesh.crossed_triangles.col(c);
    const bool is_touched = std::any_of(crossed.begin(), crossed.end(), [&](int node) {
      return is_near[static_cast<std::size_t>(node)];
    });
    if (!is_touched) continue;
    Eigen::Vector3i copies = crossed;
    std::vector<int> under;
    for (int corner = 0; corner < 3; ++corner) {
      const int to = (corner + 1) % 3;
      const int t = triangle_along(mesh, near, crossed[corner], crossed[to]);
      if (t < 0) continue;
      under.push_back(t);
      copies[corner] = fans.copy_at(t, crossed[corner]);
      copies[to] = fans.copy_at(t, crossed[to]);
    }
    bool is_whole = under.size() == 2;
    if (is_whole) {
      is_whole = false;
      for (const int e : near.inner_edges_of(under[0])) {
        const InnerEdge& diagonal = near.inner_edges()[static_cast<std::size_t>(e)];
        if (diagonal.other(under[0]) == under[1]) is_whole = !fans.is_open(diagonal);
      }
    }
    std::vector<int> kept;
    if (is_whole) kept.assign(copies.begin(), copies.end());
    replacement.replace(c, mesh.crossed_triangles, kept, changed);
  }
  Triangles after = replacement.in(mesh.crossed_triangles);
  // Bending is another one where there are none (hinge_torsion.hpp).
  if (after.cols() == 0 && mesh.crossed_triangles.cols() > 0) changed.mark_all();
  return after;
}

/// The lowest node of the piece that each node of the mesh belongs to.
std::vector<int> pieces(const ClothMesh& mesh) {
  std::vector<int> piece(static_cast<std::size_t>(mesh.num_nodes()));
  std::iota(piece.begin(), piece.end(), 0);
  const auto root = [&](int node) {
    while (piece[static_cast<std::size_t>(node)] != node) {
      int& parent = piece[static_cast<std::size_t>(node)];
      parent = piece[static_cast<std::size_t>(parent)];
      node = parent;
    }
    return node;
  };
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int corner = 1; corner < 3; ++corner) {
      const auto [low, high] =
          std::minmax({root(mesh.triangles(0, t)), root(mesh.triangles(corner, t))});
      piece[static_cast<std::size_t>(high)] = low;
    }
  }
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    piece[static_cast<std::size_t>(node)] = root(node);
  }
  return piece;
}

void drop_parted_connections(ClothMesh& torn) {
  if (torn.connection_sets.empty()) return;
  const std::vector<int> piece = pieces(torn);
  for (ConnectionSet& set : torn.connection_sets) {
    std::vector<int> kept;
    for (Eigen::Index c = 0; c < set.connections.cols(); ++c) {
      const int node = set.connections(0, c);
      const int far = set.connections(1, c);
      if (piece[static_cast<std::size_t>(node)] == piece[static_cast<std::size_t>(far)]) {
        kept.insert(kept.end(), {node, far});
      }
    }
    set.connections = columns<2>(kept);
  }
}

}  // namespace

Tear cut_along(const ClothMesh& mesh, const Edges& cut) {
  return cut_along(mesh, Neighborhood(mesh.triangles, mesh.num_nodes()), cut);
}

Tear cut_along(const ClothMesh& mesh, const Neighborhood& near, const Edges& cut) {
  const Fans fans(mesh, near, cut_flags(mesh, near, cut));
  if (fans.origins().empty()) return {mesh, {}};
  Tear tear{{}, fans.origins()};
  ClothMesh& torn = tear.mesh;
  ChangedNodes changed(mesh.num_nodes() + static_cast<int>(fans.origins().size()));
  torn.triangles = fans.triangles();
  mark_triangles(mesh.triangles, torn.triangles, changed);
  torn.crossed_triangles = torn_crossed(mesh, near, fans, changed);
  add_nodes(mesh, near, fans, torn);
  add_pins(mesh, fans, torn);
  add_to_node_sets(mesh, fans, torn);
  const TornSprings springs(mesh, near, fans);
  for (const EdgeSet& set : mesh.edge_sets) {
    torn.edge_sets.push_back({set.name, torn_edges(set.edges, springs, changed)});
  }
  for (const LineSet& set : mesh.line_sets) {
    torn.line_sets.push_back({set.name, torn_lines(set.triples, springs, changed)});
  }
  torn.connection_sets = mesh.connection_sets;
  drop_parted_connections(torn);
  tear.changed = changed.nodes();
  return tear;
}

}  // namespace weft
