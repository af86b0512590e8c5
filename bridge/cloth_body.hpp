#pragma once

#include <memory>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A set of springs that Bullet's own links shall carry.
struct LinkSet {
  std::vector<std::string> edge_sets;  ///< names in the mesh; empty means all sets
  double stiffness = 0.0;              ///< [N/m]
};

/// Everything of a btSoftBody that matters for cloth. Bullet's defaults are not relied upon.
struct ClothSettings {
  double collision_margin = 0.01;  ///< [m] distance from a surface at which a node rests, >= 0
  double friction = 0.5;           ///< kDF [-]; with a rigid body Bullet multiplies both, >= 0
  int position_iterations = 20;    ///< piterations, >= 1: visits to each contact and link per step
  /// kKHR, kCHR [-], 0 to 1: how much of the predicted depth one contact visit takes back, on top
  /// of the whole approach. 1 looks natural and is wrong: Bullet takes the approach back and then
  /// the depth as well, so that a node leaves the surface with up to the speed it came with.
  /// Bullet's default for fixed bodies is 0.1. Only for ContactResponse::kBullet.
  double contact_hardness = 0.1;
  std::vector<LinkSet> links = {};  ///< none: all tension comes from attached laws
  double time_step =
      0.01;  ///< [s] the step the world will take; only the links' stiffness depends on it
};

/// Builds a soft body from a mesh: nodes, faces, masses, pins (mass 0 in Bullet), links for
/// settings.links, whose kLST comes from link_stiffness.hpp for each link's own masses. The caller
/// adds it to a world and owns it. Throws InvalidArgument as check_mesh() and for settings out of their domain.
[[nodiscard]] std::unique_ptr<btSoftBody> make_cloth_body(btSoftBodyWorldInfo& world_info,
                                                          const ClothMesh& mesh,
                                                          const ClothSettings& settings);

/// Gives pinned nodes the velocities of the mesh. Bullet moves them with these, but derives them
/// anew from rounded positions in every step: call this before each step to keep them.
void set_pinned_velocities(const ClothMesh& mesh, btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
