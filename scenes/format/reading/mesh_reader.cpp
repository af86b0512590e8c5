// Tested by tests/scenes/body_sources_test.cpp.

#include <array>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/mesh_text.hpp>
#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

constexpr std::array<std::string_view, 7> kFileKeys = {
    "file", "scale", "up", "part", "weld", "center_node", "center_mass_share"};
constexpr std::array<std::string_view, 3> kDataKeys = {"data", "center_node", "center_mass_share"};
constexpr std::array<std::string_view, 2> kUpWords = {"y", "z"};

}  // namespace

import::ImportedMesh read_mesh_file(const TomlTable& table, bool is_body){
    const TomlValue file = table.require("file", "a mesh file such as \"shirt.obj\"");
import::ImportOptions options;
options.is_body = is_body;
if (const auto value = table.find("scale")) options.scale = value->positive("1");
if (const auto value = table.find("up")) {
  options.up = static_cast<import::UpAxis>(value->choice(kUpWords, "axis"));
}
if (const auto value = table.find("part")) options.part = value->text();
if (const auto value = table.find("weld")) options.weld_tolerance = value->non_negative("m");
const std::string name = file.text();
const import::MeshInput input{name, file.named_file("a mesh file"),
                              files_beside(file.files(), name)};
try {
  return import::import_mesh(input, options);
} catch (const InvalidArgument& error) {
  file.fail(error.what());
}
}  // namespace weft::scenes

namespace {

MeshGeometry import_shape(const TomlTable& table) {
  table.allow(kFileKeys);
  import::ImportedMesh mesh = read_mesh_file(table, true);
  return {std::move(mesh.surface), std::move(mesh.groups)};
}

MeshGeometry stored_shape(const TomlTable& table) {
  table.allow(kDataKeys);
  const TomlValue data = table.require("data", "a stored mesh");
  try {
    return {parse_mesh_text(data.text())};
  } catch (const InvalidArgument& error) {
    data.fail(error.what());
  }
}

}  // namespace

MeshBody read_mesh_body(const TomlTable& cloth) {
  const std::string expected = "a table such as { file = \"shirt.obj\" }";
  const TomlValue value = cloth.require("mesh", expected);
  const TomlTable table = value.table(expected);
  MeshGeometry shape = table.has("data") ? stored_shape(table) : import_shape(table);
  const Eigen::Index num_nodes = shape.surface.positions.cols();
  if (num_nodes > kMaxMeshNodes) {
    table.fail(fmt::format("the mesh has {} nodes, expected at most {}", num_nodes, kMaxMeshNodes));
  }
  MeshBody body;
  body.center_mass_share = read_center_node(table);
  if (const auto place = cloth.find("position")) body.position = place->vector("m");
  if (const auto turn = cloth.find("orientation")) body.orientation = read_orientation(*turn);
  body.shape = std::make_shared<const MeshGeometry>(std::move(shape));
  try {
    (void)make_source_mesh(body);
  } catch (const InvalidArgument& error) {
    table.fail(error.what());
  }
  return body;
}

}  // namespace weft::scenes
