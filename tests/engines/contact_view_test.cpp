// Where cloth touches colliders and how hard, as engines tell it; and colliders that are led though the scene has them stand still.
#include <weft/scenes/contact_view.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/step_commands.hpp>

namespace weft::scenes {
namespace {

constexpr double kStep = 1e-3;  // [s]
constexpr double kMass = 0.1;   // [kg]
constexpr double kGravity = 9.81;

/// A sheet a little above a box whose top is at y = 0.
Scene sheet_on_box(double friction, double sideways) {
  Scene scene;
  scene.name = "sheet";
  scene.world.time_step = kStep;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "sheet";
  cloth.grid().nodes = {5, 5};
  cloth.grid().size = {0.4, 0.4};
  cloth.grid().center = {0, 0.012, 0};
  cloth.grid().total_mass = kMass;
  cloth.collision_margin = 0.01;
  cloth.friction = friction;
  cloth.velocity = {sideways, 0, 0};
  cloth.laws = {{"tension", {}, {{"stiffness", {20.0}}}},
                {"velocity_damping", {}, {{"rate", {1.0}}}},
                {"gravity", {}, {{"acceleration", {0.0, -kGravity, 0.0}}}}};
  Collider& box = scene.colliders.emplace_back();
  box.name = "box";
  box.shape = BoxShape{{2.0, 0.1, 2.0}};
  box.position = {0, -0.1, 0};
  box.friction = friction;
  return scene;
}

std::unique_ptr<Simulator> loaded(std::string_view name, const Scene& scene) {
  auto simulator =
      find_engine(name, name == "reference" ? StoredPrecision::kFloat64 : StoredPrecision::kFloat32)
          ->make();
  simulator->load(scene);
  return simulator;
}

void run(Simulator& simulator, int num_steps) {
  for (int i = 0; i < num_steps; ++i) ASSERT_FALSE(simulator.step(kStep).blow_up);
}

class Contacts : public testing::TestWithParam<const char*> {};

TEST_P(Contacts, CarryTheWeightOfASheetThatRests) {
  const auto simulator = loaded(GetParam(), sheet_on_box(1.0, 0.0));
  const auto& view = dynamic_cast<const ContactView&>(*simulator);
  EXPECT_TRUE(view.touches().empty()) << "before the first step";
  run(*simulator, 1000);
  Vector3<double> sum(0, 0, 0);
  const std::vector<NodeTouch> touches = view.touches();
  for (const NodeTouch& touch : touches) {
    sum += touch.force;
    EXPECT_NEAR(touch.normal.y(), 1.0, 1e-3) << touch.node;
  }
  EXPECT_EQ(touches.size(), 25U);
  EXPECT_NEAR(sum.y(), kMass * kGravity, 0.02 * kMass * kGravity);
}

TEST_P(Contacts, OfASheetThatSlidesArePulledBackByFriction) {
  constexpr double kFriction = 0.2;
  const auto simulator = loaded(GetParam(), sheet_on_box(kFriction, 1.5));
  run(*simulator, 200);
  const auto& view = dynamic_cast<const ContactView&>(*simulator);
  Vector3<double> sum(0, 0, 0);
  int num_sticking = 0;
  for (const NodeTouch& touch : view.touches()) {
    sum += touch.force;
    num_sticking += touch.is_sticking ? 1 : 0;
  }
  EXPECT_EQ(num_sticking, 0);
  ASSERT_GT(sum.y(), 0.0);
  // Both bodies have this friction; Bullet takes the product.
  EXPECT_LT(sum.x(), 0.0);
  EXPECT_LE(-sum.x(), 1.05 * kFriction * sum.y());
}

INSTANTIATE_TEST_SUITE_P(Engines, Contacts, testing::Values("bullet_forces", "bullet_weft"));

/// Leads the first collider upwards.
class Hand final : public Controller {
 public:
  void steer(const SceneState& state, double end_time, StepCommands& commands) override {
    if (!leads) return;
    Pose pose{state.rigids[0].position, state.rigids[0].orientation};
    pose.position.y() += speed * (end_time - state.time);
    commands.colliders[0] = pose;
  }
  bool leads = false;
  double speed = 0.0;  ///< [m/s]
};

class Hands : public testing::TestWithParam<const char*> {};

TEST_P(Hands, LiftAColliderThatStoodStill) {
  const Scene scene = sheet_on_box(1.0, 0.0);
  const auto hand = std::make_shared<Hand>();
  const auto simulator = find_engine(GetParam(), std::string_view(GetParam()) == "reference"
                                                     ? StoredPrecision::kFloat64
                                                     : StoredPrecision::kFloat32)
                             ->make();
  simulator->set_controllers({hand});
  simulator->load(scene);
  run(*simulator, 300);
  const double before = simulator->state().cloths[0].positions.row(1).mean();
  hand->leads = true;
  hand->speed = 0.5;
  run(*simulator, 200);
  EXPECT_NEAR(simulator->state().rigids[0].position.y(), -0.1 + 0.1, 1e-5);
  EXPECT_NEAR(simulator->state().cloths[0].positions.row(1).mean() - before, 0.1, 5e-3);
  hand->speed = 0.0;
  run(*simulator, 200);
  EXPECT_NEAR(simulator->state().rigids[0].position.y(), 0.0, 1e-5) << "it stays where it is";
}

INSTANTIATE_TEST_SUITE_P(Engines, Hands,
                         testing::Values("reference", "bullet_soft", "bullet_forces",
                                         "bullet_weft"));

TEST(LedColliders, WithAMassAreRefused) {
  Scene scene = sheet_on_box(1.0, 0.0);
  scene.colliders[0].mass = 1.0;
  const auto hand = std::make_shared<Hand>();
  hand->leads = true;
  const auto simulator = find_engine("bullet_forces", StoredPrecision::kFloat32)->make();
  simulator->set_controllers({hand});
  simulator->load(scene);
  EXPECT_THROW((void)simulator->step(kStep), InvalidArgument);
}

}  // namespace
}  // namespace weft::scenes
