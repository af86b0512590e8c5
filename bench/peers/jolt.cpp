#include <cstdint>
#include <memory>
#include <vector>

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseLayerInterfaceTable.h>
#include <Jolt/Physics/Collision/BroadPhase/ObjectVsBroadPhaseLayerFilterTable.h>
#include <Jolt/Physics/Collision/ObjectLayerPairFilterTable.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/SoftBody/SoftBodyCreationSettings.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>
#include <Jolt/Physics/SoftBody/SoftBodySharedSettings.h>
#include <Jolt/RegisterTypes.h>

#include <Eigen/Geometry>

#include "bench/peers/peers.hpp"

namespace weft::bench {
namespace {

constexpr JPH::ObjectLayer kFixed = 0;
constexpr JPH::ObjectLayer kMoving = 1;

void start_library() {
  static const bool once = [] {
    JPH::RegisterDefaultAllocator();
    JPH::Factory::sInstance = new JPH::Factory();
    JPH::RegisterTypes();
    return true;
  }();
  (void)once;
}

/// Cloths meet what stands still, and not one another.
struct ObjectLayers {
  JPH::BroadPhaseLayerInterfaceTable broad{2, 2};
  JPH::ObjectLayerPairFilterTable pairs{2};

  ObjectLayers() {
    broad.MapObjectToBroadPhaseLayer(kFixed, JPH::BroadPhaseLayer(0));
    broad.MapObjectToBroadPhaseLayer(kMoving, JPH::BroadPhaseLayer(1));
    pairs.EnableCollision(kFixed, kMoving);
  }
};

/// The library reads the pairs when it makes the last table: they must be complete by then.
struct Layers : ObjectLayers {
  JPH::ObjectVsBroadPhaseLayerFilterTable versus{broad, 2, pairs, 2};
};

/// [m^3] of a closed mesh whose triangles turn outwards.
double enclosed_volume(const ClothMesh& mesh) {
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> a = mesh.rest_positions.col(mesh.triangles(0, t));
    const Vector3<double> b = mesh.rest_positions.col(mesh.triangles(1, t));
    const Vector3<double> c = mesh.rest_positions.col(mesh.triangles(2, t));
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

class JoltRun final : public WorkloadRun {
 public:
  JoltRun(const Workload& workload, int iterations, bool has_attachments)
      : WorkloadRun(workload), temporary_(64 * 1024 * 1024), jobs_(JPH::cMaxPhysicsJobs) {
    layers_ = std::make_unique<Layers>();
    system_.Init(1024, 0, 1024, 1024, layers_->broad, layers_->versus, layers_->pairs);
    system_.SetGravity({0, -9.81F, 0});
    for (const ClothMesh& mesh : meshes()) add(mesh, iterations, has_attachments);
    add_ground();
    system_.OptimizeBroadPhase();
  }

  void step(double time) override {
    system_.Update(static_cast<float>(time), 1, &temporary_, &jobs_);
    Eigen::Index first = 0;
    for (const JPH::BodyID id : bodies_) {
      const JPH::Body* body = system_.GetBodyLockInterfaceNoLock().TryGetBody(id);
      const auto& motion =
          static_cast<const JPH::SoftBodyMotionProperties&>(*body->GetMotionProperties());
      const auto& vertices = motion.GetVertices();
      const JPH::RVec3 center = body->GetCenterOfMassPosition();
      auto places = places_of(first, static_cast<Eigen::Index>(vertices.size()));
      for (std::size_t n = 0; n < vertices.size(); ++n) {
        const JPH::Vec3 x = vertices[n].mPosition + JPH::Vec3(center);
        places.col(static_cast<Eigen::Index>(n)) << x.GetX(), x.GetY(), x.GetZ();
      }
      first += static_cast<Eigen::Index>(vertices.size());
    }
  }

 private:
  void add(const ClothMesh& mesh, int iterations, bool has_attachments) {
    JPH::Ref<JPH::SoftBodySharedSettings> shared = new JPH::SoftBodySharedSettings;
    for (int n = 0; n < mesh.num_nodes(); ++n) {
      const Vector3<float> x = mesh.rest_positions.col(n).cast<float>();
      shared->mVertices.emplace_back(JPH::Float3(x.x(), x.y(), x.z()), JPH::Float3(0, 0, 0),
                                     static_cast<float>(1 / mesh.masses[n]));
    }
    for (const int pin : mesh.pinned) {
      shared->mVertices[static_cast<std::size_t>(pin)].mInvMass = 0;
    }
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      shared->AddFace(
          JPH::SoftBodySharedSettings::Face(static_cast<std::uint32_t>(mesh.triangles(0, t)),
                                            static_cast<std::uint32_t>(mesh.triangles(1, t)),
                                            static_cast<std::uint32_t>(mesh.triangles(2, t))));
    }
    const Edges edges = springs_of(mesh);
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      shared->mEdgeConstraints.emplace_back(static_cast<std::uint32_t>(edges(0, e)),
                                            static_cast<std::uint32_t>(edges(1, e)),
                                            static_cast<float>(1 / workload().stiffness));
    }
    shared->CalculateEdgeLengths();
    if (has_attachments) {
      for (const int pin : mesh.pinned) {
        for (int n = 0; n < mesh.num_nodes(); ++n) {
          if (n == pin) continue;
          shared->mLRAConstraints.emplace_back(
              static_cast<std::uint32_t>(pin), static_cast<std::uint32_t>(n),
              static_cast<float>(
                  (mesh.rest_positions.col(n) - mesh.rest_positions.col(pin)).norm()));
        }
      }
    }
    shared->Optimize();
    JPH::SoftBodyCreationSettings settings(shared, JPH::RVec3::sZero(), JPH::Quat::sIdentity(),
                                           kMoving);
    settings.mNumIterations = static_cast<std::uint32_t>(iterations);
    settings.mLinearDamping = 0;
    settings.mFriction = static_cast<float>(kWorkloadFriction);
    settings.mVertexRadius = static_cast<float>(kWorkloadMargin);
    settings.mUpdatePosition = false;
    settings.mAllowSleeping = false;
    // The library's pressure is n R T: over the volume it is in pascals.
    if (workload().kind == Workload::Kind::kBall) {
      settings.mPressure = static_cast<float>(kWorkloadPressure * enclosed_volume(mesh));
    }
    bodies_.push_back(
        system_.GetBodyInterface().CreateAndAddSoftBody(settings, JPH::EActivation::Activate));
  }

