#include <weft/playback/exchange/obj_file.hpp>

#include <iterator>

#include <fmt/format.h>

#include <weft/playback/exchange/exchange_body.hpp>

namespace weft::scenes {

std::string obj_text(const std::string& name, const ClothMesh& mesh) {
  std::string text = fmt::format("# Weft, lengths in m, y is up\no {}\n", name);
  const auto out = std::back_inserter(text);
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    const auto x = mesh.rest_positions.col(i);
    fmt::format_to(out, "v {} {} {}\n", x[0], x[1], x[2]);
  }
  const bool has_corners = mesh.corner_texture_coordinates.cols() > 0;
  const Matrix2X<double>& places =
      has_corners ? mesh.corner_texture_coordinates : mesh.texture_coordinates;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    fmt::format_to(out, "vt {} {}\n", places(0, i), places(1, i));
  }
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    text += "f";
    for (Eigen::Index c = 0; c < 3; ++c) {
      const int node = mesh.triangles(c, t);
      fmt::format_to(out, " {}", node + 1);
      if (places.cols() > 0) fmt::format_to(out, "/{}", (has_corners ? 3 * t + c : node) + 1);
    }
    text += "\n";
  }
  const Edges lines = line_segments(mesh);
  for (Eigen::Index e = 0; e < lines.cols(); ++e) {
    fmt::format_to(out, "l {} {}\n", lines(0, e) + 1, lines(1, e) + 1);
  }
  return text;
}

}  // namespace weft::scenes
