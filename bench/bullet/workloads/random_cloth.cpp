#include "bench/bullet/workloads/random_cloth.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <Eigen/Geometry>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::bench {
namespace {

constexpr int kNodes = 8;          // along an edge
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kDuration = 0.5;  // [s]
constexpr int kLeastSteps = 60;
/// A share of the energy that a fall from the cloth's own size gives. Below it a start at rest has no scale.
constexpr double kSmallShare = 1e-3;

forces::LawSpecification law(const std::string& id, const std::string& parameter, double value) {
  return {id, {}, {{parameter, {value}}}};
}

ClothMesh mesh_of(const RandomCloth& cloth) {
  ClothGrid grid;
  grid.nodes = {kNodes, kNodes};
  grid.center = {0, 0.8, 0};
  grid.total_mass = cloth.mass;
  ClothMesh mesh = make_cloth_grid(grid);
  if (cloth.is_pinned) mesh.pinned = {0, kNodes - 1};
  return mesh;
}

void add_obstacle(bridge::SoftWorld& world, std::shared_ptr<btCollisionShape> shape,
                  double height) {
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape.get());
  info.m_startWorldTransform =
      btTransform(btQuaternion::getIdentity(), btVector3(0, static_cast<btScalar>(height), 0));
  info.m_friction = 1;
  world.add(std::make_unique<btRigidBody>(info), std::move(shape));
}

class Run {
 public:
  Run(const RandomCloth& cloth, const RandomClothSolver& solver)
      : cloth_(cloth), mesh_(mesh_of(cloth)), world_(bridge::SoftWorldSettings{}) {
    bridge::ClothSettings settings{.friction = cloth.friction, .time_step = cloth.time_step};
    using Kind = RandomClothSolver::Kind;
    if (solver.kind == Kind::kLinks) {
      settings.position_iterations = solver.iterations;
      settings.links.push_back({{}, cloth.stiffness});
    }
    body_ = &world_.add(bridge::make_cloth_body(world_.info(), mesh_, settings));
    const forces::LawSpecification gravity{
        "gravity", {}, {{"acceleration", {0.0, -kGravity, 0.0}}}};
    const std::vector<forces::LawSpecification> laws = {
        gravity, law("tension", "stiffness", cloth.stiffness),
        law("spring_damping", "damping", cloth.damping),
        law("hinge_torsion", "rigidity", cloth.bending)};
    if (solver.kind == Kind::kLinks) world_.solver().attach(*body_, mesh_, {gravity});
    if (solver.kind == Kind::kLaws) world_.solver().attach(*body_, mesh_, laws);
    if (solver.kind == Kind::kFast)
      (void)world_.solver().attach_fast(*body_, mesh_, laws, {.may_sleep = false});
    if (cloth.pull > 0) return;
    add_obstacle(world_, std::make_shared<btSphereShape>(btScalar(0.3)), 0.3);
    add_obstacle(world_, std::make_shared<btBoxShape>(btVector3(20, btScalar(0.5), 20)), -0.5);
  }

  [[nodiscard]] Explosion go() {
    start();
    Explosion explosion;
    const int num_steps =
        std::max(kLeastSteps, static_cast<int>(std::lround(kDuration / cloth_.time_step)));
    for (int step = 0; step < num_steps && explosion.is_finite; ++step) {
      pull();
      world_.step(cloth_.time_step);
      look(explosion);
    }
    return explosion;
  }

 private:
  // Thrown downwards and to the side, turning; pulled from rest.
  void start() {
    std::mt19937 random(static_cast<unsigned>(cloth_.number) + 1000000U);
    const auto any = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
    Vector3<double> direction(any(), any() - 1.0, any());
    direction *= cloth_.speed / direction.norm();
    const Vector3<double> turn = Vector3<double>(any(), any(), any()) * cloth_.speed;
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      btSoftBody::Node& node = body_->m_nodes[i];
      if (node.m_im <= 0 || cloth_.pull > 0) continue;
      const Vector3<double> lever_arm = mesh_.rest_positions.col(i) - Vector3<double>(0, 0.8, 0);
      const Vector3<double> v = direction + turn.cross(lever_arm);
      node.m_v = btVector3(static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]),
                           static_cast<btScalar>(v[2]));
    }
    const Vector3<double> axis(any(), any(), any());
    pull_ = axis * (cloth_.pull / axis.norm());
    read();
    put_in_ = most_ = kinetic_energy() + kSmallShare * cloth_.mass * kGravity;
  }

  void pull() {
    if (cloth_.pull <= 0) return;
    body_->m_nodes[pulled()].m_f +=
        btVector3(static_cast<btScalar>(pull_[0]), static_cast<btScalar>(pull_[1]),
                  static_cast<btScalar>(pull_[2]));
  }

  void look(Explosion& explosion) {
    const Matrix3X<double> before = positions_;
    read();
    explosion.is_finite =
        !world_.solver().blow_up(*body_) && positions_.allFinite() && velocities_.allFinite();
    if (!explosion.is_finite) return;
    const Matrix3X<double> moved = positions_ - before;
    double work = -kGravity * moved.row(1).dot(mesh_.masses.transpose());
    if (cloth_.pull > 0) work += pull_.dot(moved.col(pulled()));
    put_in_ += work;
    most_ = std::max(most_, put_in_);
    explosion.energy_ratio = std::max(explosion.energy_ratio, kinetic_energy() / most_);
    explosion.fastest = std::max(explosion.fastest, velocities_.colwise().norm().maxCoeff());
  }

  void read() {
    Matrix3X<btScalar> x;
    Matrix3X<btScalar> v;
    bridge::read_nodes(*body_, x, v);
    positions_ = x.cast<double>();
    velocities_ = v.cast<double>();
    for (const int node : mesh_.pinned) velocities_.col(node).setZero();
  }
  [[nodiscard]] int pulled() const { return body_->m_nodes.size() - 1; }
  [[nodiscard]] double kinetic_energy() const {
    return 0.5 * velocities_.colwise().squaredNorm().dot(mesh_.masses.transpose());
  }

  RandomCloth cloth_;
  ClothMesh mesh_;
  bridge::SoftWorld world_;
  btSoftBody* body_ = nullptr;
  Vector3<double> pull_{0, 0, 0};
  Matrix3X<double> positions_;
  Matrix3X<double> velocities_;
  double put_in_ = 0;  ///< [J] until now
  double most_ = 0;    ///< [J] ever
};

}  // namespace

RandomCloth random_cloth(int number) {
  std::mt19937 random(static_cast<unsigned>(number));
  const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const auto between = [&](double low, double high) { return low * std::pow(high / low, share()); };
  RandomCloth cloth;
  cloth.number = number;
  cloth.time_step = between(1.0 / 1000, 1.0 / 30);
  cloth.stiffness = between(1, 1e6);
  cloth.damping = between(1e-6, 10);
  cloth.bending = between(1e-7, 1e-1);
  cloth.mass = between(1e-3, 100);
  cloth.friction = share();
  cloth.speed = between(0.1, 20);
  const double pull = between(0.1, 100) * cloth.mass * kGravity;
  cloth.pull = number % 4 >= 2 ? pull : 0.0;
  cloth.is_pinned = number % 2 == 1;
  return cloth;
}

Explosion run_random_cloth(const RandomCloth& cloth, const RandomClothSolver& solver) {
  return Run(cloth, solver).go();
}

}  // namespace weft::bench
