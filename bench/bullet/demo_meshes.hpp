#pragma once

#include "bench/bullet/demo_scenes.hpp"

namespace weft::bench {

[[nodiscard]] inline btVector3 vector(double x, double y, double z) {
  return {btScalar(x), btScalar(y), btScalar(z)};
}

/// Links over two, of a material of their own.
void bend(btSoftBody& body, double stiffness);

// Bodies for the scenes of Bullet's demo, not yet in the world.
[[nodiscard]] btSoftBody* torus(DemoWorld& world);
/// In the place of a scanned animal: a lump with ears.
[[nodiscard]] btSoftBody* animal(DemoWorld& world, double size);
/// A cube of n^3 cells of six tetrahedra each.
[[nodiscard]] btSoftBody* tetrahedral_cube(DemoWorld& world, int n, double size);

}  // namespace weft::bench
