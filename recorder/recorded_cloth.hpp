#pragma once

#include <memory>
#include <string>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// A soft body as a cloth of a scene: a mesh of its faces at the positions that the nodes have now,
/// with the mass, pins, margin and friction of the body. The mass is shared out by area or evenly,
/// whichever is nearer to the body's; a pinned node, which has no mass in Bullet, counts like the
/// others. Throws InvalidArgument if the faces make no surface.
[[nodiscard]] scenes::Cloth recorded_cloth(const btSoftBody& body, const std::string& name);

/// The faces of a body that may have torn, beside those of the cloth that was made of it.
class FollowedFaces {
 public:
  FollowedFaces() = default;
  /// triangles: of the cloth's mesh, which may be wound in another way than the body's faces.
  FollowedFaces(const btSoftBody& body, Triangles triangles);

  /// The nodes and faces of the body now, if it has more nodes than at first. Throws InvalidArgument if
  /// it has other faces than torn cloth has: as many as before, and each corner at its node of the
  /// first mesh or at a later one, which belongs to one node of the first mesh.
  [[nodiscard]] std::shared_ptr<const scenes::ClothTopology> now(const btSoftBody& body) const;

 private:
  Triangles first_faces_;
  Triangles first_triangles_;
  int num_first_nodes_ = 0;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
