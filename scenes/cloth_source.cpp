#include <weft/scenes/cloth_source.hpp>

#include <algorithm>

namespace weft::scenes {
namespace {

int count_nodes(const ClothGrid& grid) {
  return grid.nodes[0] * grid.nodes[1];
}

int count_nodes(const Icosphere& sphere) {
  return 10 * sphere.frequency * sphere.frequency + 2 + (sphere.center_mass_share ? 1 : 0);
}

int count_nodes(const Rope& rope) {
  return rope.nodes;
}

int count_nodes(const SkinSource& skin) {
  return static_cast<int>(skin.part->positions.cols());
}

int count_nodes(const MeshBody& body) {
  return static_cast<int>(body.shape->surface.positions.cols()) + (body.center_mass_share ? 1 : 0);
}

ClothMesh build(const ClothGrid& grid) {
  return make_cloth_grid(grid);
}

ClothMesh build(const Icosphere& sphere) {
  return make_icosphere(sphere);
}

ClothMesh build(const Rope& rope) {
  return make_rope(rope);
}

ClothMesh build(const SkinSource& skin) {
  return make_skin_mesh(skin);
}

ClothMesh build(const MeshBody& body) {
  Surface placed = body.shape->surface;
  for (Eigen::Index n = 0; n < placed.positions.cols(); ++n) {
    const Vector3<double> local = placed.positions.col(n);
    placed.positions.col(n) = body.position + body.orientation * local;
  }
  return make_surface_body(placed, {body.total_mass, body.lumping, body.center_mass_share});
}

double size_of(const ClothGrid& grid) {
  return std::max(grid.size[0], grid.size[1]);
}

double size_of(const Icosphere& sphere) {
  return 2 * sphere.radius;
}

double size_of(const Rope& rope) {
  return (rope.end - rope.start).norm();
}

double size_of(const SkinSource& skin) {
  const Matrix3X<double> places = rest_positions(skin);
  return (places.rowwise().maxCoeff() - places.rowwise().minCoeff()).maxCoeff();
}

double size_of(const MeshBody& body) {
  const Matrix3X<double>& positions = body.shape->surface.positions;
  return (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
}

/// The smallest body of the same kind, which has the same sets.
ClothGrid smallest(const ClothGrid& grid) {
  ClothGrid small;
  small.stencil = grid.stencil;
  return small;
}

Icosphere smallest(const Icosphere& sphere) {
  return {.frequency = 1, .center_mass_share = sphere.center_mass_share};
}

Rope smallest(const Rope&) {
  return {};
}

Icosphere smallest(const SkinSource&) {
  return {.frequency = 1};
}

Icosphere smallest(const MeshBody& body) {
  return {.frequency = 1, .center_mass_share = body.center_mass_share};
}

std::string name_of(const ClothGrid&) {
  return "a grid";
}

std::string name_of(const Icosphere&) {
  return "an icosphere";
}

std::string name_of(const Rope&) {
  return "a rope";
}

std::string name_of(const SkinSource&) {
  return "a part of a character";
}

std::string name_of(const MeshBody&) {
  return "a mesh";
}

}  // namespace

int num_nodes(const ClothSource& source) {
  return std::visit([](const auto& s) { return count_nodes(s); }, source);
}

ClothMesh make_source_mesh(const ClothSource& source) {
  return std::visit([](const auto& s) { return build(s); }, source);
}

double body_size(const ClothSource& source) {
  return std::visit([](const auto& s) { return size_of(s); }, source);
}

std::vector<std::string> source_sets(const ClothSource& source, forces::ElementKind elements) {
  const ClothMesh mesh = std::visit([](const auto& s) { return build(smallest(s)); }, source);
  std::vector<std::string> names;
  const auto add = [&](const auto& sets) {
    for (const auto& set : sets) names.push_back(set.name);
  };
  if (elements == forces::ElementKind::kEdges) add(mesh.edge_sets);
  if (elements == forces::ElementKind::kLines) add(mesh.line_sets);
  if (elements == forces::ElementKind::kConnections) add(mesh.connection_sets);
  return names;
}

std::string source_name(const ClothSource& source) {
  return std::visit([](const auto& s) { return name_of(s); }, source);
}

}  // namespace weft::scenes
