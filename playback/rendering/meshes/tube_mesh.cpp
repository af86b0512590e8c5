#include <weft/playback/rendering/meshes/tube_mesh.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

namespace weft::scenes {
namespace {

constexpr int kSides = 14;
constexpr int kCapRings = 4;

using Chain = std::vector<int>;

struct Graph {
  Graph(const Edges& edges, Eigen::Index num_nodes)
      : edges_of(static_cast<std::size_t>(num_nodes)),
        is_used(static_cast<std::size_t>(edges.cols()), false) {
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      for (int k = 0; k < 2; ++k) edges_of[static_cast<std::size_t>(edges(k, e))].push_back(e);
    }
  }
  std::vector<std::vector<Eigen::Index>> edges_of;
  std::vector<bool> is_used;
};

/// Follows unused edges from a node for as long as there is only one way to go.
Chain follow(const Edges& edges, Graph& graph, int start, Eigen::Index edge) {
  Chain chain{start};
  while (true) {
    graph.is_used[static_cast<std::size_t>(edge)] = true;
    const int next = edges(0, edge) == chain.back() ? edges(1, edge) : edges(0, edge);
    chain.push_back(next);
    const auto& around = graph.edges_of[static_cast<std::size_t>(next)];
    if (around.size() != 2) return chain;
    edge = around[0] == edge ? around[1] : around[0];
    if (graph.is_used[static_cast<std::size_t>(edge)]) return chain;
  }
}

/// Every edge in one chain: first those that begin at an end or a junction, then closed rings.
std::vector<Chain> make_chains(const Edges& edges, Eigen::Index num_nodes) {
  Graph graph(edges, num_nodes);
  std::vector<Chain> chains;
  for (const bool rings : {false, true}) {
    for (int node = 0; node < num_nodes; ++node) {
      const auto around = graph.edges_of[static_cast<std::size_t>(node)];
      if (!rings && around.size() == 2) continue;
      for (const Eigen::Index edge : around) {
        if (!graph.is_used[static_cast<std::size_t>(edge)]) {
          chains.push_back(follow(edges, graph, node, edge));
        }
      }
    }
  }
  return chains;
}

struct Ring {
  Vector3<double> center;
  Vector3<double> tangent;  ///< unit
  int node;
};

class TubeBuilder {
 public:
  TubeBuilder(SurfaceMesh& mesh, double radius) : mesh_(mesh), radius_(radius) {}

  void add(const std::vector<Ring>& rings) {
    if (rings.size() < 2) return;
    const Vector3<double>& first = rings.front().tangent;
    Eigen::Index axis = 0;
    first.cwiseAbs().minCoeff(&axis);
    across_ = Vector3<double>::Unit(axis);
    rows_ = 0;
    const double length = static_cast<double>(rings.size() - 1);
    for (int i = 0; i < kCapRings; ++i) add_cap_row(rings.front(), i, -1.0, 0.0);
    for (std::size_t i = 0; i < rings.size(); ++i) {
      add_row(rings[i], 1.0, 0.0, static_cast<double>(i) / length);
    }
    for (int i = kCapRings - 1; i >= 0; --i) add_cap_row(rings.back(), i, 1.0, 1.0);
  }

 private:
  /// Rows of the half ball at an end, the pole is row 0.
  void add_cap_row(const Ring& ring, int row, double side, double along) {
    const double angle = 0.5 * std::numbers::pi * row / kCapRings;
    add_row(ring, std::sin(angle), side * std::cos(angle), along);
  }

  void add_row(const Ring& ring, double out, double ahead, double along) {
    // Carried from ring to ring without twist.
    across_ -= across_.dot(ring.tangent) * ring.tangent;
    if (across_.norm() < 1e-9) across_ = ring.tangent.unitOrthogonal();
    across_.normalize();
    const Vector3<double> up = ring.tangent.cross(across_);
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    constexpr auto kStride = static_cast<std::uint32_t>(kSides + 1);
    for (int k = 0; k <= kSides; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kSides;
      const Vector3<double> normal =
          out * (std::cos(angle) * across_ + std::sin(angle) * up) + ahead * ring.tangent;
      mesh_.vertices.push_back(body_vertex(ring.center + radius_ * normal, normal,
                                           {static_cast<double>(k) / kSides, along}));
      mesh_.nodes.push_back(ring.node);
    }
    if (rows_++ == 0) return;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(kSides); ++k) {
      const std::uint32_t a = first - kStride + k;
      mesh_.indices.insert(mesh_.indices.end(),
                           {a, a + 1, a + kStride, a + 1, a + kStride + 1, a + kStride});
    }
  }

  SurfaceMesh& mesh_;
  double radius_;
  Vector3<double> across_{1, 0, 0};
  int rows_ = 0;
};

}  // namespace

SurfaceMesh tube_surface(const Edges& edges, ConstMatrix3XRef<double> positions, double radius,
                         const DrawLimits& limits) {
  SurfaceMesh mesh;
  TubeBuilder builder(mesh, radius);
  for (const Chain& chain : make_chains(edges, positions.cols())) {
    std::vector<Ring> rings;
    const auto flush = [&] {
      for (std::size_t i = 0; i < rings.size(); ++i) {
        const Ring& before = rings[i == 0 ? 0 : i - 1];
        const Ring& after = rings[i + 1 == rings.size() ? i : i + 1];
        const Vector3<double> way = after.center - before.center;
        rings[i].tangent = way.norm() > 0.0 ? way.normalized() : Vector3<double>::UnitY();
      }
      builder.add(rings);
      rings.clear();
    };
    for (const int node : chain) {
      const Vector3<double> x = positions.col(node) - limits.origin;
      if (x.allFinite() && x.cwiseAbs().maxCoeff() <= limits.largest) {
        rings.push_back({x, Vector3<double>::UnitY(), node});
      } else {
        flush();
      }
    }
    flush();
  }
  return mesh;
}

}  // namespace weft::scenes
