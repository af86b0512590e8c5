// Tested by tests/mesh/embedding/torn_embedding_test.cpp.

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/mesh/embedding/cloth_embedding.hpp>

namespace weft {
namespace {

/// Which triangles of a cloth a tear has parted.
class PartedTriangles {
 public:
  PartedTriangles(const Triangles& whole, const Triangles& torn, int num_nodes)
      : whole_(whole), torn_(torn), is_split_(static_cast<std::size_t>(num_nodes), false) {
    std::vector<int> now(static_cast<std::size_t>(num_nodes), -1);
    for (Eigen::Index t = 0; t < whole.cols(); ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        const auto node = static_cast<std::size_t>(whole(corner, t));
        if (now[node] < 0) now[node] = torn(corner, t);
        if (now[node] != torn(corner, t)) is_split_[node] = true;
      }
    }
  }

  /// Whether they shared a node that they no longer share. Triangles that shared none, because a drawn triangle is larger than those of
  /// the cloth, count as parted where a node of one of them has come apart.
  [[nodiscard]] bool operator()(int s, int t) const {
    if (s == t) return false;
    bool is_shared = false;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (whole_(i, s) != whole_(j, t)) continue;
        if (torn_(i, s) != torn_(j, t)) return true;
        is_shared = true;
      }
    }
    return !is_shared && (has_split(s) || has_split(t));
  }

 private:
  [[nodiscard]] bool has_split(int t) const {
    const auto is_split = [&](int node) { return is_split_[static_cast<std::size_t>(node)]; };
    return is_split(whole_(0, t)) || is_split(whole_(1, t)) || is_split(whole_(2, t));
  }

  const Triangles& whole_;
  const Triangles& torn_;
  std::vector<bool> is_split_;  ///< by node of the whole cloth
};

/// The corner on whose side a drawn triangle stays, of the triangles of the cloth below its corners.
int leading_corner(const std::array<int, 3>& below, const PartedTriangles& is_parted) {
  for (int corner = 0; corner < 3; ++corner) {
    const auto c = static_cast<std::size_t>(corner);
    if (!is_parted(below[c], below[(c + 1) % 3])) return corner;
  }
  return 0;
}

}  // namespace

BoundPoint ClothEmbedding::bound_beside(int vertex, int triangle) const {
  const Vector3<double> point = drawn_positions_.col(vertex);
  const Matrix3<double> corners = rest_positions_(Eigen::all, whole_triangles_.col(triangle));
  const Vector3<double> u = corners.col(1) - corners.col(0);
  const Vector3<double> v = corners.col(2) - corners.col(0);
  const Vector3<double> normal = u.cross(v);
  const Vector3<double> from = point - corners.col(0);
  const double scale = 1 / normal.squaredNorm();
  const double b = from.cross(v).dot(normal) * scale;
  const double c = u.cross(from).dot(normal) * scale;
  return bind_point(point, {triangle, {1 - b - c, b, c}}, corners,
                    rest_normals_(Eigen::all, whole_triangles_.col(triangle)));
}

void ClothEmbedding::follow_tear(const Triangles& triangles, int num_nodes) {
  if (triangles.cols() != whole_triangles_.cols()) {
    throw InvalidArgument("embedding: " + std::to_string(triangles.cols()) +
                          " triangles of a torn cloth, expected " +
                          std::to_string(whole_triangles_.cols()) + " as before it tore");
  }
  if (triangles.minCoeff() < 0 || triangles.maxCoeff() >= num_nodes) {
    throw InvalidArgument(
        "embedding: a triangle of a torn cloth names a node that is not there, expected 0 to " +
        std::to_string(num_nodes - 1));
  }
  frames_.change_nodes(triangles, num_nodes);
  const auto num_first = static_cast<std::size_t>(drawn_positions_.cols());
  bound_.resize(num_first);
  piece_of_.resize(num_first);
  copied_.clear();
  drawn_triangles_ = whole_drawn_;
  const PartedTriangles is_parted(whole_triangles_, triangles,
                                  static_cast<int>(rest_positions_.cols()));
  std::map<std::pair<int, int>, int> copies;  // by vertex and the triangle that leads it
  for (auto drawn : drawn_triangles_.colwise()) {
    std::array<int, 3> below{};
    bool is_rigid = false;
    for (int corner = 0; corner < 3; ++corner) {
      const auto vertex = static_cast<std::size_t>(drawn[corner]);
      is_rigid = is_rigid || piece_of_[vertex] >= 0;
      below[static_cast<std::size_t>(corner)] = bound_[vertex].triangle;
    }
    if (is_rigid) continue;
    const int leader = below[static_cast<std::size_t>(leading_corner(below, is_parted))];
    for (int corner = 0; corner < 3; ++corner) {
      if (!is_parted(leader, below[static_cast<std::size_t>(corner)])) continue;
      const int vertex = drawn[corner];
      const auto [copy, is_new] =
          copies.try_emplace({vertex, leader}, static_cast<int>(bound_.size()));
      if (is_new) {
        copied_.push_back(vertex);
        bound_.push_back(bound_beside(vertex, leader));
        piece_of_.push_back(-1);
      }
      drawn[corner] = copy->second;
    }
  }
  const auto num_copied = static_cast<Eigen::Index>(copied_.size());
  const auto extend = [&](Matrix3X<double>& directions) {
    if (directions.cols() == 0) return;
    directions.conservativeResize(3, static_cast<Eigen::Index>(num_first) + num_copied);
    for (Eigen::Index i = 0; i < num_copied; ++i) {
      directions.col(static_cast<Eigen::Index>(num_first) + i) =
          directions.col(copied_[static_cast<std::size_t>(i)]);
    }
  };
  extend(normals_);
  extend(tangents_);
}

}  // namespace weft
