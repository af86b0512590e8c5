// Cloth on the shapes that programs make their ground of: planes, meshes of triangles, height fields.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {
namespace {

constexpr double kCell =
    0.3;  // [m] of the terrain: not a multiple of the cloth's, so that nodes are anywhere over it
constexpr int kCells = 20;

using Height = double (*)(double x, double z);

double flat(double, double) {
  return 0;
}
double slope(double x, double) {
  return -0.5 * x;
}
double valley(double x, double) {
  return 0.4 * std::abs(x);
}

double ridge(double x, double) {
  return -0.7 * std::abs(x);
}
/// Bumps of 10 cm, two cells wide.
double rough(double x, double z) {
  return 0.1 * std::sin(5.2 * x + 1) * std::cos(4.6 * z + 2);
}

/// A surface that a program may give to Bullet, and what has to live as long.
struct Terrain {
  std::vector<btScalar> heights;
  std::unique_ptr<btTriangleMesh> mesh;
  std::unique_ptr<btBvhTriangleMeshShape> unscaled;
  std::shared_ptr<btCollisionShape> shape;
};

double at(int cell) {
  return kCell * (cell - 0.5 * kCells);
}

std::unique_ptr<btTriangleMesh> make_triangles(Height height, double scale) {
  auto mesh = std::make_unique<btTriangleMesh>();
  const auto corner = [&](int i, int j) {
    return vector(at(i) / scale, height(at(i), at(j)) / scale, at(j) / scale);
  };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      // Wound in both ways: a mesh has two sides.
      mesh->addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j));
      mesh->addTriangle(corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j));
    }
  }
  return mesh;
}

Terrain make_mesh(Height height) {
  Terrain terrain;
  terrain.mesh = make_triangles(height, 1);
  terrain.shape = std::make_shared<btBvhTriangleMeshShape>(terrain.mesh.get(), true);
  return terrain;
}

Terrain make_scaled_mesh(Height height) {
  Terrain terrain;
  terrain.mesh = make_triangles(height, 2.5);
  terrain.unscaled = std::make_unique<btBvhTriangleMeshShape>(terrain.mesh.get(), true);
  terrain.shape =
      std::make_shared<btScaledBvhTriangleMeshShape>(terrain.unscaled.get(), vector(2.5, 2.5, 2.5));
  return terrain;
}

Terrain make_height_field(Height height) {
  Terrain terrain;
  btScalar most = 0;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      terrain.heights.push_back(static_cast<btScalar>(height(at(i), at(j))));
      most = std::max(most, std::abs(terrain.heights.back()));
    }
  }
  // Symmetric bounds: Bullet puts their middle into the origin.
  const PHY_ScalarType type = sizeof(btScalar) == sizeof(double) ? PHY_DOUBLE : PHY_FLOAT;
  auto field = std::make_shared<btHeightfieldTerrainShape>(
      kCells + 1, kCells + 1, terrain.heights.data(), btScalar(1), -most, most, 1, type, false);
  field->setLocalScaling(vector(kCell, 1, kCell));
  terrain.shape = field;
  return terrain;
}

Terrain make_plane(Height height) {
  Terrain terrain;
  const double rise = height(1, 0) - height(0, 0);
  terrain.shape = std::make_shared<btStaticPlaneShape>(vector(-rise, 1, 0).normalized(),
                                                       static_cast<btScalar>(height(0, 0)));
  return terrain;
}

using Make = Terrain (*)(Height height);
constexpr Make kAll[] = {make_plane, make_mesh, make_scaled_mesh, make_height_field};
constexpr Make kBent[] = {make_mesh, make_scaled_mesh, make_height_field};

const std::vector<forces::LawSpecification> kLaws = {kGravity, law("tension", "stiffness", 500),
                                                     law("spring_damping", "damping", 0.05)};

class OnTerrain : public Scene {
 public:
  OnTerrain(Terrain terrain, double height, double friction = 0.5)
      : Scene(cloth(11, 1, height), kLaws, friction), terrain_(std::move(terrain)) {
    btRigidBody& ground = add(terrain_.shape, 0, btTransform::getIdentity());
    ground.setFriction(1);
  }

 private:
  Terrain terrain_;
};

/// Distances of all nodes from a plane through the origin that rises by `rise` along x [m].
VectorX<double> distances(const Matrix3X<double>& positions, double rise) {
  return (positions.row(1) - rise * positions.row(0)).transpose() / std::sqrt(1 + rise * rise);
}

