#include "bench/bullet/workloads/workload.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>

namespace weft::bench {
namespace {

using Kind = Workload::Kind;

ClothGrid sheet(int nodes, double size, const Vector3<double>& center) {
  ClothGrid grid;
  grid.nodes = {nodes, nodes};
  grid.size = {size, size};
  grid.center = center;
  grid.lumping = MassLumping::kUniform;
  return grid;
}

/// What the workload's bodies fall on; none if they hang.
std::shared_ptr<btCollisionShape> ground_of(Kind kind) {
  if (kind == Kind::kHang) return nullptr;
  if (kind == Kind::kClassic) return std::make_shared<btSphereShape>(btScalar(2));
  return std::make_shared<btBoxShape>(btVector3(40, 1, 40));
}

}  // namespace

std::vector<ClothMesh> meshes_of(const Workload& workload) {
  std::vector<ClothMesh> meshes;
  switch (workload.kind) {
    case Kind::kHang: {
      ClothGrid grid = sheet(workload.nodes, 1.0, {0, 0, 0});
      grid.stencil = GridStencil::k12Neighbour;
      meshes.push_back(make_cloth_grid(grid));
      meshes[0].pinned = {0, workload.nodes - 1};
      break;
    }
    case Kind::kClassic: {
      ClothGrid grid = sheet(workload.nodes, 7.0, {0, 2.2, 0});
      grid.stencil = GridStencil::k24Neighbour;
      meshes.push_back(make_cloth_grid(grid));
      break;
    }
    case Kind::kCrowd:
      for (int i = 0; i < 100; ++i) {
        const Vector3<double> center(1.5 * (i % 10), 0.05 + 0.002 * i, 1.5 * (i / 10));
        ClothGrid grid = sheet(workload.nodes, 1.0, center);
        grid.total_mass = 0.25;
        meshes.push_back(make_cloth_grid(grid));
      }
      break;
    case Kind::kCrumple:
      for (int i = 0; i < 100; ++i) {
        ClothGrid grid = sheet(workload.nodes, 1.0, {0, 0, 0});
        grid.total_mass = 0.25;
        meshes.push_back(make_cloth_grid(grid));
        const Eigen::AngleAxisd tilt(70.0 / 180 * 3.14159265358979323846,
                                     Vector3<double>(1, 0, 0.01 * i).normalized());
        const Vector3<double> center(2.5 * (i % 10), 0.6, 2.5 * (i / 10));
        Matrix3X<double>& x = meshes.back().rest_positions;
        x = ((tilt.toRotationMatrix() * x).colwise() + center).eval();
      }
      break;
    case Kind::kBall: {
      Icosphere sphere;
      sphere.radius = 0.5;
      sphere.frequency = workload.nodes;
      sphere.center = {0, 0.6, 0};
      meshes.push_back(make_icosphere(sphere));
      break;
    }
  }
  return meshes;
}

Edges springs_of(const ClothMesh& mesh) {
  std::vector<std::string> names;
  for (const auto& set : mesh.edge_sets) names.push_back(set.name);
  return mesh.edges_of(names);
}

std::unique_ptr<BulletRun> BulletRun::links(const Workload& workload, int iterations, bool reorders,
                                            int substeps) {
  auto run = std::make_unique<BulletRun>(workload, iterations, true, substeps);
  for (std::size_t b = 0; b < run->bodies_.size(); ++b) {
    // Changes the order of links only: Bullet reads nothing else from the array.
    if (reorders) btSoftBodyHelpers::ReoptimizeLinkOrder(run->bodies_[b]);
    run->world_.solver().attach(*run->bodies_[b], run->meshes()[b], run->laws_of(false));
  }
  return run;
}

std::unique_ptr<BulletRun> BulletRun::laws(const Workload& workload, int substeps) {
  auto run = std::make_unique<BulletRun>(workload, 1, false, substeps);
  for (std::size_t b = 0; b < run->bodies_.size(); ++b) {
    run->world_.solver().attach(*run->bodies_[b], run->meshes()[b], run->laws_of(true));
  }
  return run;
}

std::unique_ptr<BulletRun> BulletRun::fast(const Workload& workload,
                                           const bridge::FastSettings& settings, int substeps) {
  auto run = std::make_unique<BulletRun>(workload, 1, false, substeps);
  for (std::size_t b = 0; b < run->bodies_.size(); ++b) {
    (void)run->world_.solver().attach_fast(*run->bodies_[b], run->meshes()[b], run->laws_of(true),
                                           settings);
  }
  return run;
}

BulletRun::BulletRun(const Workload& workload, int iterations, bool has_links, int substeps)
    : WorkloadRun(workload), substeps_(substeps), world_({{0, -9.81, 0}, 0.1}) {
  bridge::ClothSettings settings{.collision_margin = kWorkloadMargin,
                                 .friction = kWorkloadFriction,
                                 .position_iterations = iterations,
                                 .time_step = workload.time_step / substeps};
  if (has_links) settings.links.push_back({{}, workload.stiffness});
  for (const ClothMesh& mesh : meshes()) {
    bodies_.push_back(&world_.add(bridge::make_cloth_body(world_.info(), mesh, settings)));
  }
  read();
  std::shared_ptr<btCollisionShape> ground = ground_of(workload.kind);
  if (!ground) return;
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, ground.get());
  const btScalar height = workload.kind == Kind::kClassic ? 0 : -1;
  info.m_startWorldTransform = btTransform(btQuaternion::getIdentity(), btVector3(0, height, 0));
  world_.add(std::make_unique<btRigidBody>(info), std::move(ground));
}

