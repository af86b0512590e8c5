#include <weft/mesh/cutting/tear_rule.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <tuple>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/mesh/cutting/fans.hpp>

namespace weft {
namespace {

void require_tear(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("tear: " + message);
}

void require_limit(double strain) {
  require_tear(std::isfinite(strain) && strain > 0,
               "strain = " + std::to_string(strain) + " [-], expected > 0 and finite");
}

void require_positions(const ClothMesh& mesh, Eigen::Index count) {
  require_tear(count == mesh.num_nodes(), std::to_string(count) + " positions, expected " +
                                              std::to_string(mesh.num_nodes()) + " as the mesh");
}

Edges to_edges(const std::vector<int>& flat) {
  return Eigen::Map<const Edges>(flat.data(), 2, std::ssize(flat) / 2);
}

/// A number in [-1, 1) that belongs to the middle of a thread at rest: the same after any cut.
double spread_at(const Vector3<double>& sum_of_ends) {
  std::uint64_t bits = 0;
  for (const double x : sum_of_ends) {
    // SplitMix64's finaliser (Steele, Lea, Flood 2014) after each number.
    bits += std::bit_cast<std::uint64_t>(x + 0.0) + 0x9e3779b97f4a7c15ULL;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
    bits ^= bits >> 31;
  }
  return std::ldexp(static_cast<double>(bits >> 11), -52) - 1.0;
}

/// The set is one of the mesh's.
const Edges& edges_of_set(const ClothMesh& mesh, const std::string& name) {
  return std::find_if(mesh.edge_sets.begin(), mesh.edge_sets.end(),
                      [&](const EdgeSet& set) { return set.name == name; })
      ->edges;
}

struct Thread {
  double load;  ///< strain over limit [-]
  int number;
  int ends[2];
};

class Tearing {
 public:
  Tearing(const ClothMesh& mesh, ConstMatrix3XRef<double> positions, const TearRule& rule);
  [[nodiscard]] Edges cut();
  /// Empty if no thread is beyond its limit.
  [[nodiscard]] const Neighborhood& near() const { return near_; }

 private:
  void find_threads(ConstMatrix3XRef<double> positions, const TearRule& rule);
  void sum_strains(ConstMatrix3XRef<double> positions, const Edges& edges);
  /// Strain of the thread between two nodes [-].
  [[nodiscard]] double strain_of(ConstMatrix3XRef<double> positions, int i, int j) const;
  /// The inner edges at a node between triangles on different sides of the plane across a thread.
  [[nodiscard]] std::vector<int> parting(const Thread& thread, int end) const;
  [[nodiscard]] bool give_way(int node, const std::vector<int>& edges);
  [[nodiscard]] bool is_rim(int node) const;
  [[nodiscard]] bool is_near_a_split(int node) const;
  [[nodiscard]] auto preference(int node) const {
    const auto at = static_cast<std::size_t>(node);
    return std::tuple(is_weak_[at], !is_pinned_[at], is_rim(node), strain_sum_[at], -node);
  }

