#include <weft/scenes/catalog.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Catalog, EveryFileIsEmbedded) {
  std::set<std::string> files;
  const std::string folder = std::string(WEFT_SOURCE_DIR) + "/scenes/catalog";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.insert(entry.path().stem().string());
  }
  std::set<std::string> names;
  for (const CatalogEntry& entry : scene_catalog()) names.insert(std::string(entry.name));
  EXPECT_EQ(names, files);
  for (const char* name : {"ball_on_cloth", "drape_sphere", "drop_box", "drop_ground", "hang"}) {
    EXPECT_NE(find_catalog_scene(name), nullptr) << name;
  }
}

TEST(Catalog, EverySceneReadsAndSaysWhatItShows) {
  for (const CatalogEntry& entry : scene_catalog()) {
    const Scene scene = load_scene(std::string(entry.name));
    EXPECT_EQ(scene.name, entry.name);
    EXPECT_THAT(scene.summary, StartsWith("Shows "));
    EXPECT_FALSE(scene.cloths.empty());
    for (const Cloth& cloth : scene.cloths) EXPECT_GT(make_mesh(cloth).num_nodes(), 0);
  }
}

TEST(Catalog, EverySceneSurvivesWritingAndReading) {
  for (const CatalogEntry& entry : scene_catalog()) {
    const Scene scene = read_scene_text(entry.text, std::string(entry.name));
    const std::string written = write_scene(scene);
    const Scene back = read_scene_text(written, "written.toml");
    EXPECT_EQ(write_scene(back), written);
    ASSERT_EQ(back.cloths.size(), scene.cloths.size());
    for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
      const ClothMesh first = make_mesh(scene.cloths[i]);
      const ClothMesh second = make_mesh(back.cloths[i]);
      EXPECT_EQ(first.rest_positions, second.rest_positions);
      EXPECT_EQ(first.masses, second.masses);
      EXPECT_EQ(first.pinned, second.pinned);
    }
  }
}

/// Upper bound of (omega_max dt)^2 of the springs at rest: Gershgorin's row sums of M^-1 K, where a
/// spring with direction u has the block k u u^T.
double stability_number(const Scene& scene, const Cloth& cloth) {
  const ClothMesh mesh = make_mesh(cloth);
  std::vector<Matrix3<double>> own(static_cast<std::size_t>(mesh.num_nodes()),
                                   Matrix3<double>::Zero());
  Matrix3X<double> others = Matrix3X<double>::Zero(3, mesh.num_nodes());
  for (const forces::LawSpecification& law : cloth.laws) {
    if (law.law != "tension") continue;
    const double stiffness = law.parameters.at("stiffness").at(0);
    const Edges edges = mesh.edges_of(law.sets);
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      const Vector3<double> u =
          (mesh.rest_positions.col(edges(1, e)) - mesh.rest_positions.col(edges(0, e)))
              .normalized();
      const Matrix3<double> block = stiffness * u * u.transpose();
      for (const int node : {edges(0, e), edges(1, e)}) {
        own[static_cast<std::size_t>(node)] += block;
        others.col(node) += block.cwiseAbs().rowwise().sum();
      }
    }
  }
  double largest = 0;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const Vector3<double> rows =
        own[static_cast<std::size_t>(node)].cwiseAbs().rowwise().sum() + others.col(node);
    largest = std::max(largest, rows.maxCoeff() / mesh.masses[node]);
  }
  return largest * scene.world.time_step * scene.world.time_step;
}

TEST(Catalog, EverySceneIsStableForModifiedEuler) {
  // omega_max dt < 2, the limit of modified Euler for undamped oscillators.
  constexpr double kLimit = 4.0;
  for (const CatalogEntry& entry : scene_catalog()) {
    const Scene scene = load_scene(std::string(entry.name));
    // Links that Bullet projects and implicit steps have no such limit.
    if (!is_for_engine(scene, "reference") && !is_for_engine(scene, "bullet_forces") &&
        !is_for_engine(scene, "bullet_deformable")) {
      continue;
    }
    for (const Cloth& cloth : scene.cloths) {
      EXPECT_LT(stability_number(scene, cloth), kLimit) << entry.name;
    }
  }
}

TEST(Catalog, DrapeSphereHasTheClassicNumbers) {
  const ClothMesh mesh = make_mesh(load_scene("drape_sphere").cloths.at(0));
  EXPECT_EQ(mesh.num_nodes(), 2500);
  EXPECT_EQ(mesh.num_edges(), 28518);
}

TEST(Catalog, BallOnClothIsTwoWay) {
  const Scene scene = load_scene("ball_on_cloth");
  EXPECT_TRUE(scene.colliders.at(0).mass.has_value());
  EXPECT_EQ(make_mesh(scene.cloths.at(0)).pinned.size(), 4U);
}

std::string message_of(const std::string& name) {
  try {
    (void)load_scene(name);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Catalog, UnknownNamesGetASuggestion) {
  EXPECT_THAT(message_of("drape_spher"), HasSubstr("did you mean 'drape_sphere'?"));
  EXPECT_THAT(message_of("xyz"), HasSubstr("expected one of ball_on_cloth, "));
  EXPECT_THAT(message_of(""), HasSubstr("neither a scene of the catalog nor a file"));
  EXPECT_THAT(message_of("xyz.toml"), HasSubstr("xyz.toml:1:1: no such file"));
}

TEST(Catalog, PathsAreReadAsFiles) {
  const std::string path = std::string(WEFT_SOURCE_DIR) + "/scenes/catalog/hang.toml";
  EXPECT_EQ(write_scene(load_scene(path)), write_scene(load_scene("hang")));
}

}  // namespace
}  // namespace weft::scenes