  void add_ground() {
    if (workload().kind == Workload::Kind::kHang) return;
    const bool is_ball = workload().kind == Workload::Kind::kClassic;
    JPH::Ref<JPH::Shape> shape;
    if (is_ball) {
      shape = new JPH::SphereShape(2);
    } else {
      shape = new JPH::BoxShape({40, 1, 40});
    }
    JPH::BodyCreationSettings settings(shape, JPH::RVec3(0, is_ball ? 0 : -1, 0),
                                       JPH::Quat::sIdentity(), JPH::EMotionType::Static, kFixed);
    settings.mFriction = static_cast<float>(kWorkloadFriction);
    system_.GetBodyInterface().CreateAndAddBody(settings, JPH::EActivation::DontActivate);
  }

  /// The library must be started before anything of it is made.
  struct Started {
    Started() { start_library(); }
  } started_;
  JPH::TempAllocatorImpl temporary_;
  JPH::JobSystemSingleThreaded jobs_;
  std::unique_ptr<Layers> layers_;
  JPH::PhysicsSystem system_;
  std::vector<JPH::BodyID> bodies_;
};

}  // namespace

std::vector<Candidate> jolt_candidates(const Workload& workload) {
  std::vector<Candidate> list;
  const bool is_held = workload.kind == Workload::Kind::kHang;
  for (const bool has_attachments : {false, true}) {
    if (has_attachments && !is_held) continue;
    for (const int iterations : {5, 10, 20, 40, 80}) {
      Candidate one;
      one.solver = has_attachments ? "jolt with attachments" : "jolt";
      one.settings = std::to_string(iterations);
      one.run = std::make_unique<JoltRun>(workload, iterations, has_attachments);
      list.push_back(std::move(one));
    }
  }
  return list;
}

}  // namespace weft::bench