  const ClothMesh& mesh_;
  Neighborhood near_{Triangles(3, 0), 0};  ///< only made if a thread is beyond its limit
  std::vector<Thread> threads_;
  std::vector<bool> is_weak_;
  std::vector<bool> is_pinned_;
  std::vector<double> strain_sum_;  ///< of the threads at a node that may give way [-]
  std::vector<bool> is_taken_;      ///< triangles around nodes that give way
  std::vector<int> cut_;
  int max_splits_;
};

Tearing::Tearing(const ClothMesh& mesh, ConstMatrix3XRef<double> positions, const TearRule& rule)
    : mesh_(mesh),
      is_weak_(static_cast<std::size_t>(mesh.num_nodes()), false),
      is_pinned_(static_cast<std::size_t>(mesh.num_nodes()), false),
      strain_sum_(static_cast<std::size_t>(mesh.num_nodes()), 0.0),
      is_taken_(static_cast<std::size_t>(mesh.triangles.cols()), false),
      max_splits_(rule.max_splits) {
  for (const int node : mesh.pinned) is_pinned_[static_cast<std::size_t>(node)] = true;
  find_threads(positions, rule);
  if (!threads_.empty()) near_ = Neighborhood(mesh.triangles, mesh.num_nodes());
}

void Tearing::find_threads(ConstMatrix3XRef<double> positions, const TearRule& rule) {
  VectorX<double> limits = VectorX<double>::Constant(mesh_.num_nodes(), 0.0);
  for (const WeakRegion& region : rule.weak) {
    for (const NodeSet& set : mesh_.node_sets) {
      if (set.name != region.node_set) continue;
      for (const int node : set.nodes) {
        limits[node] = region.strain;
        is_weak_[static_cast<std::size_t>(node)] = true;
      }
    }
  }
  const Edges& edges = edges_of_set(mesh_, rule.edge_set);
  const auto& rest = mesh_.rest_positions;
  double least = rule.strain;
  for (const WeakRegion& region : rule.weak) least = std::min(least, region.strain);
  // Most threads are far from any limit: that is seen without a square root. Rounding is left out by far.
  const double safe_stretch = (1.0 + least * (1.0 - rule.variation)) * (1.0 - 1e-9);
  const double safe = safe_stretch * safe_stretch;
  for (int e = 0; e < static_cast<int>(edges.cols()); ++e) {
    const int i = edges(0, e);
    const int j = edges(1, e);
    if ((positions.col(j) - positions.col(i)).squaredNorm() <
        safe * (rest.col(j) - rest.col(i)).squaredNorm()) {
      continue;
    }
    const double strain = strain_of(positions, i, j);
    double limit = rule.strain;
    for (const double weak : {limits[i], limits[j]}) {
      if (weak > 0) limit = weak;
    }
    limit *= 1.0 + rule.variation * spread_at(rest.col(i) + rest.col(j));
    if (strain > limit) threads_.push_back({strain / limit, e, {i, j}});
  }
  std::sort(threads_.begin(), threads_.end(), [](const Thread& a, const Thread& b) {
    return std::tuple(-a.load, a.number) < std::tuple(-b.load, b.number);
  });
  sum_strains(positions, edges);
}

double Tearing::strain_of(ConstMatrix3XRef<double> positions, int i, int j) const {
  return (positions.col(j) - positions.col(i)).norm() /
             (mesh_.rest_positions.col(j) - mesh_.rest_positions.col(i)).norm() -
         1.0;
}

/// Sums up the strains of all threads at the ends of those that may tear.
void Tearing::sum_strains(ConstMatrix3XRef<double> positions, const Edges& edges) {
  if (threads_.empty()) return;
  std::vector<char> is_end(strain_sum_.size(), 0);
  for (const Thread& thread : threads_) {
    for (const int node : thread.ends) is_end[static_cast<std::size_t>(node)] = 1;
  }
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const int i = edges(0, e);
    const int j = edges(1, e);
    const auto is_wanted = [&](int node) { return is_end[static_cast<std::size_t>(node)] != 0; };
    if (!is_wanted(i) && !is_wanted(j)) continue;
    const double strain = strain_of(positions, i, j);
    for (const int node : {i, j}) strain_sum_[static_cast<std::size_t>(node)] += strain;
  }
}

std::vector<int> Tearing::parting(const Thread& thread, int end) const {
  const int node = thread.ends[end];
  const Vector3<double> origin = mesh_.rest_positions.col(node);
  const Vector3<double> along = mesh_.rest_positions.col(thread.ends[1 - end]) - origin;
  const auto is_ahead = [&](int t) {
    Vector3<double> centre = Vector3<double>::Zero();
    for (const int corner : mesh_.triangles.col(t)) centre += mesh_.rest_positions.col(corner);
    return (centre / 3.0 - origin).dot(along) >= 0;
  };
  std::vector<int> edges;
  for (const int t : near_.triangles_of(node)) {
    for (const int e : near_.inner_edges_of(t)) {
      const InnerEdge& edge = near_.inner_edges()[static_cast<std::size_t>(e)];
      if (edge.first != node && edge.second != node) continue;
      if (edge.triangles[0] != t) continue;  // once
      if (is_ahead(t) != is_ahead(edge.triangles[1])) edges.push_back(e);
    }
  }
  return edges;
}

bool Tearing::is_rim(int node) const {
  int num_sides = 0;
  for (const int t : near_.triangles_of(node)) {
    for (const int e : near_.inner_edges_of(t)) {
      const InnerEdge& edge = near_.inner_edges()[static_cast<std::size_t>(e)];
      if (edge.first == node || edge.second == node) ++num_sides;
    }
  }
  return num_sides < 2 * std::ssize(near_.triangles_of(node));
}

/// Whether a triangle around the node belongs to one that gives way already.
bool Tearing::is_near_a_split(int node) const {
  const std::span<const int> around = near_.triangles_of(node);
  return std::any_of(around.begin(), around.end(),
                     [&](int t) { return is_taken_[static_cast<std::size_t>(t)]; });
}

/// Whether the node comes apart: one cut opens a node of the rim, two one inside.
bool Tearing::give_way(int node, const std::vector<int>& edges) {
  if (edges.empty() || (edges.size() == 1 && !is_rim(node))) return false;
  for (const int t : near_.triangles_of(node)) is_taken_[static_cast<std::size_t>(t)] = true;
  for (const int e : edges) {
    const InnerEdge& edge = near_.inner_edges()[static_cast<std::size_t>(e)];
    cut_.insert(cut_.end(), {edge.first, edge.second});
  }
  return true;
}

Edges Tearing::cut() {
  int num_splits = 0;
  for (const Thread& thread : threads_) {
    if (num_splits == max_splits_) break;
    // What is torn beside it may relieve it: it has time until the next step.
    if (is_near_a_split(thread.ends[0]) || is_near_a_split(thread.ends[1])) continue;
    const std::vector<int> partings[2] = {parting(thread, 0), parting(thread, 1)};
    bool pulls = true;
    for (int end = 0; end < 2; ++end) {
      const bool is_held = is_pinned_[static_cast<std::size_t>(thread.ends[end])];
      if (partings[end].empty() && !is_held) pulls = false;
    }
    if (!pulls) continue;
    const int best = preference(thread.ends[0]) >= preference(thread.ends[1]) ? 0 : 1;
    for (const int end : {best, 1 - best}) {
      if (!give_way(thread.ends[end], partings[end])) continue;
      ++num_splits;
      break;
    }
  }
  return to_edges(cut_);
}

}  // namespace

