#include <weft/playback/rendering/meshes/cloth_drawing.hpp>

#include <vector>

namespace weft::scenes {

ClothDrawing::ClothDrawing(const DrawnCloth& drawn, const ClothMesh& mesh)
    : layout_(make_drawn_layout(*drawn.surface)),
      mesh_(mesh),
      embedding_(mesh.rest_positions, mesh.triangles, layout_.mesh, drawn.embedding),
      pose_(embedding_.make_pose()) {}

void ClothDrawing::set_state(const ClothState& cloth) {
  if (cloth.topology != topology_) {
    const bool is_torn = cloth.topology != nullptr;
    embedding_.follow_tear(is_torn ? cloth.topology->triangles : mesh_.triangles,
                           static_cast<int>(cloth.positions.cols()));
    pose_ = embedding_.make_pose();
    topology_ = cloth.topology;
  }
  embedding_.set_pose(cloth.positions, pose_);
}

SurfaceMesh drawn_surface(ClothDrawing& drawing, const ClothState& cloth,
                          const DrawLimits& limits) {
  drawing.set_state(cloth);
  const ClothEmbedding& embedding = drawing.embedding();
  const DrawnLayout& layout = drawing.layout();
  SurfaceMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(embedding.num_vertices()));
  std::vector<bool> is_drawable(mesh.vertices.size());
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    const auto index = static_cast<std::size_t>(v);
    const auto original = static_cast<std::size_t>(embedding.original(v));
    const DrawnVertex drawn = drawing.vertex(v);
    const Vector3<double> place = drawn.position - limits.origin;
    is_drawable[index] = place.allFinite() && place.cwiseAbs().maxCoeff() <= limits.largest;
    if (!is_drawable[index]) continue;
    mesh.vertices[index] = {place.cast<float>(), drawn.normal.cast<float>(),
                            layout.coordinates[original], layout.rest_places[original]};
  }
  for (const auto corners : embedding.drawn_triangles().colwise()) {
    bool is_whole = true;
    for (const int vertex : corners) {
      is_whole = is_whole && is_drawable[static_cast<std::size_t>(vertex)];
    }
    if (!is_whole) continue;
    for (const int vertex : corners) mesh.indices.push_back(static_cast<std::uint32_t>(vertex));
  }
  return mesh;
}

}  // namespace weft::scenes
