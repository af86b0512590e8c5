#include <weft/scenes/scene.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// The nodes that at least one of the regions holds, sorted. what: "pin".
std::vector<int> nodes_of_all(const std::vector<Pin>& regions, const Cloth& cloth,
                              const ClothMesh& mesh, const std::string& what) {
  std::vector<bool> held(static_cast<std::size_t>(mesh.num_nodes()), false);
  for (const Pin& region : regions) {
    bool any = false;
    for (int node = 0; node < mesh.num_nodes(); ++node) {
      const bool is_in = std::visit(
          [&](const auto& p) { return holds(p, cloth.grid, mesh.rest_positions.col(node), node); },
          region);
      if (is_in) held[static_cast<std::size_t>(node)] = any = true;
    }
    if (!any) {
      throw InvalidArgument("cloth '" + cloth.name + "': a " + what +
                            " holds no node, expected a region with at least one node");
    }
  }
  std::vector<int> nodes;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (held[static_cast<std::size_t>(node)]) nodes.push_back(node);
  }
  return nodes;
}

void add_connection(const Connection& connection, const Cloth& cloth, ClothMesh& mesh) {
  const int node = grid_node(cloth.grid, connection.node[0], connection.node[1]);
  std::vector<int> far;
  if (connection.to.empty()) {
    far.resize(static_cast<std::size_t>(mesh.num_nodes()));
    std::iota(far.begin(), far.end(), 0);
  } else {
    far = nodes_of_all(connection.to, cloth, mesh, "connection");
  }
  far.erase(std::remove(far.begin(), far.end(), node), far.end());
  connect(mesh, connection.name, node, far);
}

/// Pins nodes of both kinds of pins, each with its velocity.
void add_pins(const Cloth& cloth, ClothMesh& mesh) {
  Matrix3X<double> velocities = Matrix3X<double>::Zero(3, mesh.num_nodes());
  std::vector<Pin> pins = cloth.pins;
  for (const MovingPin& pin : cloth.moving_pins) {
    for (const int node : nodes_of(pin.nodes, cloth, mesh)) {
      velocities.col(node) = pin.velocity;
    }
    pins.push_back(pin.nodes);
  }
  mesh.pinned = nodes_of_all(pins, cloth, mesh, "pin");
  if (!cloth.moving_pins.empty()) mesh.pinned_velocities = velocities(Eigen::all, mesh.pinned);
}

}  // namespace

std::vector<int> nodes_of(const Pin& pin, const Cloth& cloth, const ClothMesh& mesh) {
  return nodes_of_all({pin}, cloth, mesh, "pin");
}

ClothMesh make_mesh(const Cloth& cloth) {
  ClothMesh mesh = make_cloth_grid(cloth.grid);
  add_pins(cloth, mesh);
  for (const Region& region : cloth.regions) {
    mesh.node_sets.push_back({region.name, nodes_of_all(region.nodes, cloth, mesh, "region")});
  }
  for (const Connection& connection : cloth.connections) add_connection(connection, cloth, mesh);
  return mesh;
}

bool is_for_engine(const Scene& scene, std::string_view engine) {
  return scene.engines.empty() ||
         std::find(scene.engines.begin(), scene.engines.end(), engine) != scene.engines.end();
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
