#include <weft/scenes/shapes/shape_surface.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

/// Sides of the polyhedra whose moments stand for those of round solids.
constexpr int kMomentDivisions = 96;

using Profile = std::vector<std::array<double, 2>>;  // radius and height, from bottom to top

/// Turns a profile around the y axis. Its first and last points lie on the axis.
MeshShape turned(const Profile& profile, int divisions) {
  const int rings = static_cast<int>(profile.size()) - 2;
  MeshShape mesh{Matrix3X<double>(3, rings * divisions + 2), Triangles(3, 2 * rings * divisions)};
  const int bottom = rings * divisions;
  const int top = bottom + 1;
  for (int r = 0; r < rings; ++r) {
    const auto [radius, height] = profile[static_cast<std::size_t>(r) + 1];
    for (int i = 0; i < divisions; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / divisions;
      mesh.points.col(r * divisions + i) =
          Vector3<double>(radius * std::cos(angle), height, -radius * std::sin(angle));
    }
  }
  mesh.points.col(bottom) = Vector3<double>(0, profile.front()[1], 0);
  mesh.points.col(top) = Vector3<double>(0, profile.back()[1], 0);
  Eigen::Index t = 0;
  for (int i = 0; i < divisions; ++i) {
    const int next = (i + 1) % divisions;
    mesh.triangles.col(t++) = Vector3<int>(bottom, next, i);
    for (int r = 0; r + 1 < rings; ++r) {
      const int low = r * divisions;
      const int high = low + divisions;
      mesh.triangles.col(t++) = Vector3<int>(low + i, low + next, high + next);
      mesh.triangles.col(t++) = Vector3<int>(low + i, high + next, high + i);
    }
    const int last = (rings - 1) * divisions;
    mesh.triangles.col(t++) = Vector3<int>(last + i, last + next, top);
  }
  return mesh;
}

/// Quarter circles at both ends of a straight piece; a sphere has none.
Profile rounded(double radius, double height, int divisions) {
  Profile profile;
  const int steps = std::max(2, divisions / 4);
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i <= steps; ++i) {
      if (side > 0 && i == 0 && height == 0) continue;  // the equator is there already
      const double latitude = 0.5 * std::numbers::pi * (side < 0 ? i - steps : i) / steps;
      profile.push_back(
          {radius * std::cos(latitude), side * 0.5 * height + radius * std::sin(latitude)});
    }
  }
  return profile;
}

void append(MeshShape& mesh, const MeshShape& other) {
  const Eigen::Index points = mesh.points.cols();
  const Eigen::Index triangles = mesh.triangles.cols();
  mesh.points.conservativeResize(3, points + other.points.cols());
  mesh.points.rightCols(other.points.cols()) = other.points;
  mesh.triangles.conservativeResize(3, triangles + other.triangles.cols());
  mesh.triangles.rightCols(other.triangles.cols()) =
      other.triangles.array() + static_cast<int>(points);
}

struct SurfaceMaker {
  int divisions;

  MeshShape operator()(const SphereShape& s) const {
    return turned(rounded(s.radius, 0.0, divisions), divisions);
  }
  MeshShape operator()(const BoxShape& box) const {
    Matrix3X<double> corners(3, 8);
    for (int i = 0; i < 8; ++i) {
      const Vector3<double> side((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
      corners.col(i) = box.half_extents.cwiseProduct(side);
    }
    return hull_surface({corners});
  }
  MeshShape operator()(const PlaneShape&) const { return {}; }
  MeshShape operator()(const CapsuleShape& s) const {
    return turned(rounded(s.radius, s.height, divisions), divisions);
  }
  MeshShape operator()(const CylinderShape& s) const {
    const double end = 0.5 * s.height;
    return turned({{0, -end}, {s.radius, -end}, {s.radius, end}, {0, end}}, divisions);
  }
  MeshShape operator()(const ConeShape& s) const {
    const double end = 0.5 * s.height;
    return turned({{0, -end}, {s.radius, -end}, {0, end}}, divisions);
  }
  MeshShape operator()(const ConvexHullShape& s) const { return hull_surface(s); }
  MeshShape operator()(const MeshShape& s) const { return s; }
  MeshShape operator()(const CompoundShape& s) const {
    MeshShape mesh;
    for (const CompoundPart& part : s.parts) {
      MeshShape one = std::visit(*this, part.shape);
      one.points = (part.orientation.toRotationMatrix() * one.points).colwise() + part.position;
      append(mesh, one);
    }
    return mesh;
  }
  MeshShape operator()(const HeightFieldShape& s) const { return height_field_surface(s); }
};

/// Sums of tetrahedra between the origin and the triangles of a closed surface.
SolidMoments moments_of(const MeshShape& mesh) {
  SolidMoments sum;
  Vector3<double> squares = Vector3<double>::Zero();  // of coordinates, integrated
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> a = mesh.points.col(mesh.triangles(0, t));
    const Vector3<double> b = mesh.points.col(mesh.triangles(1, t));
    const Vector3<double> c = mesh.points.col(mesh.triangles(2, t));
    const double volume = a.dot(b.cross(c)) / 6.0;
    const Vector3<double> corner_sum = a + b + c;
    sum.volume += volume;
    sum.center += volume / 4.0 * corner_sum;
    squares +=
        volume / 20.0 * (a.cwiseAbs2() + b.cwiseAbs2() + c.cwiseAbs2() + corner_sum.cwiseAbs2());
  }
  sum.center /= sum.volume;
  const Vector3<double> spread = squares / sum.volume - sum.center.cwiseAbs2();
  sum.inertia = Vector3<double>::Constant(spread.sum()) - spread;
  return sum;
}

}  // namespace

MeshShape height_field_surface(const HeightFieldShape& field) {
  const auto columns = static_cast<int>(field.heights.cols());
  const auto rows = static_cast<int>(field.heights.rows());
  MeshShape mesh{Matrix3X<double>(3, rows * columns), Triangles(3, 2 * (rows - 1) * (columns - 1))};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.points.col(j * columns + i) = Vector3<double>(
          field.size[0] * (static_cast<double>(i) / (columns - 1) - 0.5), field.heights(j, i),
          field.size[1] * (static_cast<double>(j) / (rows - 1) - 0.5));
    }
  }
  Eigen::Index t = 0;
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i;  // b = a + 1 lies along x, c = a + columns along z
      mesh.triangles.col(t++) = Vector3<int>(a, a + columns, a + columns + 1);
      mesh.triangles.col(t++) = Vector3<int>(a, a + columns + 1, a + 1);
    }
  }
  return mesh;
}

MeshShape shape_surface(const Shape& shape, int divisions) {
  return std::visit(SurfaceMaker{divisions}, shape);
}

SolidMoments solid_moments(const Shape& shape) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    const double r = sphere->radius;
    return {4.0 / 3.0 * std::numbers::pi * r * r * r, Vector3<double>::Zero(),
            Vector3<double>::Constant(0.4 * r * r)};
  }
  if (const auto* box = std::get_if<BoxShape>(&shape)) {
    const Vector3<double> squared = box->half_extents.cwiseAbs2();
    return {8.0 * box->half_extents.prod(), Vector3<double>::Zero(),
            (Vector3<double>::Constant(squared.sum()) - squared) / 3.0};
  }
  if (std::holds_alternative<PlaneShape>(shape) || std::holds_alternative<MeshShape>(shape) ||
      std::holds_alternative<HeightFieldShape>(shape)) {
    throw InvalidArgument("moments of a plane, mesh or height field, expected a solid shape");
  }
  return moments_of(shape_surface(shape, kMomentDivisions));
}

}  // namespace weft::scenes
