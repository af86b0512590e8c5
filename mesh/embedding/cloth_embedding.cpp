#include <weft/mesh/embedding/cloth_embedding.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/mesh/embedding/connected_pieces.hpp>

namespace weft {
namespace {

void require_embedding(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("embedding: " + message);
}

void check_length(const std::optional<double>& length, const std::string& name) {
  require_embedding(
      !length || (std::isfinite(*length) && *length > 0),
      name + " = " + std::to_string(length.value_or(0)) + " [m], expected > 0 and finite, or none");
}

void check_nodes(const Triangles& triangles, int num_nodes) {
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (const int node : triangles.col(t)) {
      require_embedding(node >= 0 && node < num_nodes,
                        "triangle " + std::to_string(t) + " of the cloth names node " +
                            std::to_string(node) + ", expected 0 to " +
                            std::to_string(num_nodes - 1));
    }
  }
}

const Triangles& checked_cloth(ConstMatrix3XRef<double> rest_positions,
                               const Triangles& triangles) {
  require_embedding(rest_positions.allFinite(), "a rest position of the cloth is not finite");
  require_embedding(triangles.cols() > 0, "the cloth has no triangle, expected a surface");
  check_nodes(triangles, static_cast<int>(rest_positions.cols()));
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vector3<double> a = rest_positions.col(triangles(0, t));
    const Vector3<double> b = rest_positions.col(triangles(1, t));
    const Vector3<double> c = rest_positions.col(triangles(2, t));
    require_embedding((b - a).cross(c - a).norm() > 0,
                      "triangle " + std::to_string(t) + " of the cloth has no area, expected one");
  }
  return triangles;
}

