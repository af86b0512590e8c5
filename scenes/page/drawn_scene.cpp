#include <weft/scenes/page/drawn_scene.hpp>

#include <memory>
#include <variant>

namespace weft::scenes {

Scene drawn_scene(Scene scene) {
  for (Cloth& cloth : scene.cloths) {
    const auto* skin = std::get_if<SkinSource>(&cloth.source);
    if (skin == nullptr) continue;
    const ClothMesh mesh = make_source_mesh(cloth.source);
    auto shape = std::make_shared<MeshGeometry>();
    shape->surface.positions = mesh.rest_positions;
    shape->surface.triangles = mesh.triangles;
    shape->surface.corner_texture_coordinates = mesh.corner_texture_coordinates;
    MeshBody body;
    body.total_mass = skin->total_mass;
    body.lumping = skin->lumping;
    body.shape = std::move(shape);
    cloth.source = std::move(body);
  }
  for (Collider& collider : scene.colliders) collider.led_by.clear();
  scene.characters.clear();
  scene.controllers.clear();
  return scene;
}

}  // namespace weft::scenes
