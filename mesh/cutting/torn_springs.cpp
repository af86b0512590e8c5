#include <weft/mesh/cutting/torn_springs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace weft {
namespace {

/// Two lines touch if they come nearer than this part of the first one's length [-]: far above the
/// rounding of rest positions, far below the size of a triangle.
constexpr double kTouch = 1e-6;

/// Squared distance [m^2] of the segments a b and c d, the first of which has a length.
double squared_distance(const Vector3<double>& a, const Vector3<double>& b,
                        const Vector3<double>& c, const Vector3<double>& d) {
  const Vector3<double> u = b - a;
  const Vector3<double> v = d - c;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double determinant = uu * vv - uv * uv;
  const auto nearest_on_first = [&](const Vector3<double>& x) {
    return std::clamp(u.dot(x - a) / uu, 0.0, 1.0);
  };
  double best = std::numeric_limits<double>::infinity();
  const auto try_pair = [&](double s, double t) {
    best = std::min(best, (a + s * u - c - t * v).squaredNorm());
  };
  // Inside both, unless they are parallel; then one of the four ends is nearest.
  if (determinant > 1e-12 * uu * vv) {
    const Vector3<double> w = c - a;
    const double s = (w.dot(u) * vv - w.dot(v) * uv) / determinant;
    const double t = (w.dot(u) * uv - w.dot(v) * uu) / determinant;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) try_pair(s, t);
  }
  try_pair(nearest_on_first(c), 0.0);
  try_pair(nearest_on_first(d), 1.0);
  for (const double s : {0.0, 1.0}) {
    const double t = vv > 0 ? std::clamp(v.dot(a + s * u - c) / vv, 0.0, 1.0) : 0.0;
    try_pair(s, t);
  }
  return best;
}

bool contains(const std::vector<int>& sorted, int value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

/// For the few triangles around a spring this is faster than any set.
bool is_among(const std::vector<int>& few, int value) {
  return std::find(few.begin(), few.end(), value) != few.end();
}

}  // namespace

TornSprings::TornSprings(const ClothMesh& mesh, const Neighborhood& near, const Fans& fans)
    : mesh_(&mesh), near_(&near), fans_(&fans) {
  for (const InnerEdge& edge : near.inner_edges()) {
    const bool may_open = fans.is_split(edge.first) || fans.is_split(edge.second);
    if (may_open && fans.is_open(edge)) open_.push_back(edge);
  }
  sort_into_slices();
}

TornSprings::Box TornSprings::box_of(int i, int j) const {
  const auto& x = mesh_->rest_positions;
  return {x.col(i).cwiseMin(x.col(j)), x.col(i).cwiseMax(x.col(j))};
}

void TornSprings::sort_into_slices() {
  if (open_.empty()) return;
  const auto& x = mesh_->rest_positions;
  whole_ = {x.rowwise().minCoeff(), x.rowwise().maxCoeff()};
  for (const InnerEdge& edge : open_) open_boxes_.push_back(box_of(edge.first, edge.second));
  // More than any spring's limit: springs are no longer than all of the mesh.
  const double reach = 3 * kTouch * (whole_.high - whole_.low).norm();
  for (int axis = 0; axis < 3; ++axis) count_slices(axis, reach);
}

void TornSprings::count_slices(int axis, double reach) {
  std::array<bool, kSlices> is_open = {};
  for (const Box& box : open_boxes_) {
    const unsigned last = slice_of(axis, box.high[axis] + reach);
    for (unsigned s = slice_of(axis, box.low[axis] - reach); s <= last; ++s) is_open[s] = true;
  }
  std::array<OpenSlices, kSlices> until = {};
  unsigned count = 0;
  for (unsigned s = 0; s < kSlices; ++s) {
    until[s].before = static_cast<unsigned char>(count);
    if (is_open[s]) ++count;
    until[s].through = static_cast<unsigned char>(count);
  }
  const auto& x = mesh_->rest_positions;
  auto& of_nodes = open_until_[static_cast<std::size_t>(axis)];
  of_nodes.resize(static_cast<std::size_t>(x.cols()));
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    of_nodes[static_cast<std::size_t>(i)] = until[slice_of(axis, x(axis, i))];
  }
}

unsigned TornSprings::slice_of(int axis, double coordinate) const {
  const double size = whole_.high[axis] - whole_.low[axis];
  const double share = size > 0 ? (coordinate - whole_.low[axis]) / size : 0.0;
  return static_cast<unsigned>(std::clamp(share, 0.0, 1.0) * (kSlices - 1));
}

inline bool TornSprings::meets_slices(int axis, int i, int j) const {
  const auto& of_nodes = open_until_[static_cast<std::size_t>(axis)];
  const OpenSlices a = of_nodes[static_cast<std::size_t>(i)];
  const OpenSlices b = of_nodes[static_cast<std::size_t>(j)];
  return std::max(a.through, b.through) > std::min(a.before, b.before);
}

