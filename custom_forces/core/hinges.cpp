#include <weft/custom_forces/core/hinges.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <weft/custom_forces/core/error.hpp>

namespace weft {
namespace {

/// One side of an edge: the triangle that runs along it and its third node.
struct Side {
  Eigen::Index triangle;
  int from;
  int opposite;
};

struct SharedEdge {
  int first;   ///< lower index
  int second;  ///< higher index
  std::vector<Side> sides;
};

/// The edges in the order in which the triangles name them: an order that any map would lose.
std::vector<SharedEdge> shared_edges(const Triangles& triangles) {
  std::vector<SharedEdge> edges;
  std::map<std::pair<int, int>, std::size_t> index;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int from = triangles(corner, t);
      const int to = triangles((corner + 1) % 3, t);
      const auto [a, b] = std::minmax(from, to);
      const auto [found, is_new] = index.emplace(std::pair(a, b), edges.size());
      if (is_new) edges.push_back({a, b, {}});
      edges[found->second].sides.push_back({t, from, triangles((corner + 2) % 3, t)});
    }
  }
  return edges;
}

std::string name_of(const SharedEdge& edge) {
  return "the edge between nodes " + std::to_string(edge.first) + " and " +
         std::to_string(edge.second);
}

}  // namespace

Edges edges_of_triangles(const Triangles& triangles) {
  const std::vector<SharedEdge> shared = shared_edges(triangles);
  Edges edges(2, static_cast<Eigen::Index>(shared.size()));
  for (std::size_t e = 0; e < shared.size(); ++e) {
    edges.col(static_cast<Eigen::Index>(e)) << shared[e].first, shared[e].second;
  }
  return edges;
}

Hinges hinges_of_triangles(const Triangles& triangles) {
  std::vector<Eigen::Vector4i> hinges;
  for (const SharedEdge& edge : shared_edges(triangles)) {
    if (edge.sides.size() < 2) continue;
    if (edge.sides.size() > 2) {
      throw InvalidArgument("hinges: " + name_of(edge) + " belongs to " +
                            std::to_string(edge.sides.size()) + " triangles, among them " +
                            std::to_string(edge.sides[0].triangle) + ", " +
                            std::to_string(edge.sides[1].triangle) + " and " +
                            std::to_string(edge.sides[2].triangle) + ", expected at most 2");
    }
    const Side& a = edge.sides[0];
    const Side& b = edge.sides[1];
    if (a.from == b.from) {
      throw InvalidArgument("hinges: triangles " + std::to_string(a.triangle) + " and " +
                            std::to_string(b.triangle) + " run the same way along " +
                            name_of(edge) + ", expected all to turn the same way round");
    }
    hinges.emplace_back(a.from, b.from, a.opposite, b.opposite);
  }
  Hinges result(4, static_cast<Eigen::Index>(hinges.size()));
  for (std::size_t h = 0; h < hinges.size(); ++h) {
    result.col(static_cast<Eigen::Index>(h)) = hinges[h];
  }
  return result;
}

bool is_closed_surface(const Triangles& triangles) {
  const std::vector<SharedEdge> edges = shared_edges(triangles);
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [](const SharedEdge& edge) {
    return edge.sides.size() == 2 && edge.sides[0].from != edge.sides[1].from;
  });
}

VectorX<double> hinge_angles(ConstMatrix3XRef<double> positions, const Hinges& hinges) {
  VectorX<double> angles(hinges.cols());
  for (Eigen::Index h = 0; h < hinges.cols(); ++h) {
    const Vector3<double> i = positions.col(hinges(0, h));
    const Vector3<double> edge = positions.col(hinges(1, h)) - i;
    const Vector3<double> n1 = edge.cross(positions.col(hinges(2, h)) - i);
    const Vector3<double> n2 = (positions.col(hinges(3, h)) - i).cross(edge);
    angles[h] = std::atan2(n1.cross(n2).dot(edge), n1.dot(n2) * edge.norm());
  }
  return angles;
}

std::vector<Ring> rings(const Triangles& triangles, const std::vector<int>& nodes) {
  // Around a node, each triangle leads from its next corner to its last one.
  std::map<int, std::map<int, int>> next;
  for (const int node : nodes) next[node];
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto found = next.find(triangles(corner, t));
      if (found == next.end()) continue;
      const int from = triangles((corner + 1) % 3, t);
      if (!found->second.emplace(from, triangles((corner + 2) % 3, t)).second) {
        throw InvalidArgument(
            "rings: two triangles run the same way along the edge between nodes " +
            std::to_string(found->first) + " and " + std::to_string(from) +
            ", expected all to turn the same way round");
      }
    }
  }
  std::vector<Ring> result;
  for (const int node : nodes) {
    const std::map<int, int>& fan = next[node];
    Ring ring;
    if (!fan.empty()) {
      // An open fan starts at the one node that no triangle leads to.
      int start = fan.begin()->first;
      for (const auto& [from, to] : fan) {
        const bool is_reached = std::any_of(
            fan.begin(), fan.end(), [from = from](const auto& f) { return f.second == from; });
        if (!is_reached) {
          start = from;
          ring.is_open = true;
        }
      }
      int current = start;
      std::size_t num_triangles = 0;
      ring.nodes.push_back(current);
      for (auto step = fan.find(current); step != fan.end() && num_triangles < fan.size();
           step = fan.find(current)) {
        ++num_triangles;
        current = step->second;
        if (current != start) ring.nodes.push_back(current);
      }
      if (num_triangles != fan.size()) {
        throw InvalidArgument("rings: the triangles around node " + std::to_string(node) +
                              " make more than one fan, expected one");
      }
    }
    result.push_back(std::move(ring));
  }
  return result;
}

}  // namespace weft
