#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <NvCloth/Callbacks.h>
#include <NvCloth/Cloth.h>
#include <NvCloth/Fabric.h>
#include <NvCloth/Factory.h>
#include <NvCloth/PhaseConfig.h>
#include <NvCloth/Solver.h>
#include <foundation/PxErrorCallback.h>
#include <foundation/PxVec4.h>

#include <weft/core/error.hpp>

#include "bench/peers/peers.hpp"

namespace weft::bench {
namespace {

using nv::cloth::Range;

class Allocator final : public physx::PxAllocatorCallback {
 public:
  void* allocate(std::size_t size, const char*, const char*, int) override {
    return std::aligned_alloc(64, (size + 63) / 64 * 64);
  }
  void deallocate(void* pointer) override { std::free(pointer); }
};

class Errors final : public physx::PxErrorCallback {
 public:
  void reportError(physx::PxErrorCode::Enum, const char* message, const char* file,
                   int line) override {
    std::fprintf(stderr, "NvCloth: %s (%s:%d)\n", message, file, line);
  }
};

class Asserts final : public nv::cloth::PxAssertHandler {
 public:
  void operator()(const char* expression, const char* file, int line, bool&) override {
    std::fprintf(stderr, "NvCloth: not %s (%s:%d)\n", expression, file, line);
  }
};

/// The library's one factory of cloths on the processor.
nv::cloth::Factory& factory() {
  static Allocator allocator;
  static Errors errors;
  static Asserts asserts;
  static nv::cloth::Factory* const made = [] {
    nv::cloth::InitializeNvCloth(&allocator, &errors, &asserts, nullptr);
    return NvClothCreateFactoryCPU();
  }();
  return *made;
}

template <typename T>
Range<const T> range(const std::vector<T>& values) {
  return {values.data(), values.data() + values.size()};
}

/// Springs in sets of which no two share a node: the library solves four of a set at once.
std::vector<std::vector<int>> independent_sets(const Edges& edges, int num_nodes) {
  std::vector<std::vector<bool>> taken;  // by set, by node
  std::vector<std::vector<int>> sets;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const auto a = static_cast<std::size_t>(edges(0, e));
    const auto b = static_cast<std::size_t>(edges(1, e));
    std::size_t s = 0;
    while (s < sets.size() && (taken[s][a] || taken[s][b])) ++s;
    if (s == sets.size()) {
      sets.emplace_back();
      taken.emplace_back(static_cast<std::size_t>(num_nodes), false);
    }
    taken[s][a] = taken[s][b] = true;
    sets[s].push_back(static_cast<int>(e));
  }
  return sets;
}

struct DropCloth {
  void operator()(nv::cloth::Cloth* cloth) const { delete cloth; }
};
struct DropSolver {
  void operator()(nv::cloth::Solver* solver) const { delete solver; }
};

class NvClothRun final : public WorkloadRun {
 public:
  NvClothRun(const Workload& workload, int iterations, bool has_tethers)
      : WorkloadRun(workload), solver_(factory().createSolver()) {
    for (const ClothMesh& mesh : meshes()) add(mesh, iterations, has_tethers);
  }
  ~NvClothRun() override {
    for (const auto& cloth : cloths_) solver_->removeCloth(cloth.get());
    cloths_.clear();
    for (nv::cloth::Fabric* fabric : fabrics_) fabric->decRefCount();
  }

  void step(double time) override {
    if (solver_->beginSimulation(static_cast<float>(time))) {
      for (int i = 0; i < solver_->getSimulationChunkCount(); ++i) solver_->simulateChunk(i);
      solver_->endSimulation();
    }
    Eigen::Index first = 0;
    for (const auto& cloth : cloths_) {
      const nv::cloth::MappedRange<const physx::PxVec4> particles =
          static_cast<const nv::cloth::Cloth&>(*cloth).getCurrentParticles();
      const auto count = static_cast<Eigen::Index>(particles.size());
      auto places = places_of(first, count);
      for (Eigen::Index n = 0; n < count; ++n) {
        const physx::PxVec4& p = particles[static_cast<std::uint32_t>(n)];
        places.col(n) << p.x, p.y, p.z;
      }
      first += count;
    }
  }

