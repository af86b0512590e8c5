#include <weft/engines/bullet/bullet_concave.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

using bridge::to_bullet;

constexpr double kDepthRatio = 0.25;      // of a mesh's smallest extent
constexpr double kOppositeShare = 0.45;   // of the way to the opposite side
constexpr double kFieldDepthRatio = 0.5;  // of a height field's shorter side
/// Bullet's search for the depth of a point needs a little roundness; the surface lies this much
/// of an edge outside its place.
constexpr double kPrismMarginRatio = 0.001;

/// A compound of prisms, and the prisms, which it does not own itself.
struct OwnedPrisms {
  std::vector<std::unique_ptr<btCollisionShape>> children;
  btCompoundShape compound;
};

/// A prism between every triangle and the same triangle of `behind`.
std::shared_ptr<btCollisionShape> prisms_between(const MeshShape& mesh,
                                                 const Matrix3X<double>& behind) {
  auto owned = std::make_shared<OwnedPrisms>();
  btTransform here;
  here.setIdentity();
  const auto margin = static_cast<btScalar>(kPrismMarginRatio * mean_edge_length(mesh));
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    auto prism = std::make_unique<btConvexHullShape>();
    for (const int point : mesh.triangles.col(t)) {
      prism->addPoint(to_bullet(mesh.points.col(point)), false);
      prism->addPoint(to_bullet(behind.col(point)), false);
    }
    prism->setMargin(margin);
    prism->recalcLocalAabb();
    owned->compound.addChildShape(here, prism.get());
    owned->children.push_back(std::move(prism));
  }
  return {owned, &owned->compound};
}

Vector3<double> triangle_normal(const MeshShape& mesh, Eigen::Index t) {
  const Vector3<double> a = mesh.points.col(mesh.triangles(0, t));
  const Vector3<double> b = mesh.points.col(mesh.triangles(1, t));
  const Vector3<double> c = mesh.points.col(mesh.triangles(2, t));
  return (b - a).cross(c - a);
}

/// Unit normals of the points, weighted by area; zero where the triangles cancel.
Matrix3X<double> point_normals(const MeshShape& mesh) {
  Matrix3X<double> normals = Matrix3X<double>::Zero(3, mesh.points.cols());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> normal = triangle_normal(mesh, t);
    for (const int point : mesh.triangles.col(t)) normals.col(point) += normal;
  }
  for (Eigen::Index i = 0; i < normals.cols(); ++i) normals.col(i).stableNormalize();
  return normals;
}

/// Way from a point along a direction to the first triangle that it does not belong to [m];
/// infinite if there is none.
double way_to_surface(const MeshShape& mesh, int from, const Vector3<double>& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  const Vector3<double> origin = mesh.points.col(from);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    if ((mesh.triangles.col(t).array() == from).any()) continue;
    const Vector3<double> a = mesh.points.col(mesh.triangles(0, t));
    const Vector3<double> ab = Vector3<double>(mesh.points.col(mesh.triangles(1, t))) - a;
    const Vector3<double> ac = Vector3<double>(mesh.points.col(mesh.triangles(2, t))) - a;
    const Vector3<double> p = direction.cross(ac);
    const double det = ab.dot(p);
    if (std::abs(det) < std::numeric_limits<double>::min()) continue;
    const Vector3<double> ao = origin - a;
    const double u = ao.dot(p) / det;
    const Vector3<double> q = ao.cross(ab);
    const double v = direction.dot(q) / det;
    const double way = ac.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && way > 0) nearest = std::min(nearest, way);
  }
  return nearest;
}

/// Bullet's mesh and the arrays that it reads.
struct OwnedTriangles {
  explicit OwnedTriangles(const MeshShape& mesh)
      : points(mesh.points.cast<btScalar>()), triangles(mesh.triangles) {
    interface.addIndexedMesh(indexed());
    shape = std::make_unique<btBvhTriangleMeshShape>(&interface, true);
  }

  [[nodiscard]] btIndexedMesh indexed() {
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(triangles.cols());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(triangles.data());
    part.m_triangleIndexStride = 3 * sizeof(int);
    part.m_numVertices = static_cast<int>(points.cols());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(points.data());
    part.m_vertexStride = 3 * sizeof(btScalar);
    part.m_vertexType = sizeof(btScalar) == sizeof(double) ? PHY_DOUBLE : PHY_FLOAT;
    return part;
  }

  Matrix3X<btScalar> points;
  Triangles triangles;
  btTriangleIndexVertexArray interface;
  std::unique_ptr<btBvhTriangleMeshShape> shape;
};

}  // namespace

double mean_edge_length(const MeshShape& mesh) {
  double sum = 0.0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      sum +=
          (mesh.points.col(mesh.triangles(k, t)) - mesh.points.col(mesh.triangles((k + 1) % 3, t)))
              .norm();
    }
  }
  return sum / static_cast<double>(3 * mesh.triangles.cols());
}

std::shared_ptr<btCollisionShape> make_prisms(const MeshShape& mesh) {
  const Matrix3X<double> normals = point_normals(mesh);
  const double extent =
      (mesh.points.rowwise().maxCoeff() - mesh.points.rowwise().minCoeff()).minCoeff();
  // An open, flat mesh has no extent: its prisms are as deep as its triangles are wide.
  const double deepest = extent > 0 ? kDepthRatio * extent : mean_edge_length(mesh);
  Matrix3X<double> behind = mesh.points;
  for (int i = 0; i < mesh.points.cols(); ++i) {
    const double way = way_to_surface(mesh, i, -normals.col(i));
    behind.col(i) -= std::min(deepest, kOppositeShare * way) * normals.col(i);
  }
  return prisms_between(mesh, behind);
}

std::shared_ptr<btCollisionShape> make_prisms(const HeightFieldShape& field) {
  const MeshShape mesh = height_field_surface(field);
  Matrix3X<double> behind = mesh.points;
  behind.row(1).setConstant(mesh.points.row(1).minCoeff() -
                            kFieldDepthRatio * std::min(field.size[0], field.size[1]));
  return prisms_between(mesh, behind);
}

std::shared_ptr<btCollisionShape> make_triangle_mesh(const MeshShape& mesh) {
  auto owned = std::make_shared<OwnedTriangles>(mesh);
  return {owned, owned->shape.get()};
}

}  // namespace weft::scenes
