#include <weft/playback/exchange/import/face_agreement.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

/// Numbers of the faces at each node, growing.
std::vector<std::vector<int>> faces_at_nodes(int num_nodes,
                                             const std::vector<std::vector<int>>& faces) {
  std::vector<std::vector<int>> at(static_cast<std::size_t>(num_nodes));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const int node : faces[f])
      at[static_cast<std::size_t>(node)].push_back(static_cast<int>(f));
  }
  return at;
}

bool share_a_face(const std::vector<int>& a, const std::vector<int>& b, const std::vector<int>& c) {
  const auto has = [](const std::vector<int>& list, int face) {
    return std::binary_search(list.begin(), list.end(), face);
  };
  return std::any_of(a.begin(), a.end(), [&](int face) { return has(b, face) && has(c, face); });
}

}  // namespace

std::optional<std::string> face_disagreement(const ClothMesh& mesh,
                                             const std::vector<std::vector<int>>& faces) {
  Eigen::Index num_triangles = 0;
  for (const std::vector<int>& face : faces) {
    num_triangles += static_cast<Eigen::Index>(face.size()) - 2;
  }
  if (num_triangles != mesh.triangles.cols()) {
    return fmt::format("the faces are {} triangles, expected {}", num_triangles,
                       mesh.triangles.cols());
  }
  const std::vector<std::vector<int>> at = faces_at_nodes(mesh.num_nodes(), faces);
  const auto list_of = [&](int node) -> const std::vector<int>& {
    return at[static_cast<std::size_t>(node)];
  };
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const auto nodes = mesh.triangles.col(t);
    if (share_a_face(list_of(nodes[0]), list_of(nodes[1]), list_of(nodes[2]))) continue;
    return fmt::format(
        "no face has the nodes {}, {} and {} (from 0), which are a triangle of the scene's mesh",
        nodes[0], nodes[1], nodes[2]);
  }
  return std::nullopt;
}

}  // namespace weft::scenes