 private:
  void add(const ClothMesh& mesh, int iterations, bool has_tethers) {
    const Edges edges = springs_of(mesh);
    const VectorX<double> lengths = edge_lengths(mesh.rest_positions, edges);
    const auto sets_of_edges = independent_sets(edges, mesh.num_nodes());
    std::vector<std::uint32_t> phases;
    std::vector<std::uint32_t> ends;
    std::vector<float> rest;
    std::vector<std::uint32_t> indices;
    for (const std::vector<int>& set : sets_of_edges) {
      phases.push_back(static_cast<std::uint32_t>(phases.size()));
      for (const int e : set) {
        rest.push_back(static_cast<float>(lengths[e]));
        indices.push_back(static_cast<std::uint32_t>(edges(0, e)));
        indices.push_back(static_cast<std::uint32_t>(edges(1, e)));
      }
      ends.push_back(static_cast<std::uint32_t>(rest.size()));
    }
    std::vector<std::uint32_t> anchors;
    std::vector<float> tethers;
    if (has_tethers) {
      for (const int pin : mesh.pinned) {
        for (int n = 0; n < mesh.num_nodes(); ++n) {
          anchors.push_back(static_cast<std::uint32_t>(pin));
          tethers.push_back(static_cast<float>(
              (mesh.rest_positions.col(n) - mesh.rest_positions.col(pin)).norm()));
        }
      }
    }
    const std::vector<float> no_stiffness;
    const std::vector<std::uint32_t> no_triangles;
    nv::cloth::Fabric* fabric = factory().createFabric(
        static_cast<std::uint32_t>(mesh.num_nodes()), range(phases), range(ends), range(rest),
        range(no_stiffness), range(indices), range(anchors), range(tethers), range(no_triangles));
    fabrics_.push_back(fabric);
    std::vector<physx::PxVec4> particles;
    for (int n = 0; n < mesh.num_nodes(); ++n) {
      const Vector3<float> x = mesh.rest_positions.col(n).cast<float>();
      particles.emplace_back(x.x(), x.y(), x.z(), static_cast<float>(1 / mesh.masses[n]));
    }
    for (const int pin : mesh.pinned) particles[static_cast<std::size_t>(pin)].w = 0;
    nv::cloth::Cloth* cloth = factory().createCloth(range(particles), *fabric);
    cloths_.emplace_back(cloth);
    cloth->setGravity({0, -9.81F, 0});
    cloth->setDamping({0, 0, 0});
    cloth->setSolverFrequency(static_cast<float>(iterations / workload().time_step));
    cloth->setFriction(static_cast<float>(kWorkloadFriction));
    cloth->setSleepThreshold(0);
    cloth->setTetherConstraintStiffness(1);
    std::vector<nv::cloth::PhaseConfig> configurations;
    for (std::size_t s = 0; s < phases.size(); ++s) {
      configurations.emplace_back(static_cast<std::uint16_t>(s));
    }
    cloth->setPhaseConfig(range(configurations));
    add_ground(*cloth);
    solver_->addCloth(cloth);
  }

  void add_ground(nv::cloth::Cloth& cloth) const {
    const auto margin = static_cast<float>(kWorkloadMargin);
    if (workload().kind == Workload::Kind::kHang) return;
    if (workload().kind == Workload::Kind::kClassic) {
      const std::vector<physx::PxVec4> ball = {{0, 0, 0, 2 + margin}};
      cloth.setSpheres(range(ball), 0, 0);
      return;
    }
    const std::vector<physx::PxVec4> ground = {{0, 1, 0, -margin}};
    const std::vector<std::uint32_t> first_plane = {1};
    cloth.setPlanes(range(ground), 0, 0);
    cloth.setConvexes(range(first_plane), 0, 0);
  }

  std::unique_ptr<nv::cloth::Solver, DropSolver> solver_;
  std::vector<nv::cloth::Fabric*> fabrics_;
  std::vector<std::unique_ptr<nv::cloth::Cloth, DropCloth>> cloths_;
};

}  // namespace

std::vector<Candidate> nvcloth_candidates(const Workload& workload) {
  std::vector<Candidate> list;
  if (workload.kind == Workload::Kind::kBall) return list;
  const bool is_held = workload.kind == Workload::Kind::kHang;
  for (const bool has_tethers : {false, true}) {
    if (has_tethers && !is_held) continue;
    for (const int iterations : {2, 5, 10, 20, 40, 80, 160}) {
      Candidate one;
      one.solver = has_tethers ? "nvcloth with tethers" : "nvcloth";
      one.settings = std::to_string(iterations);
      one.run = std::make_unique<NvClothRun>(workload, iterations, has_tethers);
      list.push_back(std::move(one));
    }
  }
  return list;
}

}  // namespace weft::bench