TEST(Terrain, ClothLiesItsMarginAboveTheSurface) {
  for (const Make make : kAll) {
    OnTerrain scene(make(flat), 0.2);
    scene.step(180);
    EXPECT_NEAR(scene.positions().row(1).minCoeff(), kMargin, 1e-4);
    EXPECT_NEAR(scene.positions().row(1).maxCoeff(), kMargin, 1e-4);
  }
}

TEST(Terrain, TheShapesOwnMarginIsAddedToTheCloths) {
  for (const Make make : kAll) {
    Terrain terrain = make(flat);
    terrain.shape->setMargin(btScalar(0.03));
    OnTerrain scene(std::move(terrain), 0.2);
    scene.step(180);
    EXPECT_NEAR(scene.positions().row(1).mean(), kMargin + 0.03, 1e-4);
  }
}

TEST(Terrain, ClothThatFallsFastIsStopped) {
  for (const Make make : kAll) {
    OnTerrain scene(make(slope), 2);
    scene.set_velocity(vector(0, -40, 0));
    for (int step = 0; step < 30; ++step) {
      scene.step();
      EXPECT_GT(distances(scene.positions(), -0.5).minCoeff(), 0);
    }
  }
}

// From triangle to triangle, whose seams must not be felt: a = g (sin - mu cos), of a slope of 1 : 2.
TEST(Terrain, ClothSlidesOverSeamsAsOnAPlane) {
  constexpr double kFriction = 0.2;
  const double sine = 0.5 / std::sqrt(1.25);
  const double cosine = 1 / std::sqrt(1.25);
  for (const Make make : kAll) {
    OnTerrain scene(make(slope), 0, kFriction);
    btSoftBody& body = scene.body();
    for (int i = 0; i < body.m_nodes.size(); ++i) {  // laid on the slope, uphill
      btVector3& place = body.m_nodes[i].m_x;
      const double along = static_cast<double>(place.x()) - 1.5;
      place = vector(along * cosine + kMargin * sine, -along * sine + kMargin * cosine,
                     static_cast<double>(place.z()));
      body.m_nodes[i].m_q = place;
    }
    const Vector3<double> start = scene.positions().rowwise().mean();
    scene.step(60);
    const Vector3<double> way = scene.positions().rowwise().mean() - start;
    const double expected = 0.5 * 9.81 * (sine - kFriction * cosine);  // in 1 s
    EXPECT_NEAR(way.norm(), expected, 0.02 * expected);
    EXPECT_NEAR(distances(scene.positions(), -0.5).minCoeff(), kMargin, 1e-4);
    EXPECT_NEAR(distances(scene.positions(), -0.5).maxCoeff(), kMargin, 1e-4);
  }
}

TEST(Terrain, ClothLiesInAValley) {
  for (const Make make : kBent) {
    OnTerrain scene(make(valley), 0.6, 0.1);
    scene.step(300);
    const Matrix3X<double> positions = scene.positions();
    const VectorX<double> right = distances(positions, 0.4);
    const VectorX<double> left = distances(positions, -0.4);
    EXPECT_GT(left.cwiseMin(right).minCoeff(), kMargin - 1e-3);
    EXPECT_LT(scene.velocities().colwise().norm().maxCoeff(), 1e-2);
    EXPECT_LT(std::abs(positions.row(0).mean()), 0.05);
  }
}

TEST(Terrain, ClothHangsOverARidge) {
  for (const Make make : kBent) {
    OnTerrain scene(make(ridge), 0.1, 1);
    scene.step(300);
    const Matrix3X<double> positions = scene.positions();
    const VectorX<double> nearest = distances(positions, 0.7).cwiseMax(distances(positions, -0.7));
    // Over the edge itself it is a margin away from the edge, and less from the planes.
    EXPECT_GT(nearest.minCoeff(), kMargin / std::sqrt(1.49) - 1e-4);
    for (int i = 0; i < nearest.size(); ++i) {  // springs across the edge keep the fold round
      if (std::abs(positions(0, i)) > 0.3) {
        EXPECT_LT(nearest[i], 0.03);
      }
    }
    EXPECT_LT(scene.velocities().colwise().norm().maxCoeff(), 1e-2);
  }
}

TEST(Terrain, ClothComesToRestOnRoughGround) {
  for (const Make make : kBent) {
    OnTerrain scene(make(rough), 0.3, 0.8);
    scene.step(400);
    EXPECT_LT(scene.velocities().colwise().norm().maxCoeff(), 5e-3);
    const Matrix3X<double> positions = scene.positions();
    // Cells of the terrain are flat triangles: they are up to curvature * cell^2 / 4 off the function.
    constexpr double kFacets = 0.1 * 5.2 * 5.2 * kCell * kCell / 4;
    for (int i = 0; i < positions.cols(); ++i) {
      EXPECT_GT(positions(1, i), rough(positions(0, i), positions(2, i)) - kFacets);
    }
  }
}

