#include <weft/scenes/scene.hpp>

#include <algorithm>
#include <cmath>

#include <weft/custom_forces/core/error.hpp>

namespace weft::scenes {
namespace {

bool holds(const CornerPin& pin, const ClothGrid& grid, const Vector3<double>&, int node) {
  return node == grid_node(grid, pin.u, pin.v);
}

bool holds(const EdgePin& pin, const ClothGrid& grid, const Vector3<double>&, int node) {
  const int index = pin.axis == 0 ? node % grid.nodes[0] : node / grid.nodes[0];
  return index == (pin.side == 0 ? 0 : grid.nodes[pin.axis] - 1);
}

bool holds(const BoxPin& pin, const ClothGrid&, const Vector3<double>& position, int) {
  return (position.array() >= pin.minimum.array()).all() &&
         (position.array() <= pin.maximum.array()).all();
}

}  // namespace

ClothMesh make_mesh(const Cloth& cloth) {
  ClothMesh mesh = make_cloth_grid(cloth.grid);
  std::vector<bool> pinned(static_cast<std::size_t>(mesh.num_nodes()), false);
  for (const Pin& pin : cloth.pins) {
    bool any = false;
    for (int node = 0; node < mesh.num_nodes(); ++node) {
      const bool held = std::visit(
          [&](const auto& p) { return holds(p, cloth.grid, mesh.rest_positions.col(node), node); },
          pin);
      if (held) pinned[static_cast<std::size_t>(node)] = any = true;
    }
    if (!any) {
      throw InvalidArgument("cloth '" + cloth.name +
                            "': a pin holds no node, expected a region with at least one node");
    }
  }
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (pinned[static_cast<std::size_t>(node)]) mesh.pinned.push_back(node);
  }
  return mesh;
}

Scene with_bullets_time_step(Scene scene) {
  World& world = scene.world;
  const double num_steps = std::round(world.duration / world.time_step);
  const double steps_per_frame = std::round(world.frame_interval / world.time_step);
  world.time_step = static_cast<double>(static_cast<float>(world.time_step));
  world.duration = num_steps * world.time_step;
  world.frame_interval = steps_per_frame * world.time_step;
  return scene;
}

}  // namespace weft::scenes
