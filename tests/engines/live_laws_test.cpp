// Laws that change while a scene runs: the state goes on, and the new laws act.
#include <weft/scenes/live_laws.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>

namespace weft::scenes {
namespace {

constexpr double kStep = 1e-3;  // [s]
/// Bullet derives velocities from positions, in single precision about 1 m from the origin: 6e-8 m in
/// a step of 1e-3 s, for up to 100 steps [m/s].
constexpr double kRoundOff = 6e-3;

Scene falling_sheet() {
  Scene scene;
  scene.name = "sheet";
  scene.world.time_step = kStep;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.name = "sheet";
  cloth.grid().nodes = {5, 5};
  cloth.grid().size = {0.4, 0.4};
  cloth.grid().center = {0, 1, 0};
  cloth.grid().total_mass = 0.1;
  cloth.laws = {{"tension", {}, {{"stiffness", {20.0}}}},
                {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}}};
  return scene;
}

struct Loaded {
  explicit Loaded(const std::string& name, const Scene& scene)
      : simulator(find_engine(name, name == "reference" ? StoredPrecision::kFloat64
                                                        : StoredPrecision::kFloat32)
                      ->make()) {
    simulator->load(scene);
  }
  void run(int steps) const {
    for (int i = 0; i < steps; ++i) EXPECT_FALSE(simulator->step(kStep).blow_up);
  }
  [[nodiscard]] LiveLaws* laws() const { return dynamic_cast<LiveLaws*>(simulator.get()); }
  [[nodiscard]] Vector3<double> velocity() const {
    return simulator->state().cloths[0].velocities.rowwise().mean();
  }
  std::unique_ptr<Simulator> simulator;
};

class LiveLawsOf : public testing::TestWithParam<const char*> {};

TEST_P(LiveLawsOf, GravityThatTurnsActsFromTheNextStepOn) {
  const Loaded run(GetParam(), falling_sheet());
  ASSERT_NE(run.laws(), nullptr);
  run.run(100);
  const Vector3<double> before = run.velocity();
  EXPECT_NEAR(before.y(), -9.81 * 0.1, kRoundOff);
  auto laws = falling_sheet().cloths[0].laws;
  laws[1].parameters["acceleration"] = {2.0, 0.0, 0.0};
  run.laws()->replace_laws(0, laws);
  EXPECT_EQ(run.velocity(), before);
  run.run(100);
  EXPECT_NEAR(run.velocity().x(), 2.0 * 0.1, kRoundOff);
  EXPECT_NEAR(run.velocity().y(), before.y(), kRoundOff);
  EXPECT_NEAR(run.simulator->state().time, 0.2, 1e-6);
}

TEST_P(LiveLawsOf, ALawThatIsAddedActs) {
  const Loaded run(GetParam(), falling_sheet());
  auto laws = falling_sheet().cloths[0].laws;
  laws.push_back({"wind", {}, {{"velocity", {0.0, 5.0, 0.0}}}});
  const Loaded without(GetParam(), falling_sheet());
  run.laws()->replace_laws(0, laws);
  run.run(100);
  without.run(100);
  EXPECT_GT(run.velocity().y(), without.velocity().y() + 0.1);
}

TEST_P(LiveLawsOf, ARefusedLawChangesNothing) {
  const Loaded run(GetParam(), falling_sheet());
  const Loaded other(GetParam(), falling_sheet());
  auto laws = falling_sheet().cloths[0].laws;
  laws.push_back({"tension", {"no_such_set"}, {{"stiffness", {1.0}}}});
  EXPECT_THROW(run.laws()->replace_laws(0, laws), InvalidArgument);
  run.run(20);
  other.run(20);
  EXPECT_EQ(run.simulator->state().cloths[0].positions,
            other.simulator->state().cloths[0].positions);
}

TEST_P(LiveLawsOf, AClothThatTearsIsRefusedByName) {
  Scene scene = falling_sheet();
  scene.cloths[0].tear = ClothTear{};
  const Loaded run(GetParam(), scene);
  EXPECT_THAT([&] { run.laws()->replace_laws(0, scene.cloths[0].laws); },
              testing::ThrowsMessage<InvalidArgument>(testing::HasSubstr("'sheet' tears")));
}

#ifdef WEFT_TEST_BULLET
INSTANTIATE_TEST_SUITE_P(Engines, LiveLawsOf,
                         testing::Values("reference", "bullet_forces", "bullet_soft",
                                         "bullet_weft"));

TEST(LiveLaws, LinksKeepTheirTension) {
  const Loaded run("bullet_soft", falling_sheet());
  auto laws = falling_sheet().cloths[0].laws;
  laws[0].parameters["stiffness"] = {40.0};
  EXPECT_THAT([&] { run.laws()->replace_laws(0, laws); },
              testing::ThrowsMessage<InvalidArgument>(testing::HasSubstr("Bullet's links")));
}
#else
INSTANTIATE_TEST_SUITE_P(Engines, LiveLawsOf, testing::Values("reference"));
#endif

}  // namespace
}  // namespace weft::scenes
