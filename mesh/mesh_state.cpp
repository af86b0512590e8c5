#include <weft/mesh/mesh_state.hpp>

namespace weft {

void serialize(StateArchive& archive, ClothMesh& mesh) {
  archive.part("mesh");
  archive.value(mesh.rest_positions);
  archive.value(mesh.triangles);
  archive.value(mesh.crossed_triangles);
  archive.list(mesh.edge_sets, [&](EdgeSet& set) {
    archive.value(set.name);
    archive.value(set.edges);
  });
  archive.list(mesh.line_sets, [&](LineSet& set) {
    archive.value(set.name);
    archive.value(set.triples);
  });
  archive.list(mesh.connection_sets, [&](ConnectionSet& set) {
    archive.value(set.name);
    archive.value(set.connections);
  });
  archive.list(mesh.node_sets, [&](NodeSet& set) {
    archive.value(set.name);
    archive.value(set.nodes);
  });
  archive.value(mesh.masses);
  archive.value(mesh.pinned);
  archive.value(mesh.pinned_velocities);
  archive.value(mesh.texture_coordinates);
  archive.value(mesh.corner_texture_coordinates);
  if (archive.is_reading()) check_mesh(mesh);
}

}  // namespace weft
