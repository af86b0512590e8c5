// Tested by tests/scenes/drawn_mesh_test.cpp.

#include <array>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/mesh_text.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 7> kDrawnFileKeys = {
    "file", "scale", "up", "part", "weld", "max_distance", "rigid_pieces"};
constexpr std::array<std::string_view, 3> kDrawnDataKeys = {"data", "max_distance", "rigid_pieces"};

Surface stored_surface(const TomlTable& table) {
  table.allow(kDrawnDataKeys);
  const TomlValue data = table.require("data", "a stored mesh");
  try {
    return parse_mesh_text(data.text());
  } catch (const InvalidArgument& error) {
    data.fail(error.what());
  }
}

/// A file is in the frame of the body that it is drawn for: that of its own mesh file, or the world.
Surface imported_surface(const TomlTable& table, const Cloth& cloth) {
  table.allow(kDrawnFileKeys);
  Surface surface = read_mesh_file(table, false).surface;
  const auto* body = std::get_if<MeshBody>(&cloth.source);
  if (body == nullptr) return surface;
  for (auto position : surface.positions.colwise()) {
    const Vector3<double> local = position;
    position = body->position + body->orientation * local;
  }
  return surface;
}

}  // namespace

EmbeddingOptions read_embedding(const TomlTable& table) {
  EmbeddingOptions options;
  if (const auto value = table.find("max_distance")) options.max_distance = value->positive("m");
  if (const auto value = table.find("rigid_pieces")) options.rigid_pieces = value->positive("m");
  return options;
}

DrawnCloth read_drawn_mesh(const TomlValue& value, const Cloth& cloth) {
  const TomlTable table = value.table("a table such as { file = \"shirt_fine.obj\" }");
  Surface surface = table.has("data") ? stored_surface(table) : imported_surface(table, cloth);
  if (surface.positions.cols() > kMaxMeshNodes) {
    value.fail(fmt::format("the mesh has {} vertices, expected at most {}",
                           surface.positions.cols(), kMaxMeshNodes));
  }
  DrawnCloth drawn;
  drawn.surface = std::make_shared<const Surface>(std::move(surface));
  drawn.embedding = read_embedding(table);
  return drawn;
}

namespace {

void check_texture_coordinates(const Surface& surface) {
  ClothMesh mesh;
  mesh.rest_positions = surface.positions;
  mesh.triangles = surface.triangles;
  mesh.corner_texture_coordinates = surface.corner_texture_coordinates;
  if (!corner_coordinates(mesh).allFinite()) {
    throw InvalidArgument("a texture coordinate is not finite, expected a number");
  }
}

}  // namespace

void check_drawn_mesh(const TomlValue& value, const Cloth& cloth) {
  const DrawnCloth& drawn = cloth.drawn_mesh.value();
  try {
    const ClothMesh mesh = make_mesh(cloth);
    check_texture_coordinates(*drawn.surface);
    (void)ClothEmbedding(mesh.rest_positions, mesh.triangles,
                         {drawn.surface->positions, drawn.surface->triangles}, drawn.embedding);
  } catch (const InvalidArgument& error) {
    value.fail(error.what());
  }
}

}  // namespace weft::scenes