void check(const TearRule& rule, const ClothMesh& mesh) {
  require_limit(rule.strain);
  require_tear(rule.variation >= 0 && rule.variation < 1,
               "variation = " + std::to_string(rule.variation) + " [-], expected 0 to less than 1");
  require_tear(rule.max_splits >= 1,
               "max_splits = " + std::to_string(rule.max_splits) + ", expected >= 1");
  require_tear(mesh.has_edge_set(rule.edge_set),
               "edge_set = '" + rule.edge_set + "', expected an edge set of the mesh");
  for (const WeakRegion& region : rule.weak) {
    require_limit(region.strain);
    const bool is_known =
        std::any_of(mesh.node_sets.begin(), mesh.node_sets.end(),
                    [&](const NodeSet& set) { return set.name == region.node_set; });
    require_tear(is_known, "region = '" + region.node_set + "', expected a node set of the mesh");
  }
}

Edges edges_to_tear(const ClothMesh& mesh, ConstMatrix3XRef<double> positions,
                    const TearRule& rule) {
  check(rule, mesh);
  require_positions(mesh, positions.cols());
  if (!positions.allFinite()) return {2, 0};
  return Tearing(mesh, positions, rule).cut();
}

Tear tear_now(const ClothMesh& mesh, ConstMatrix3XRef<double> positions, const TearRule& rule) {
  check(rule, mesh);
  require_positions(mesh, positions.cols());
  if (!positions.allFinite()) return {mesh, {}};
  Tearing tearing(mesh, positions, rule);
  const Edges cut = tearing.cut();
  if (cut.cols() == 0) return {mesh, {}};
  return cut_along(mesh, tearing.near(), cut);
}

Edges edges_under(const Blade& blade, const ClothMesh& mesh, ConstMatrix3XRef<double> positions) {
  require_positions(mesh, positions.cols());
  const Vector3<double> along = blade.to - blade.from;
  const Vector3<double> normal = along.cross(blade.depth);
  require_tear(normal.allFinite() && normal.norm() > 0,
               "the blade has no area, expected finite from, to and depth that span one");
  const auto side = [&](int t) {
    Vector3<double> sum = -3.0 * blade.from;
    for (const int node : mesh.triangles.col(t)) sum += positions.col(node);
    return sum.dot(normal);
  };
  // Coordinates on the blade: x - from = s along + r depth + (a part along the normal).
  const Vector3<double> by_along = blade.depth.cross(normal) / normal.squaredNorm();
  const Vector3<double> by_depth = normal.cross(along) / normal.squaredNorm();
  std::vector<int> cut;
  const Neighborhood near(mesh.triangles, mesh.num_nodes());
  for (const InnerEdge& edge : near.inner_edges()) {
    const double sides[2] = {side(edge.triangles[0]), side(edge.triangles[1])};
    // Written so that a place that is not finite is not cut.
    const bool parts = (sides[0] >= 0 && sides[1] < 0) || (sides[0] < 0 && sides[1] >= 0);
    const Vector3<double> middle =
        (positions.col(edge.first) + positions.col(edge.second)) / 2.0 - blade.from;
    const double s = by_along.dot(middle);
    const double r = by_depth.dot(middle);
    if (parts && s >= 0 && s <= 1 && r >= -1 && r <= 1) {
      cut.insert(cut.end(), {edge.first, edge.second});
    }
  }
  return to_edges(cut);
}

}  // namespace weft
