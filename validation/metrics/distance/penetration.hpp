#pragma once

#include <optional>
#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::validation {

/// How deep the nodes of one cloth are in one layer: inside the surface, or inside the surface
/// grown by the margin. The depth of a node is max(0, -distance to the layer's surface).
struct LayerPenetration {
  double deepest = 0.0;        ///< largest depth [m]
  double percentile_99 = 0.0;  ///< of the depths of all nodes of the cloth [m]
  int num_inside = 0;          ///< nodes with a depth > 0
};

/// One cloth against one collider. Pinned nodes count too. Edges and faces between the nodes are
/// not looked at: on a sphere of radius R the diagonals of a grid of spacing a lie up to
/// a^2 / (4 R) deeper than their nodes.
struct Penetration {
  std::string cloth;
  std::string collider;
  double closest = 0.0;  ///< smallest signed distance of a node to the surface [m]
  int closest_node = 0;  ///< the node of closest; the first one if several are equal
  LayerPenetration surface;
  LayerPenetration margin;  ///< with the cloth's collision_margin
  /// Set: this node's distance is not finite; all lengths are NaN, the counts are of the other
  /// nodes.
  std::optional<int> first_non_finite_node;
};

/// Every cloth against every collider, cloths first: row = cloth * number of colliders + collider.
/// Colliders stand where state.rigids says.
/// Errors   InvalidArgument for a state with other numbers of cloths, nodes or rigid bodies than
/// the scene
[[nodiscard]] std::vector<Penetration> penetrations(const scenes::Scene& scene,
                                                    const scenes::SceneState& state);

}  // namespace weft::validation