bool TornSprings::holds(int triangle, int node) const {
  return (mesh_->triangles.col(triangle).array() == node).any();
}

bool TornSprings::is_touched(int i, int j) const {
  if (fans_->is_split(i) || fans_->is_split(j)) return true;
  if (open_.empty()) return false;
  if (!meets_slices(0, i, j) || !meets_slices(1, i, j) || !meets_slices(2, i, j)) return false;
  return meets_open_edge(i, j);
}

bool TornSprings::meets_open_edge(int i, int j) const {
  const auto& x = mesh_->rest_positions;
  const Box box = box_of(i, j);
  const double limit = kTouch * (x.col(j) - x.col(i)).norm();
  for (std::size_t e = 0; e < open_.size(); ++e) {
    const Box& other = open_boxes_[e];
    if (((box.low - other.high).array() > limit).any()) continue;
    if (((other.low - box.high).array() > limit).any()) continue;
    if (squared_distance(x.col(i), x.col(j), x.col(open_[e].first), x.col(open_[e].second)) <=
        limit * limit) {
      return true;
    }
  }
  return false;
}

bool TornSprings::touches(int triangle, int i, int j) const {
  const auto& x = mesh_->rest_positions;
  const double limit = kTouch * (x.col(j) - x.col(i)).norm();
  for (int corner = 0; corner < 3; ++corner) {
    const int a = mesh_->triangles(corner, triangle);
    const int b = mesh_->triangles((corner + 1) % 3, triangle);
    if (squared_distance(x.col(i), x.col(j), x.col(a), x.col(b)) <= limit * limit) return true;
  }
  return false;
}

/// The triangles under the straight line at rest, as far as they hang together before the cut.
/// Sorted.
std::vector<int> TornSprings::strip(int i, int j) const {
  const std::span<const int> around = near_->triangles_of(i);
  std::vector<int> found(around.begin(), around.end());
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (const int e : near_->inner_edges_of(found[k])) {
      const int next = near_->inner_edges()[static_cast<std::size_t>(e)].other(found[k]);
      if (!is_among(found, next) && touches(next, i, j)) found.push_back(next);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// For a line that leaves a curved surface: all triangles around both ends and around the nodes
/// between them. Sorted.
std::vector<int> TornSprings::surroundings(int i, int j) const {
  const auto neighbors = [&](int node) {
    std::set<int> nodes;
    for (const int t : near_->triangles_of(node)) {
      for (const int other : mesh_->triangles.col(t)) nodes.insert(other);
    }
    return nodes;
  };
  const std::set<int> of_i = neighbors(i);
  std::set<int> region;
  for (const int node : neighbors(j)) {
    if (!of_i.contains(node) && node != i && node != j) continue;
    const std::span<const int> around = near_->triangles_of(node);
    region.insert(around.begin(), around.end());
  }
  const std::span<const int> around = near_->triangles_of(i);
  region.insert(around.begin(), around.end());
  return {region.begin(), region.end()};
}

/// Adds every (copy of i, copy of j) that triangles of the region still join.
void TornSprings::pair_up(const std::vector<int>& region, int i, int j,
                          std::vector<std::pair<int, int>>& found) const {
  std::vector<int> seen;  // of earlier pieces
  std::vector<int> piece;
  for (const int start : near_->triangles_of(i)) {
    if (!contains(region, start) || is_among(seen, start)) continue;
    piece.assign(1, start);
    for (std::size_t k = 0; k < piece.size(); ++k) {
      for (const int e : near_->inner_edges_of(piece[k])) {
        const InnerEdge& edge = near_->inner_edges()[static_cast<std::size_t>(e)];
        const int next = edge.other(piece[k]);
        if (!contains(region, next) || fans_->is_open(edge)) continue;
        if (!is_among(piece, next)) piece.push_back(next);
      }
    }
    seen.insert(seen.end(), piece.begin(), piece.end());
    for (const int at_i : piece) {
      if (!holds(at_i, i)) continue;
      for (const int at_j : piece) {
        if (!holds(at_j, j)) continue;
        found.emplace_back(fans_->copy_at(at_i, i), fans_->copy_at(at_j, j));
      }
    }
  }
}

std::vector<std::pair<int, int>> TornSprings::pairs(int i, int j) const {
  if (!is_touched(i, j)) return {{i, j}};
  std::vector<std::pair<int, int>> found;
  bool is_side = false;
  for (const int t : near_->triangles_of(i)) {
    if (!holds(t, j)) continue;
    is_side = true;
    found.emplace_back(fans_->copy_at(t, i), fans_->copy_at(t, j));
  }
  if (!is_side) {
    std::vector<int> region = strip(i, j);
    const auto reaches = [&](int t) { return holds(t, j); };
    if (std::none_of(region.begin(), region.end(), reaches)) region = surroundings(i, j);
    // Too far apart for a cut to say anything about it, or a node of no triangle.
    if (std::none_of(region.begin(), region.end(), reaches)) return {{i, j}};
    pair_up(region, i, j, found);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace weft
