#include <weft/playback/rendering/meshes/collider_mesh.hpp>

#include <weft/playback/rendering/meshes/shape_mesh.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

/// Faces that meet at less are drawn as one round surface: 30 degrees are a polygon of 12 sides. [rad]
constexpr double kCrease = 0.5236;

SurfaceMesh surface_of(const SphereShape& sphere) {
  return sphere_surface(sphere.radius);
}

SurfaceMesh surface_of(const BoxShape& box) {
  return box_surface(box.half_extents);
}

SurfaceMesh surface_of(const PlaneShape&) {
  return {};
}

SurfaceMesh surface_of(const CapsuleShape& capsule) {
  return capsule_surface(capsule.radius, 0.5 * capsule.height);
}

SurfaceMesh surface_of(const CylinderShape& cylinder) {
  return cylinder_surface(cylinder.radius, 0.5 * cylinder.height);
}

SurfaceMesh surface_of(const ConeShape& cone) {
  return cone_surface(cone.radius, 0.5 * cone.height);
}

SurfaceMesh surface_of(const MeshShape& mesh) {
  return triangle_surface(mesh.points, mesh.triangles, kCrease);
}

SurfaceMesh surface_of(const ConvexHullShape& hull) {
  return surface_of(hull_surface(hull));
}

SurfaceMesh surface_of(const HeightFieldShape& field) {
  return surface_of(height_field_surface(field));
}

SurfaceMesh surface_of(const CompoundShape& compound) {
  SurfaceMesh mesh;
  for (const CompoundPart& part : compound.parts) {
    const SurfaceMesh surface =
        std::visit([](const auto& shape) { return surface_of(shape); }, part.shape);
    append_surface(mesh, surface, Eigen::Translation3d(part.position) * part.orientation);
  }
  return mesh;
}

}  // namespace

SurfaceMesh collider_surface(const Shape& shape) {
  return std::visit([](const auto& any) { return surface_of(any); }, shape);
}

}  // namespace weft::scenes
