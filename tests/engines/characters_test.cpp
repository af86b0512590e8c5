#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/characters/character_controller.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {
namespace {

constexpr int kSteps = 250;  // a quarter of a second, in which the figure turns and steps

/// How far the cape of the figure is from what was asked for, the worst of some steps.
struct Deviation {
  double attachment = 0;  ///< [m] of an attached node or a skin from the rounded animation
  double reach = -1;      ///< [m] beyond the maximum distance
  double backstop = -1;   ///< [m] within the backstop
  double collider = 0;    ///< [m] of a collider from its bone
  bool blew_up = false;
};

const SkinSource& source_of(const Cloth& cloth) {
  return std::get<SkinSource>(cloth.source);
}

/// A number as the engine stores it.
double stored(double value, StoredPrecision precision) {
  return precision == StoredPrecision::kFloat32 ? static_cast<double>(static_cast<float>(value))
                                                : value;
}

/// What of a cloth is watched.
struct Watched {
  const SkinSource* source;
  std::vector<int> pinned;
  VectorX<double> distances;  ///< [m]; empty for a skin
  ReachSettings reach;
};

Watched watched(const Cloth& cloth, const CharacterSettings& settings) {
  Watched result{&source_of(cloth), make_mesh(cloth).pinned, {}, {}};
  for (const CharacterCloth& entry : settings.cloths) {
    if (entry.cloth != cloth.name) continue;
    result.reach = entry.reach;
    result.distances = max_distances(entry.reach, *result.source);
  }
  return result;
}

void compare(const Watched& cloth, const ClothState& state, double time, StoredPrecision precision,
             Deviation& worst) {
  const Matrix3X<double> skin = skin_positions(*cloth.source, time);
  for (const int node : cloth.pinned) {
    for (int axis = 0; axis < 3; ++axis) {
      const double expected = stored(skin(axis, node), precision);
      worst.attachment =
          std::max(worst.attachment, std::abs(state.positions(axis, node) - expected));
    }
  }
  if (cloth.distances.size() == 0) return;
  const Matrix3X<double> normals = vertex_normals(skin, cloth.source->part->triangles);
  const double radius = cloth.reach.backstop_radius;
  for (Eigen::Index i = 0; i < skin.cols(); ++i) {
    if (cloth.distances[i] == 0) continue;
    const Vector3<double> x = state.positions.col(i);
    worst.reach = std::max(worst.reach, (x - skin.col(i)).norm() - cloth.distances[i]);
    const Vector3<double> middle =
        skin.col(i) - (cloth.reach.backstop_offset + radius) * normals.col(i);
    worst.backstop = std::max(worst.backstop, radius - (x - middle).norm());
  }
}

void compare_colliders(const CharacterSettings& settings, const SceneState& state,
                       Deviation& worst) {
  const auto frames = world_frames(*settings.model, settings.pose, state.time);
  for (const CharacterCollider& entry : settings.colliders) {
    const int bone = find_bone(settings.model->character.skeleton, entry.bone);
    const Pose pose = led_pose(frames[static_cast<std::size_t>(bone)], entry.place);
    for (const RigidState& rigid : state.rigids) {
      if (rigid.name != entry.collider) continue;
      worst.collider = std::max(worst.collider, (rigid.position - pose.position).norm());
    }
  }
}

Deviation run(const std::string& engine, StoredPrecision precision, const Scene& scene,
              std::vector<std::shared_ptr<Controller>> saboteurs = {}) {
  const EngineInfo* info = find_engine(engine, precision);
  if (info == nullptr) throw InvalidArgument("no engine " + engine);
  const std::unique_ptr<Simulator> simulator = info->make();
  simulator->set_controllers(std::move(saboteurs));
  simulator->load(scene);
  std::vector<Watched> cloths;
  for (const Cloth& cloth : scene.cloths) cloths.push_back(watched(cloth, scene.characters[0]));
  Deviation worst;
  for (int step = 0; step < kSteps && !worst.blew_up; ++step) {
    const StepReport report = simulator->step(scene.world.time_step);
    worst.blew_up = report.blow_up.has_value();
    SceneState state = simulator->state();
    state.time = report.time;
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      compare(cloths[c], state.cloths[c], report.time, precision, worst);
    }
    compare_colliders(scene.characters[0], state, worst);
  }
  return worst;
}

