// Cloth on the ground of a game: hills as a height field, and as a mesh of triangles.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>

namespace {

constexpr int kCells = 40;
constexpr double kCell = 0.1;     // [m]
constexpr double kMargin = 0.01;  // [m] of the cloth

double height(double x, double z) {
  return 0.15 * std::sin(2.5 * x) * std::cos(2 * z);
}

double coordinate(int i) {
  return kCell * (i - kCells / 2);
}

std::vector<float> heights() {
  std::vector<float> values;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      values.push_back(static_cast<float>(height(coordinate(i), coordinate(j))));
    }
  }
  return values;
}

void add_triangles(btTriangleMesh& mesh) {
  const auto corner = [](int i, int j) {
    const double x = coordinate(i);
    const double z = coordinate(j);
    return btVector3(btScalar(x), btScalar(height(x, z)), btScalar(z));
  };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      mesh.addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j));
      mesh.addTriangle(corner(i + 1, j + 1), corner(i + 1, j), corner(i, j + 1));
    }
  }
}

/// The smallest and the largest height of the cloth above the hills once it lies [m].
std::pair<double, double> lay_cloth(std::shared_ptr<btCollisionShape> ground) {
  weft::bridge::SoftWorld world({});
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, ground.get());
  info.m_friction = 1;
  world.add(std::make_unique<btRigidBody>(info), ground);

  const weft::ClothMesh mesh = weft::make_cloth_grid(
      {.nodes = {41, 41}, .size = {2.0, 2.0}, .center = {0, 0.3, 0}, .total_mass = 0.8});
  btSoftBody& cloth =
      world.add(weft::bridge::make_cloth_body(world.info(), mesh, {.collision_margin = kMargin}));
  const auto refusal =
      world.solver().attach_fast(cloth, mesh,
                                 {{"tension", {}, {{"stiffness", {100.0}}}},
                                  {"velocity_damping", {}, {{"rate", {0.5}}}},
                                  {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}});
  if (refusal) std::fprintf(stderr, "%s\n", refusal->c_str());
  for (int step = 0; step < 300; ++step) world.step(1 / 60.0);

  double least = 1e9;
  double most = -1e9;
  for (int i = 0; i < cloth.m_nodes.size(); ++i) {
    const btVector3& x = cloth.m_nodes[i].m_x;
    const double above =
        static_cast<double>(x.y()) - height(static_cast<double>(x.x()), static_cast<double>(x.z()));
    least = std::min(least, above);
    most = std::max(most, above);
  }
  return {least, most};
}

}  // namespace

int main() {
  std::vector<float> values = heights();
  auto field = std::make_shared<btHeightfieldTerrainShape>(kCells + 1, kCells + 1, values.data(),
                                                           btScalar(1), btScalar(-0.15),
                                                           btScalar(0.15), 1, PHY_FLOAT, false);
  field->setLocalScaling(btVector3(btScalar(kCell), 1, btScalar(kCell)));

  btTriangleMesh triangles;
  add_triangles(triangles);
  auto mesh = std::make_shared<btBvhTriangleMeshShape>(&triangles, true);

  bool is_right = true;
  for (const std::shared_ptr<btCollisionShape>& ground :
       {std::shared_ptr<btCollisionShape>(field), std::shared_ptr<btCollisionShape>(mesh)}) {
    const auto [least, most] = lay_cloth(ground);
    std::printf("%s: the cloth lies %.1f to %.1f mm above the hills\n", ground->getName(),
                1e3 * least, 1e3 * most);
    // A flat cell is up to 2 mm off the sine of the hill.
    is_right = is_right && least > kMargin - 4e-3 && most < 0.1;
  }
  return is_right ? 0 : 1;
}
