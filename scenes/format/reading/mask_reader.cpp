// Nodes that a picture marks, for pins and regions.
// Tested by tests/scenes/appearance/appearance_test.cpp.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/appearance/image_file.hpp>
#include <weft/scenes/format/reading/scene_reader.hpp>

namespace weft::scenes {
namespace {

Image read_picture(const TomlValue& value) {
  const std::string name = value.text();
  if (!has_image_extension(name)) value.fail("expected the name of a .png or .jpg file");
  const std::string bytes = value.named_file("a picture");
  try {
    return decode_image(bytes);
  } catch (const Error& error) {
    value.fail(error.what());
  }
}

/// Brightness from 0, black, to 1, white: the luma of Rec. 709. (0, 0) is the lower left corner.
double brightness(const Image& image, const Eigen::Vector2d& place) {
  const auto pixel = [](double share, int size) {
    return std::clamp(static_cast<int>(share * size), 0, size - 1);
  };
  // The picture repeats, but 1 is its far edge and not its near one.
  const auto wrapped = [](double x) { return x == 1.0 ? x : x - std::floor(x); };
  const int column = pixel(wrapped(place.x()), image.width);
  const int row = pixel(1.0 - wrapped(place.y()), image.height);
  const std::uint8_t* rgb =
      &image.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(column))];
  return (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / 255.0;
}

void mark_grid(const ClothGrid& grid, const Image& image, double above, std::vector<int>& nodes) {
  const Eigen::Vector2d steps(std::max(1, grid.nodes[0] - 1), std::max(1, grid.nodes[1] - 1));
  for (int v = 0; v < grid.nodes[1]; ++v) {
    for (int u = 0; u < grid.nodes[0]; ++u) {
      const Eigen::Vector2d place = Eigen::Vector2d(u, v).cwiseQuotient(steps);
      if (brightness(image, place) > above) nodes.push_back(v * grid.nodes[0] + u);
    }
  }
}

/// A node on a seam has several places: it counts if one of them is marked.
void mark_surface(const ClothMesh& mesh, const Image& image, double above,
                  std::vector<int>& nodes) {
  std::vector<bool> is_marked(static_cast<std::size_t>(mesh.num_nodes()), false);
  const auto mark = [&](int node, const Eigen::Vector2d& place) {
    if (brightness(image, place) > above) is_marked[static_cast<std::size_t>(node)] = true;
  };
  if (mesh.corner_texture_coordinates.cols() > 0) {
    for (Eigen::Index i = 0; i < mesh.corner_texture_coordinates.cols(); ++i) {
      mark(mesh.triangles(i % 3, i / 3), mesh.corner_texture_coordinates.col(i));
    }
  } else {
    for (int i = 0; i < mesh.num_nodes(); ++i) mark(i, mesh.texture_coordinates.col(i));
  }
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    if (is_marked[static_cast<std::size_t>(i)]) nodes.push_back(i);
  }
}

}  // namespace

NodePin read_mask(const TomlTable& table, const TomlValue& value, const Cloth& cloth) {
  const auto limit = table.find("above");
  const double above = limit ? limit->quantity("1") : 0.5;
  const Image image = read_picture(value);
  NodePin pin;
  if (const auto* grid = std::get_if<ClothGrid>(&cloth.source)) {
    mark_grid(*grid, image, above, pin.nodes);
  } else {
    const ClothMesh mesh = make_source_mesh(cloth.source);
    if (mesh.corner_texture_coordinates.cols() + mesh.texture_coordinates.cols() == 0) {
      value.fail(fmt::format("{} has no texture coordinates, expected a grid or a mesh with them",
                             source_name(cloth.source)));
    }
    mark_surface(mesh, image, above, pin.nodes);
  }
  if (pin.nodes.empty()) value.fail(fmt::format("marks no node: none is brighter than {}", above));
  return pin;
}

}  // namespace weft::scenes
