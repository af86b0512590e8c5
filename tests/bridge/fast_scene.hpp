#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btBoxShape.h>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>

#include "tests/bridge/rigid_objects.hpp"

namespace weft::bridge {

inline constexpr double kTimeStep = 1.0 / 60;  // [s]
inline constexpr double kMargin = 0.01;        // [m]

inline forces::LawSpecification law(const std::string& id, const std::string& parameter,
                                    double value) {
  return {id, {}, {{parameter, {value}}}};
}

inline const forces::LawSpecification kGravity{
    "gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}};

inline ClothMesh cloth(int n, double size, double height, double mass = 0.25) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.size = {size, size};
  grid.center = {0, height, 0};
  grid.total_mass = mass;
  return make_cloth_grid(grid);
}

/// A world with one cloth, and what a test puts into it.
class Scene {
 public:
  explicit Scene(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
                 double friction = 0.5, const FastSettings& fast = {.may_sleep = false})
      : world_(SoftWorldSettings{}),
        masses_(mesh.masses),
        body_(&world_.add(make_cloth_body(world_.info(), mesh,
                                          {.collision_margin = kMargin, .friction = friction}))) {
    EXPECT_FALSE(world_.solver().attach_fast(*body_, mesh, laws, fast));
  }

  btRigidBody& add(std::shared_ptr<btCollisionShape> shape, double mass, const btTransform& place) {
    return add_rigid(world_, std::move(shape), mass, place);
  }
  void step(int num_steps = 1, double time_step = kTimeStep) {
    for (int i = 0; i < num_steps; ++i) world_.step(time_step);
  }
  void set_velocity(const btVector3& velocity) {
    for (int i = 0; i < body_->m_nodes.size(); ++i) body_->m_nodes[i].m_v = velocity;
  }
  [[nodiscard]] Matrix3X<double> positions() const { return read().first; }
  [[nodiscard]] Matrix3X<double> velocities() const { return read().second; }
  [[nodiscard]] Vector3<double> mean_velocity() const {
    return velocities() * masses_ / masses_.sum();
  }
  [[nodiscard]] Vector3<double> momentum() const { return velocities() * masses_; }
  /// The energy of the cloth without its springs, from a height on [J].
  [[nodiscard]] double mechanical_energy(double height) const {
    const VectorX<double> squared_speeds = velocities().colwise().squaredNorm().transpose();
    const VectorX<double> heights = positions().row(1).transpose().array() - height;
    return masses_.dot(0.5 * squared_speeds + 9.81 * heights);
  }
  [[nodiscard]] btSoftBody& body() { return *body_; }
  [[nodiscard]] SoftBodySolver& solver() { return world_.solver(); }
  [[nodiscard]] SoftWorld& world() { return world_; }

 private:
  [[nodiscard]] std::pair<Matrix3X<double>, Matrix3X<double>> read() const {
    Matrix3X<btScalar> x;
    Matrix3X<btScalar> v;
    read_nodes(*body_, x, v);
    return {x.cast<double>(), v.cast<double>()};
  }
  SoftWorld world_;
  VectorX<double> masses_;
  btSoftBody* body_;
};

inline std::shared_ptr<btCollisionShape> box(double x, double y, double z) {
  auto shape = std::make_shared<btBoxShape>(vector(x, y, z));
  shape->setMargin(btScalar(0.001));
  return shape;
}

}  // namespace weft::bridge