/// Three roundings of places some 2 m from the origin [m].
double rounding(StoredPrecision precision) {
  return 6.0 * (precision == StoredPrecision::kFloat32
                    ? static_cast<double>(std::numeric_limits<float>::epsilon())
                    : std::numeric_limits<double>::epsilon());
}

class CharacterEngines : public testing::TestWithParam<const EngineInfo*> {
 protected:
  /// The figure with limits so tight that both act at once. The reference runs without its capsules.
  [[nodiscard]] static Scene scene() {
    Scene scene = with_bullets_time_step(load_scene("caped_figure"));
    scene.characters[0].cloths[0].reach.max_distance = 0.03;
    scene.characters[0].cloths[0].reach.backstop_offset = 0.005;
    if (GetParam()->name != "reference") return scene;
    std::erase_if(scene.colliders, [](const Collider& c) { return !c.led_by.empty(); });
    scene.characters[0].colliders.clear();
    return scene;
  }
  [[nodiscard]] Deviation run_with(std::vector<std::shared_ptr<Controller>> saboteurs = {}) const {
    const EngineInfo& info = *GetParam();
    return run(std::string(info.name), info.precision, scene(), std::move(saboteurs));
  }
};

TEST_P(CharacterEngines, AttachedNodesAreExactlyWhereTheBonesHaveThemAfterEveryStep) {
  const Deviation worst = run_with();
  EXPECT_FALSE(worst.blew_up);
  EXPECT_EQ(worst.attachment, 0.0);
  EXPECT_LT(worst.collider, rounding(GetParam()->precision));
}

TEST_P(CharacterEngines, NoNodeIsBeyondItsMaximumDistanceOrInItsBackstopAfterAnyStep) {
  const Deviation worst = run_with();
  EXPECT_LT(worst.reach, rounding(GetParam()->precision));
  EXPECT_LT(worst.backstop, rounding(GetParam()->precision));
}

/// Puts a deliberate mistake into what the character asks for.
class Saboteur final : public Controller {
 public:
  enum class Deed { kLateNodes, kNoReach, kNoBackstop };
  explicit Saboteur(Deed deed) : deed_(deed) {}

  void steer(const SceneState&, double, StepCommands& commands) override {
    for (ClothCommands& cloth : commands.cloths) {
      const Matrix3X<double> now = cloth.pinned_positions;
      switch (deed_) {
        case Deed::kLateNodes:
          if (last_.cols() == now.cols()) cloth.pinned_positions = last_;
          break;
        case Deed::kNoReach:
          cloth.limits.max_distances.setConstant(std::numeric_limits<double>::infinity());
          break;
        case Deed::kNoBackstop:
          cloth.limits.backstop_radii.setZero();
          break;
      }
      last_ = now;
    }
  }

 private:
  Deed deed_;
  Matrix3X<double> last_;
};

TEST_P(CharacterEngines, ALagALostReachAndALostBackstopAreNoticed) {
  using Deed = Saboteur::Deed;
  const Deviation no_reach = run_with({std::make_shared<Saboteur>(Deed::kNoReach)});
  EXPECT_GT(no_reach.reach, 1e-3);
  const Deviation no_backstop = run_with({std::make_shared<Saboteur>(Deed::kNoBackstop)});
  EXPECT_GT(no_backstop.backstop, 1e-4);
  // One body only, so that the nodes of the step before have the right number.
  Scene one = scene();
  one.cloths.resize(1);
  one.characters[0].skins.clear();
  const EngineInfo& info = *GetParam();
  const Deviation late = run(std::string(info.name), info.precision, one,
                             {std::make_shared<Saboteur>(Deed::kLateNodes)});
  EXPECT_GT(late.attachment, 1e-5);
}

std::vector<const EngineInfo*> engines() {
  std::vector<const EngineInfo*> result;
  for (const EngineInfo& info : engine_table()) {
    // Bullet's deformable world leads no nodes.
    if (info.name.find("deformable") == std::string_view::npos) result.push_back(&info);
  }
  return result;
}

INSTANTIATE_TEST_SUITE_P(All, CharacterEngines, testing::ValuesIn(engines()),
                         [](const auto& info) { return std::string(info.param->name); });

}  // namespace
}  // namespace weft::scenes