// A mesh is met from either side.
TEST(Terrain, ClothThatIsThrownUpStaysBelowAMesh) {
  OnTerrain scene(make_mesh(flat), -0.3);
  scene.set_velocity(vector(0, 6, 0));
  for (int step = 0; step < 30; ++step) {
    scene.step();
    EXPECT_LT(scene.positions().row(1).maxCoeff(), 0);
  }
}

TEST(Terrain, ClothThatIsPutIntoAHeightFieldComesOut) {
  OnTerrain scene(make_height_field(valley), -0.02);
  scene.step(120);
  const Matrix3X<double> positions = scene.positions();
  const VectorX<double> nearest = distances(positions, 0.4).cwiseMin(distances(positions, -0.4));
  EXPECT_GT(nearest.minCoeff(), kMargin - 1e-3);
}

// A lift: kinematic ground, whose velocity Bullet derives from where it is put.
TEST(Terrain, GroundThatMovesCarriesTheClothAlong) {
  for (const Make make : {&make_mesh, &make_height_field}) {
    Terrain terrain = make(flat);
    SoftWorld world({});
    const ClothMesh mesh = cloth(11, 1, 0.05);
    btSoftBody& body = world.add(
        make_cloth_body(world.info(), mesh, {.collision_margin = kMargin, .friction = 1}));
    ASSERT_FALSE(world.solver().attach_fast(body, mesh, kLaws));
    btRigidBody& lift = add_rigid(world, terrain.shape, 0, btTransform::getIdentity());
    lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    for (int step = 0; step < 30; ++step) world.step(kTimeStep);
    constexpr double kSpeed = 0.5;  // [m/s] up and sideways
    for (int step = 1; step <= 120; ++step) {
      const double way = kSpeed * step * kTimeStep;
      const btTransform next(btQuaternion::getIdentity(), vector(way, way, 0));
      lift.setLinearVelocity((next.getOrigin() - lift.getWorldTransform().getOrigin()) /
                             btScalar(kTimeStep));
      lift.setWorldTransform(next);
      world.step(kTimeStep);
    }
    Matrix3X<btScalar> positions;
    Matrix3X<btScalar> velocities;
    read_nodes(body, positions, velocities);
    EXPECT_NEAR(static_cast<double>(positions.row(1).mean()), 1 + kMargin, 5e-3);
    EXPECT_NEAR(static_cast<double>(velocities.row(0).mean()), kSpeed, 0.05);
  }
}

TEST(Terrain, AHeightFieldMayHaveAnotherAxisUp) {
  std::vector<btScalar> heights(25, btScalar(0));
  const PHY_ScalarType type = sizeof(btScalar) == sizeof(double) ? PHY_DOUBLE : PHY_FLOAT;
  auto field = std::make_shared<btHeightfieldTerrainShape>(
      5, 5, heights.data(), btScalar(1), btScalar(-1), btScalar(1), 2, type, false);
  SoftWorld world({});
  const ClothMesh mesh = cloth(8, 0.8, 0.1);
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {.collision_margin = kMargin}));
  ASSERT_FALSE(world.solver().attach_fast(body, mesh, kLaws));
  // Its z up becomes the world's y up.
  add_rigid(world, field, 0,
            btTransform(btQuaternion(vector(1, 0, 0), -SIMD_HALF_PI), vector(0, 0, 0)));
  for (int step = 0; step < 120; ++step) world.step(kTimeStep);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(body.m_nodes[i].m_x.y()), kMargin, 1e-4);
  }
}

TEST(Terrain, ExplicitLawsMeetItToo) {
  for (const Make make : kAll) {
    const Terrain terrain = make(flat);
    SoftWorld world({});
    const ClothMesh mesh = cloth(6, 0.5, 0.05);
    btSoftBody& body =
        world.add(make_cloth_body(world.info(), mesh, {.collision_margin = kMargin}));
    world.solver().attach(body, mesh, kLaws);
    add_rigid(world, terrain.shape, 0, btTransform::getIdentity());
    for (int step = 0; step < 1000; ++step) world.step(1.0 / 1000);
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(body.m_nodes[i].m_x.y()), kMargin, 1e-4);
    }
  }
}

}  // namespace
}  // namespace weft::bridge
