// Tested by tests/scenes/import/import_test.cpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include <weft/scenes/import/mesh_report.hpp>

namespace weft::import {
namespace {

/// Sets that grow together.
class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

struct EdgeUse {
  int triangle;
  bool is_forward;  ///< from the lower to the higher node
};
using EdgeTable = std::map<std::pair<int, int>, std::vector<EdgeUse>>;

void drop_what_is_no_triangle(const Soup& soup, MeshReport& report, std::vector<int>& keep) {
  std::set<std::array<int, 3>> known;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Eigen::Vector3i& corners = soup.triangles[t];
    std::array<int, 3> sorted = {corners[0], corners[1], corners[2]};
    std::sort(sorted.begin(), sorted.end());
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) {
      report.collapsed_faces.push_back(soup.faces[t]);
    } else if (!known.insert(sorted).second) {
      report.duplicate_faces.push_back(soup.faces[t]);
    } else {
      keep.push_back(static_cast<int>(t));
    }
  }
}

void measure(const Soup& soup, const std::vector<int>& keep, MeshReport& report) {
  report.smallest_angle = keep.empty() ? 0.0 : 4.0;  // above every angle
  for (const int t : keep) {
    const auto number = static_cast<std::size_t>(t);
    const Eigen::Vector3i& corners = soup.triangles[number];
    double longest = 0;
    double smallest = 4.0;
    double area = 0;
    for (int c = 0; c < 3; ++c) {
      const Vector3<double> here = soup.positions.col(corners[c]);
      const Vector3<double> a = soup.positions.col(corners[(c + 1) % 3]) - here;
      const Vector3<double> b = soup.positions.col(corners[(c + 2) % 3]) - here;
      longest = std::max(longest, a.norm());
      area = 0.5 * a.cross(b).norm();
      smallest = std::min(smallest, std::atan2(2 * area, a.dot(b)));
    }
    report.area += area;
    if (!(area > kFlatRatio * longest * longest)) {
      report.flat_faces.push_back(soup.faces[number]);
    } else if (smallest < kSliverAngle) {
      report.slivers.push_back(soup.faces[number]);
    }
    if (smallest < report.smallest_angle) {
      report.smallest_angle = smallest;
      report.smallest_angle_face = soup.faces[number];
    }
  }
}

EdgeTable edges_of(const Soup& soup, const std::vector<int>& keep) {
  EdgeTable table;
  for (const int t : keep) {
    const Eigen::Vector3i& corners = soup.triangles[static_cast<std::size_t>(t)];
    for (int c = 0; c < 3; ++c) {
      const int from = corners[c];
      const int to = corners[(c + 1) % 3];
      table[{std::min(from, to), std::max(from, to)}].push_back({t, from < to});
    }
  }
  return table;
}

void check_edges(const Soup& soup, const EdgeTable& edges, MeshReport& report) {
  Groups rims(static_cast<std::size_t>(soup.positions.cols()));
  std::set<int> rim_nodes;
  for (const auto& [nodes, uses] : edges) {
    if (uses.size() == 1) {
      ++report.boundary_edges;
      rims.join(static_cast<std::size_t>(nodes.first), static_cast<std::size_t>(nodes.second));
      rim_nodes.insert({nodes.first, nodes.second});
      continue;
    }
    const bool is_branching = uses.size() > 2;
    if (!is_branching && uses[0].is_forward != uses[1].is_forward) continue;
    Defect defect{0.5 * (soup.positions.col(nodes.first) + soup.positions.col(nodes.second)), {}};
    for (const EdgeUse& use : uses) {
      defect.faces.push_back(soup.faces[static_cast<std::size_t>(use.triangle)]);
    }
    (is_branching ? report.branching_edges : report.flipped_edges).push_back(std::move(defect));
  }
  std::set<std::size_t> loops;
  for (const int node : rim_nodes) loops.insert(rims.root(static_cast<std::size_t>(node)));
  report.boundary_loops = static_cast<int>(loops.size());
}

/// A node joins two fans if its triangles are not all connected by edges that end in it.
void check_fans(const Soup& soup, const std::vector<int>& keep, const EdgeTable& edges,
                MeshReport& report) {
  std::map<int, std::vector<int>> triangles_at;
  for (const int t : keep) {
    for (const int node : soup.triangles[static_cast<std::size_t>(t)]) {
      triangles_at[node].push_back(t);
    }
  }
  // Corner c of triangle t is 3t + c; corners of one node in neighboring triangles are joined.
  Groups corners(3 * soup.triangles.size());
  const auto corner_of = [&](int triangle, int node) {
    const auto t = static_cast<std::size_t>(triangle);
    const Eigen::Vector3i& nodes = soup.triangles[t];
    return 3 * t + (nodes[0] == node ? 0U : nodes[1] == node ? 1U : 2U);
  };
  for (const auto& [nodes, uses] : edges) {
    for (std::size_t u = 1; u < uses.size(); ++u) {
      for (const int node : {nodes.first, nodes.second}) {
        corners.join(corner_of(uses[0].triangle, node), corner_of(uses[u].triangle, node));
      }
    }
  }
  for (const auto& [node, triangles] : triangles_at) {
    const std::size_t first = corners.root(corner_of(triangles[0], node));
    for (const int t : triangles) {
      if (corners.root(corner_of(t, node)) == first) continue;
      report.bow_ties.push_back({soup.positions.col(node),
                                 {soup.faces[static_cast<std::size_t>(triangles[0])],
                                  soup.faces[static_cast<std::size_t>(t)]}});
      break;
    }
  }
}

}  // namespace

void inspect(const Soup& soup, MeshReport& report, std::vector<int>& keep) {
  drop_what_is_no_triangle(soup, report, keep);
  report.num_triangles = static_cast<int>(keep.size());
  measure(soup, keep, report);
  const EdgeTable edges = edges_of(soup, keep);
  check_edges(soup, edges, report);
  check_fans(soup, keep, edges, report);
}

}  // namespace weft::import