std::vector<forces::LawSpecification> BulletRun::laws_of(bool has_tension) const {
  std::vector<forces::LawSpecification> laws = {
      {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}}};
  if (workload().kind == Kind::kBall) {
    laws.push_back({"pressure", {}, {{"pressure", {kWorkloadPressure}}}});
  }
  if (has_tension) laws.push_back({"tension", {}, {{"stiffness", {workload().stiffness}}}});
  return laws;
}

void BulletRun::step(double time) {
  for (int s = 0; s < substeps_; ++s) world_.step(time / substeps_);
  read();
}

void BulletRun::read() {
  Eigen::Index first = 0;
  Matrix3X<btScalar> x;
  Matrix3X<btScalar> v;
  for (const btSoftBody* body : bodies_) {
    bridge::read_nodes(*body, x, v);
    places_of(first, x.cols()) = x.cast<double>();
    first += x.cols();
  }
}

WorkloadRun::WorkloadRun(const Workload& workload)
    : workload_(workload), meshes_(meshes_of(workload)) {
  Eigen::Index num_nodes = 0;
  for (const ClothMesh& mesh : meshes_) num_nodes += mesh.num_nodes();
  positions_.resize(3, num_nodes);
  Eigen::Index first = 0;
  for (const ClothMesh& mesh : meshes_) {
    positions_.middleCols(first, mesh.num_nodes()) = mesh.rest_positions;
    first += mesh.num_nodes();
  }
}

std::pair<double, double> WorkloadRun::stretch() const {
  double largest = 0;
  double sum = 0;
  double count = 0;
  Eigen::Index first = 0;
  for (const ClothMesh& mesh : meshes_) {
    const Edges edges = mesh.edges_of({"stretch"});
    const VectorX<double> now = edge_lengths(positions_.middleCols(first, mesh.num_nodes()), edges);
    const VectorX<double> rest = edge_lengths(mesh.rest_positions, edges);
    const VectorX<double> change = (now.array() / rest.array() - 1).abs();
    largest = std::max(largest, change.maxCoeff());
    sum += change.sum();
    count += static_cast<double>(change.size());
    first += mesh.num_nodes();
  }
  return {largest, sum / count};
}

}  // namespace weft::bench
