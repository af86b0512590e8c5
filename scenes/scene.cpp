#include <weft/scenes/scene.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/engine_kind.hpp>

namespace weft::scenes {
namespace {

[[noreturn]] void refuse(const Cloth& cloth, const std::string& message) {
  throw InvalidArgument("cloth '" + cloth.name + "': " + message);
}

const ClothGrid& require_grid(const Cloth& cloth, const std::string& what) {
  const auto* grid = std::get_if<ClothGrid>(&cloth.source);
  if (grid == nullptr) {
    refuse(cloth, what + " of " + source_name(cloth.source) +
                      ", expected a grid; others have boxes, spheres and node numbers");
  }
  return *grid;
}

/// All nodes for which holds(node) is true.
template <class Holds>
std::vector<int> nodes_where(const ClothMesh& mesh, const Holds& holds) {
  std::vector<int> nodes;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (holds(node)) nodes.push_back(node);
  }
  return nodes;
}

std::vector<int> held(const CornerPin& pin, const Cloth& cloth, const ClothMesh&) {
  return {grid_node(require_grid(cloth, "a corner"), pin.u, pin.v)};
}

std::vector<int> held(const EdgePin& pin, const Cloth& cloth, const ClothMesh& mesh) {
  const ClothGrid& grid = require_grid(cloth, "an edge");
  const int wanted = pin.side == 0 ? 0 : grid.nodes[pin.axis] - 1;
  return nodes_where(mesh, [&](int node) {
    return (pin.axis == 0 ? node % grid.nodes[0] : node / grid.nodes[0]) == wanted;
  });
}

std::vector<int> held(const BoxPin& pin, const Cloth&, const ClothMesh& mesh) {
  return nodes_where(mesh, [&](int node) {
    const auto position = mesh.rest_positions.col(node).array();
    return (position >= pin.minimum.array()).all() && (position <= pin.maximum.array()).all();
  });
}

std::vector<int> held(const SpherePin& pin, const Cloth&, const ClothMesh& mesh) {
  return nodes_where(mesh, [&](int node) {
    return (mesh.rest_positions.col(node) - pin.center).norm() <= pin.radius;
  });
}

std::vector<int> held(const NodePin& pin, const Cloth& cloth, const ClothMesh& mesh) {
  for (const int node : pin.nodes) {
    if (node >= 0 && node < mesh.num_nodes()) continue;
    refuse(cloth, "node " + std::to_string(node) + " is not there, expected 0 to " +
                      std::to_string(mesh.num_nodes() - 1));
  }
  return pin.nodes;
}

/// The nodes that at least one of the regions holds, sorted. what: "pin".
std::vector<int> nodes_of_all(const std::vector<Pin>& regions, const Cloth& cloth,
                              const ClothMesh& mesh, const std::string& what) {
  std::vector<int> nodes;
  for (const Pin& region : regions) {
    const std::vector<int> more =
        std::visit([&](const auto& pin) { return held(pin, cloth, mesh); }, region);
    if (more.empty()) {
      refuse(cloth, "a " + what + " holds no node, expected a region with at least one node");
    }
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

int node_of(const Connection& connection, const Cloth& cloth) {
  if (connection.node_number) return *connection.node_number;
  return grid_node(require_grid(cloth, "column and row"), connection.node[0], connection.node[1]);
}

void add_connection(const Connection& connection, const Cloth& cloth, ClothMesh& mesh) {
  const int node = node_of(connection, cloth);
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

ClothGrid& Cloth::grid() {
  return const_cast<ClothGrid&>(std::as_const(*this).grid());
}

const ClothGrid& Cloth::grid() const {
  return require_grid(*this, "rows and columns");
}

namespace {

void raise(const Bulge& bulge, const ClothGrid& grid, ClothMesh& mesh) {
  const Vector3<double> normal = grid.u_axis.cross(grid.v_axis).normalized();
  for (Eigen::Index i = 0; i < mesh.rest_positions.cols(); ++i) {
    const double share = (mesh.rest_positions.col(i) - grid.center).norm() / bulge.radius;
    if (share < 1) {
      mesh.rest_positions.col(i) += bulge.height * std::pow(1 - share * share, 2) * normal;
    }
  }
}

/// The springs of the source, its first num_sets edge sets, with both ends in the region.
void add_springs_of(const NodeSet& region, std::size_t num_sets, ClothMesh& mesh) {
  const auto is_in = [&](int node) {
    return std::binary_search(region.nodes.begin(), region.nodes.end(), node);
  };
  std::vector<std::array<int, 2>> found;
  for (std::size_t s = 0; s < num_sets; ++s) {
    const EdgeSet& set = mesh.edge_sets[s];
    for (Eigen::Index e = 0; e < set.edges.cols(); ++e) {
      if (is_in(set.edges(0, e)) && is_in(set.edges(1, e))) {
        found.push_back({set.edges(0, e), set.edges(1, e)});
      }
    }
  }
  Edges edges(2, static_cast<Eigen::Index>(found.size()));
  for (std::size_t e = 0; e < found.size(); ++e) {
    edges.col(static_cast<Eigen::Index>(e)) << found[e][0], found[e][1];
  }
  mesh.edge_sets.push_back({region.name, edges});
}

}  // namespace

std::vector<int> nodes_of(const Pin& pin, const Cloth& cloth, const ClothMesh& mesh) {
  return nodes_of_all({pin}, cloth, mesh, "pin");
}

ClothMesh make_mesh(const Cloth& cloth) {
  ClothMesh mesh = make_source_mesh(cloth.source);
  if (cloth.bulge) raise(*cloth.bulge, cloth.grid(), mesh);
  add_pins(cloth, mesh);
  const std::size_t num_source_sets = mesh.edge_sets.size();
  for (const Region& region : cloth.regions) {
    mesh.node_sets.push_back({region.name, nodes_of_all(region.nodes, cloth, mesh, "region")});
    if (region.has_springs) add_springs_of(mesh.node_sets.back(), num_source_sets, mesh);
  }
  for (const Connection& connection : cloth.connections) add_connection(connection, cloth, mesh);
  return mesh;
}

bool is_for_engine(const Scene& scene, std::string_view engine) {
  return scene.engines.empty() ||
         std::find(scene.engines.begin(), scene.engines.end(), engine) != scene.engines.end();
}

Scene with_step_of(Scene scene, std::string_view engine) {
  World& world = scene.world;
  const EngineKind* kind = find_engine_kind(engine);
  if (kind != nullptr && kind->is_implicit && world.implicit_time_step)
    world.time_step = *world.implicit_time_step;
  world.implicit_time_step.reset();
  return scene;
}

Scene with_bullets_time_step(Scene scene) {
  World& world = scene.world;
  const double num_steps = std::round(world.duration / world.time_step);
  const double steps_per_frame = std::round(world.frame_interval / world.time_step);
  world.time_step = static_cast<double>(static_cast<float>(world.time_step));
  world.implicit_time_step.reset();
  world.duration = num_steps * world.time_step;
  world.frame_interval = steps_per_frame * world.time_step;
  return scene;
}

}  // namespace weft::scenes
