#include <weft/playback/export/cloth_energy.hpp>

#include <variant>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

TEST(ClothEnergy, OfAClothThatFallsFreely) {
  const samples::TemporaryFolder folder;
  Scene scene = samples::make_scene();
  scene.cloths.resize(1);
  scene.cloths[0].grid().total_mass = 0.5;
  scene.colliders.clear();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  {
    RecordingWriter writer(folder / "fall.weftrec", scene, {}, StoredPrecision::kFloat64);
    for (const double time : {0.0, 0.5, 1.0}) {
      const Vector3<double> velocity(0.25, -9.81 * time, 0);
      SceneState state;
      state.time = time;
      ClothState cloth{scene.cloths[0].name, mesh.rest_positions, mesh.rest_positions};
      cloth.positions.row(1).array() -= 0.5 * 9.81 * time * time;
      cloth.velocities.colwise() = velocity;
      state.cloths.push_back(cloth);
      writer.add_frame(state);
    }
    writer.finish();
  }
  const RecordingReader reader(folder / "fall.weftrec");
  const std::vector<PlaybackMetric> energies = cloth_energies(reader);
  ASSERT_EQ(energies.size(), 2U);
  EXPECT_EQ(energies[0].name, "cloth_kinetic_energy_J");
  EXPECT_EQ(energies[1].name, "cloth_height_energy_J");
  for (std::size_t f = 0; f < 3; ++f) {
    const double time = 0.5 * static_cast<double>(f);
    const double fallen = 0.5 * 0.5 * 9.81 * 9.81 * time * time;  // m g h = m (g t)^2 / 2
    EXPECT_NEAR(energies[0].samples[f].value, fallen + 0.5 * 0.5 * 0.0625, 1e-12);
    EXPECT_NEAR(energies[1].samples[f].value, -fallen, 1e-12);
    EXPECT_EQ(energies[1].samples[f].time, time);
  }
}

TEST(ClothEnergy, OfACharacterIsThatOfItsClothAlone) {
  const samples::TemporaryFolder folder;
  const Scene scene = load_scene("caped_figure");
  SceneState state;
  int num_skins = 0;
  for (const Cloth& cloth : scene.cloths) {
    const Matrix3X<double> places = make_mesh(cloth).rest_positions;
    const bool is_cloth = std::get<SkinSource>(cloth.source).is_cloth;
    num_skins += is_cloth ? 0 : 1;
    const double speed = is_cloth ? 0.0 : 3.0;
    state.cloths.push_back(
        {cloth.name, places, Matrix3X<double>::Constant(3, places.cols(), speed)});
  }
  for (const Collider& collider : scene.colliders) state.rigids.push_back({collider.name});
  {
    RecordingWriter writer(folder / "walk.weftrec", scene, {}, StoredPrecision::kFloat64);
    writer.add_frame(state);
    writer.finish();
  }
  ASSERT_GT(num_skins, 0);
  EXPECT_EQ(cloth_energies(RecordingReader(folder / "walk.weftrec"))[0].samples[0].value, 0.0);
}

}  // namespace
}  // namespace weft::scenes
