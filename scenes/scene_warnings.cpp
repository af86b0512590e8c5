#include <weft/scenes/scene_warnings.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/custom_forces/spectrum.hpp>
#include <weft/scenes/engine_kind.hpp>

namespace weft::scenes {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
/// What steps of bullet_weft are solved with, in single and in double precision (bridge/implicit/stiffness_limit.hpp).
constexpr double kMostStiffness = 1e6;
constexpr double kMostStiffnessOfDoubles = 1e7;

HalfExtents sorted(Vector3<double> half) {
  std::sort(half.begin(), half.end());
  return {half[0], half[1]};
}

HalfExtents extents(const SphereShape& sphere) {
  return {sphere.radius, sphere.radius};
}
HalfExtents extents(const BoxShape& box) {
  return sorted(box.half_extents);
}
HalfExtents extents(const PlaneShape& /*plane*/) {
  return {kEndless, kEndless};
}
HalfExtents extents(const CapsuleShape& capsule) {
  return {capsule.radius, capsule.radius};
}
HalfExtents extents(const CylinderShape& cylinder) {
  return sorted({cylinder.radius, cylinder.height / 2, cylinder.radius});
}
HalfExtents extents(const ConeShape& cone) {
  return sorted({cone.radius, cone.height / 2, cone.radius});
}
HalfExtents extents(const ConvexHullShape& hull) {
  return sorted((hull.points.rowwise().maxCoeff() - hull.points.rowwise().minCoeff()) / 2);
}
HalfExtents extents(const MeshShape& /*mesh*/) {
  return {kEndless, kEndless};
}
HalfExtents extents(const HeightFieldShape& /*field*/) {
  return {kEndless, kEndless};
}
HalfExtents extents(const CompoundShape& compound) {
  HalfExtents all{kEndless, kEndless};
  for (const CompoundPart& part : compound.parts) {
    const HalfExtents one = half_extents(as_shape(part.shape));
    all = {std::min(all.least, one.least), std::min(all.middle, one.middle)};
  }
  return all;
}

std::vector<forces::SetUpCollider> colliders_of(const Scene& scene) {
  std::vector<forces::SetUpCollider> colliders;
  for (const Collider& collider : scene.colliders) {
    const HalfExtents half = half_extents(collider.shape);
    colliders.push_back({.name = collider.name,
                         .least_half_extent = half.least,
                         .middle_half_extent = half.middle,
                         .mass = collider.mass,
                         .speed = collider.velocity.norm()});
  }
  return colliders;
}

/// Whether springs may blow up. Bullet's links and its implicit forces do not; the reference does with explicit integrators, unless it
/// divides or refuses such steps.
bool may_blow_up(const Scene& scene, const EngineKind& kind) {
  if (kind.name == kReferenceEngine.name) {
    return scene.reference.integrator < Integrator::kImplicitEuler &&
           scene.reference.step_guard == StepGuard::kReport;
  }
  return kind.name == kBulletForces.name || kind.name == kBulletDeformable.name;
}

/// One cloth for several engines: its mesh and its stable step are found once.
class ClothWarnings {
 public:
  ClothWarnings(const Scene& scene, const Cloth& cloth, bool is_single_precision)
      : scene_(scene),
        cloth_(cloth),
        is_single_precision_(is_single_precision),
        is_led_(std::holds_alternative<SkinSource>(cloth.source)) {
    const double thickness = cloth.self_thickness.value_or(2 * cloth.collision_margin);
    set_up_ = {.mesh = make_mesh(cloth),
               .laws = cloth.laws,
               .margin = cloth.collision_margin,
               .speed = cloth.velocity.norm(),
               .layer_distance = cloth.self_collision ? thickness : 0,
               .meets_cloth = cloth.soft_collision};
    if (!is_led_) set_up_.colliders = colliders_of(scene);
  }

  void add(const std::string& engine, std::vector<SceneWarning>& warnings) {
    const EngineKind* const kind = find_engine_kind(engine);
    if (kind == nullptr) {
      throw InvalidArgument("warnings: engine = '" + engine +
                            "', expected one of the engines of weft list");
    }
    for (forces::SetUpWarning& warning : forces::find_warnings(set_up_for(*kind))) {
      const auto is_same = [&](const SceneWarning& other) {
        return other.cloth == cloth_.name && other.warning.message == warning.message;
      };
      const auto known = std::find_if(warnings.begin(), warnings.end(), is_same);
      if (known == warnings.end()) {
        warnings.push_back({cloth_.name, std::move(warning), {engine}});
      } else {
        known->engines.push_back(engine);
      }
    }
  }

 private:
  const forces::ClothSetUp& set_up_for(const EngineKind& kind) {
    set_up_.time_step = with_step_of(scene_, kind.name).world.time_step;
    set_up_.is_always_stable = is_led_ || !may_blow_up(scene_, kind);
    set_up_.most_stiffness = kEndless;
    if (kind.is_implicit) {
      set_up_.most_stiffness = is_single_precision_ ? kMostStiffness : kMostStiffnessOfDoubles;
    }
    set_up_.is_single_precision = is_single_precision_ && kind.uses_bullet;
    set_up_.keeps_layers_apart = kind.name == kBulletWeft.name;
    set_up_.is_swept = !kind.has_links && !kind.is_deformable;
    if (!set_up_.is_always_stable && !set_up_.stable_time_step) {
      set_up_.stable_time_step = forces::critical_time_step(set_up_.mesh, set_up_.laws);
    }
    return set_up_;
  }

  const Scene& scene_;
  const Cloth& cloth_;
  bool is_single_precision_;
  bool is_led_;
  forces::ClothSetUp set_up_;
};

}  // namespace

HalfExtents half_extents(const Shape& shape) {
  return std::visit([](const auto& one) { return extents(one); }, shape);
}

std::vector<SceneWarning> find_warnings(const Scene& scene, const std::vector<std::string>& engines,
                                        bool is_single_precision) {
  std::vector<SceneWarning> warnings;
  for (const Cloth& cloth : scene.cloths) {
    const auto* const skin = std::get_if<SkinSource>(&cloth.source);
    if (skin != nullptr && !skin->is_cloth) continue;  // drawn only
    ClothWarnings of_cloth(scene, cloth, is_single_precision);
    for (const std::string& engine : engines) of_cloth.add(engine, warnings);
  }
  return warnings;
}

}  // namespace weft::scenes
