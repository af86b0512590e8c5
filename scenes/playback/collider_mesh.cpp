#include <weft/scenes/playback/collider_mesh.hpp>

#include <weft/scenes/playback/shape_mesh.hpp>

namespace weft::scenes {
namespace {

SurfaceMesh surface_of(const SphereShape& sphere) {
  return sphere_surface(sphere.radius);
}

SurfaceMesh surface_of(const BoxShape& box) {
  return box_surface(box.half_extents);
}

SurfaceMesh surface_of(const PlaneShape&) {
  return {};
}

}  // namespace

SurfaceMesh collider_surface(const Shape& shape) {
  return std::visit([](const auto& any) { return surface_of(any); }, shape);
}

}  // namespace weft::scenes
