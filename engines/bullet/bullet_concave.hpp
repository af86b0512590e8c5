#pragma once

// Tested by tests/engines/bullet/bullet_shapes_test.cpp, tests/validation/contact_table/contact_table_test.cpp.

#include <memory>

#include <btBulletDynamicsCommon.h>

#include <weft/scenes/shapes/shapes.hpp>

namespace weft::scenes {

/// Concave shapes in Bullet's soft-body world, in the two ways that scene.hpp's ConcaveContact
/// names. All are in the shape's own frame.

/// A compound of convex prisms, one behind each triangle. Under a height field they reach down by
/// half its shorter side. Behind a mesh they reach along the normals of its points, by a quarter of
/// its smallest extent, but no farther than half way to the opposite side.
[[nodiscard]] std::shared_ptr<btCollisionShape> make_prisms(const MeshShape& mesh);
[[nodiscard]] std::shared_ptr<btCollisionShape> make_prisms(const HeightFieldShape& field);

/// Bullet's own btBvhTriangleMeshShape; for a height field too, whose btHeightfieldTerrainShape has
/// its origin elsewhere and meets soft bodies in the same way.
[[nodiscard]] std::shared_ptr<btCollisionShape> make_triangle_mesh(const MeshShape& mesh);

/// Mean length of the edges [m].
[[nodiscard]] double mean_edge_length(const MeshShape& mesh);

}  // namespace weft::scenes
