#include <weft/mesh/topology/hinges.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>

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
  std::span<const Side> sides;
};

/// Every edge of the triangles once, in the order in which they name them.
class SharedEdges {
 public:
  explicit SharedEdges(const Triangles& triangles);
  [[nodiscard]] std::size_t size() const { return edges_.size(); }
  [[nodiscard]] SharedEdge operator[](std::size_t e) const {
    const Edge& edge = edges_[e];
    return {edge.first, edge.second,
            std::span(sides_).subspan(edge.first_side, edge.last_side - edge.first_side)};
  }

 private:
  struct Edge {
    int first;
    int second;
    std::size_t first_side;
    std::size_t last_side;  ///< one past the last
  };
  std::vector<Edge> edges_;
  std::vector<Side> sides_;
};

/// A side by its place, 3 t + corner.
struct NamedSide {
  int second;  ///< higher node
  std::size_t place;
  bool operator<(const NamedSide& other) const {
    return std::pair(second, place) < std::pair(other.second, other.place);
  }
};

// By counting and small sorts, not by a map: a cloth that tears has its hinges found anew between two frames.
SharedEdges::SharedEdges(const Triangles& triangles) {
  if (triangles.size() > 0 && triangles.minCoeff() < 0) {
    throw InvalidArgument("hinges: a triangle names node " + std::to_string(triangles.minCoeff()) +
                          ", expected >= 0");
  }
  const auto num_sides = static_cast<std::size_t>(triangles.size());
  const int num_nodes = num_sides > 0 ? triangles.maxCoeff() + 1 : 0;
  const auto ends = [&](std::size_t place) {
    const auto t = static_cast<Eigen::Index>(place / 3);
    const auto corner = static_cast<Eigen::Index>(place % 3);
    return std::pair(triangles(corner, t), triangles((corner + 1) % 3, t));
  };
  std::vector<std::size_t> first_of(static_cast<std::size_t>(num_nodes) + 1, 0);
  for (std::size_t place = 0; place < num_sides; ++place) {
    const auto [from, to] = ends(place);
    ++first_of[static_cast<std::size_t>(std::min(from, to)) + 1];
  }
  std::partial_sum(first_of.begin(), first_of.end(), first_of.begin());
  std::vector<NamedSide> named(num_sides);
  std::vector<std::size_t> next(first_of.begin(), first_of.end());
  for (std::size_t place = 0; place < num_sides; ++place) {
    const auto [from, to] = ends(place);
    named[next[static_cast<std::size_t>(std::min(from, to))]++] = {std::max(from, to), place};
  }
  std::vector<Edge> edge_named_at(num_sides, Edge{-1, -1, 0, 0});
  sides_.reserve(num_sides);
  for (int node = 0; node < num_nodes; ++node) {
    const auto at = static_cast<std::size_t>(node);
    std::sort(named.begin() + static_cast<std::ptrdiff_t>(first_of[at]),
              named.begin() + static_cast<std::ptrdiff_t>(first_of[at + 1]));
    for (std::size_t k = first_of[at]; k < first_of[at + 1];) {
      Edge& edge = edge_named_at[named[k].place];
      edge = {node, named[k].second, sides_.size(), 0};
      for (; k < first_of[at + 1] && named[k].second == edge.second; ++k) {
        const auto t = static_cast<Eigen::Index>(named[k].place / 3);
        const auto corner = static_cast<Eigen::Index>(named[k].place % 3);
        sides_.push_back({t, triangles(corner, t), triangles((corner + 2) % 3, t)});
      }
      edge.last_side = sides_.size();
    }
  }
  edges_.reserve(num_sides / 2);
  for (const Edge& edge : edge_named_at) {
    if (edge.first >= 0) edges_.push_back(edge);
  }
}

std::string name_of(const SharedEdge& edge) {
  return "the edge between nodes " + std::to_string(edge.first) + " and " +
         std::to_string(edge.second);
}

}  // namespace

Edges edges_of_triangles(const Triangles& triangles) {
  const SharedEdges shared(triangles);
  Edges edges(2, static_cast<Eigen::Index>(shared.size()));
  for (std::size_t e = 0; e < shared.size(); ++e) {
    edges.col(static_cast<Eigen::Index>(e)) << shared[e].first, shared[e].second;
  }
  return edges;
}

Hinges hinges_of_triangles(const Triangles& triangles) {
  std::vector<Eigen::Vector4i> hinges;
  const SharedEdges shared(triangles);
  for (std::size_t e = 0; e < shared.size(); ++e) {
    const SharedEdge edge = shared[e];
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

Hinges bending_hinges(const ClothMesh& mesh) {
  const Hinges one_way = hinges_of_triangles(mesh.triangles);
  const Hinges other_way = hinges_of_triangles(mesh.crossed_triangles);
  Hinges hinges(4, one_way.cols() + other_way.cols());
  hinges << one_way, other_way;
  return hinges;
}

bool is_closed_surface(const Triangles& triangles) {
  const SharedEdges edges(triangles);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::span<const Side> sides = edges[e].sides;
    if (sides.size() != 2 || sides[0].from == sides[1].from) return false;
  }
  return edges.size() > 0;
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