/// Two unit vectors that span the plane across a unit normal, chosen by the axis that is least along it.
Matrix3<double> axes_around(const Vector3<double>& normal) {
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  Matrix3<double> axes;
  axes.col(0) = normal;
  axes.col(1) = normal.cross(Vector3<double>(Vector3<double>::Unit(axis))).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

ClothEmbedding::ClothEmbedding(ConstMatrix3XRef<double> rest_positions, const Triangles& triangles,
                               const DrawnMesh& drawn, const EmbeddingOptions& options)
    : rest_positions_(rest_positions),
      whole_triangles_(checked_cloth(rest_positions, triangles)),
      frames_(rest_positions, triangles),
      whole_drawn_(drawn.triangles),
      drawn_triangles_(drawn.triangles),
      drawn_positions_(drawn.positions),
      normals_(drawn.normals),
      tangents_(drawn.tangents) {
  check_drawn_mesh(drawn);
  check_length(options.max_distance, "max_distance");
  check_length(options.rigid_pieces, "rigid_pieces");
  rest_normals_ = surface_normals(rest_positions, triangles);
  if (normals_.cols() == 0) normals_ = surface_normals(drawn.positions, drawn.triangles);
  const FootPoints feet(rest_positions_, whole_triangles_, rest_normals_);
  bind_vertices(feet, drawn);
  if (options.rigid_pieces) bind_pieces(feet, drawn, *options.rigid_pieces);
  check_distances(drawn, options);
}

void ClothEmbedding::bind_vertices(const FootPoints& feet, const DrawnMesh& drawn) {
  for (Eigen::Index v = 0; v < drawn.positions.cols(); ++v) {
    const Vector3<double> point = drawn.positions.col(v);
    const SurfacePoint place = feet.foot(point);
    const Eigen::Vector3i nodes = whole_triangles_.col(place.triangle);
    bound_.push_back(bind_point(point, place, rest_positions_(Eigen::all, nodes),
                                rest_normals_(Eigen::all, nodes)));
  }
  piece_of_.assign(bound_.size(), -1);
}

void ClothEmbedding::bind_pieces(const FootPoints& feet, const DrawnMesh& drawn, double largest) {
  for (const std::vector<int>& piece : connected_pieces(drawn.positions, drawn.triangles)) {
    const auto points = drawn.positions(Eigen::all, piece);
    const Vector3<double> low = points.rowwise().minCoeff();
    const Vector3<double> high = points.rowwise().maxCoeff();
    if ((high - low).norm() > largest) continue;
    const Vector3<double> middle = 0.5 * (low + high);
    const SurfacePoint place = feet.foot(middle);
    const Eigen::Vector3i nodes = whole_triangles_.col(place.triangle);
    const BoundPoint anchor = bind_point(middle, place, rest_positions_(Eigen::all, nodes),
                                         rest_normals_(Eigen::all, nodes));
    for (const int vertex : piece) {
      const auto v = static_cast<std::size_t>(vertex);
      piece_of_[v] = static_cast<int>(pieces_.size());
      bound_[v].arms.col(0) = drawn.positions.col(vertex) - middle;
    }
    pieces_.push_back({anchor, axes_around(anchor.normal)});
  }
  report_.num_rigid_pieces = static_cast<int>(pieces_.size());
}

void ClothEmbedding::check_distances(const DrawnMesh& drawn, const EmbeddingOptions& options) {
  int num_far = 0;
  for (int v = 0; v < num_vertices(); ++v) {
    const BoundPoint& point = bound_[static_cast<std::size_t>(v)];
    const Vector3<double> base = rest_positions_(Eigen::all, nodes_of(point)) * point.weights;
    const double distance = (drawn.positions.col(v) - base).norm();
    if (options.max_distance && distance > *options.max_distance) ++num_far;
    if (distance <= report_.largest_distance) continue;
    report_.largest_distance = distance;
    report_.farthest_vertex = v;
  }
  require_embedding(num_far == 0, "vertex " + std::to_string(report_.farthest_vertex) +
                                      " of the drawn mesh is " +
                                      std::to_string(report_.largest_distance) +
                                      " m from the cloth, expected at most " +
                                      std::to_string(options.max_distance.value_or(0)) + " m (" +
                                      std::to_string(num_far) + " vertices are farther)");
}

int ClothEmbedding::original(int vertex) const {
  const auto num_first = static_cast<int>(drawn_positions_.cols());
  return vertex < num_first ? vertex : copied_[static_cast<std::size_t>(vertex - num_first)];
}

int ClothEmbedding::nearest_node(int vertex) const {
  const int piece = piece_of_[static_cast<std::size_t>(vertex)];
  const BoundPoint& point = piece < 0 ? bound_[static_cast<std::size_t>(vertex)]
                                      : pieces_[static_cast<std::size_t>(piece)].anchor;
  int corner = 0;
  point.weights.maxCoeff(&corner);
  return nodes_of(point)[corner];
}

ClothPose ClothEmbedding::make_pose() const {
  ClothPose pose;
  const auto num_pieces = static_cast<Eigen::Index>(pieces_.size());
  pose.positions = Matrix3X<double>::Zero(3, num_nodes());
  pose.frames = Matrix3X<double>::Zero(3, 3 * num_nodes());
  pose.piece_positions = Matrix3X<double>::Zero(3, num_pieces);
  pose.piece_rotations = Matrix3X<double>::Zero(3, 3 * num_pieces);
  return pose;
}

void ClothEmbedding::set_pose(ConstMatrix3XRef<double> positions, ClothPose& pose) const {
  if (positions.cols() != num_nodes()) {
    throw InvalidArgument("embedding: " + std::to_string(positions.cols()) +
                          " positions of nodes, expected " + std::to_string(num_nodes()));
  }
  pose.positions = positions;
  update_pose(pose);
}

void ClothEmbedding::update_pose(ClothPose& pose) const {
  frames_.compute(pose.positions, pose.frames);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const RigidPiece& piece = pieces_[p];
    const auto column = static_cast<Eigen::Index>(p);
    const PlacedPoint placed =
        place_point(piece.anchor, nodes_of(piece.anchor), pose.positions, pose.frames);
    Matrix3<double> axes;
    axes.col(0) = unit_or_zero(placed.cofactors * piece.axes.col(0));
    const Vector3<double> along = placed.gradient * piece.axes.col(1);
    axes.col(1) = unit_or_zero(along - axes.col(0).dot(along) * axes.col(0));
    axes.col(2) = axes.col(0).cross(axes.col(1));
    pose.piece_positions.col(column) = placed.position;
    pose.piece_rotations.middleCols<3>(3 * column) = axes * piece.axes.transpose();
  }
}

DrawnVertex ClothEmbedding::vertex(const ClothPose& pose, int vertex) const {
  DrawnVertex drawn;
  const Vector3<double> normal = normals_.col(vertex);
  const bool has_tangents = tangents_.cols() > 0;
  const Vector3<double> tangent =
      has_tangents ? Vector3<double>(tangents_.col(vertex)) : Vector3<double>(0, 0, 0);
  const BoundPoint& point = bound_[static_cast<std::size_t>(vertex)];
  const int piece = piece_of_[static_cast<std::size_t>(vertex)];
  if (piece >= 0) {
    const Matrix3<double> rotation = pose.piece_rotations.middleCols<3>(3 * piece);
    drawn.position = pose.piece_positions.col(piece) + rotation * point.arms.col(0);
    drawn.normal = rotation * normal;
    drawn.tangent = rotation * tangent;
    return drawn;
  }
  const PlacedPoint placed = place_point(point, nodes_of(point), pose.positions, pose.frames);
  drawn.position = placed.position;
  drawn.normal = unit_or_zero(placed.cofactors * normal);
  drawn.tangent = unit_or_zero(placed.gradient * tangent);
  return drawn;
}

}  // namespace weft
