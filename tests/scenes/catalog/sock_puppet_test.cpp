// Werth 2008: the cloth of a sock puppet is attached at key points to an invisible moving construct that gives it volume.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/scenes/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

/// Looks to its left: a part of the clip in which the hand moves a lot.
constexpr double kDuration = 1.0;

const SkinSource& source_of(const Scene& scene) {
  return std::get<SkinSource>(scene.cloths[0].source);
}

/// Nodes of the cuff: the only ones that are held at the open end.
std::vector<int> lowest_nodes(const Matrix3X<double>& rest) {
  std::vector<int> nodes;
  const double lowest = rest.row(1).minCoeff();
  for (int i = 0; i < rest.cols(); ++i) {
    if (rest(1, i) < lowest + 1e-5) nodes.push_back(i);
  }
  return nodes;
}

/// Volume between the sock and the plane of its cuff [m^3], by the divergence theorem: seen from a place
/// in that plane the opening adds nothing.
double volume_of(const ClothMesh& mesh, const std::vector<int>& cuff,
                 const Matrix3X<double>& positions) {
  Vector3<double> origin = Vector3<double>::Zero();
  for (const int node : cuff) origin += positions.col(node) / static_cast<double>(cuff.size());
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> a = positions.col(mesh.triangles(0, t)) - origin;
    const Vector3<double> b = positions.col(mesh.triangles(1, t)) - origin;
    const Vector3<double> c = positions.col(mesh.triangles(2, t)) - origin;
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

struct SockNumbers {
  double least_volume = 9;    ///< of the volume that the bones have at that time
  double most_volume = 0;     ///< the same
  double loosest = 0;         ///< [m] of a free node from its place on the skin
  double way_of_head = 0;     ///< [m] of the foremost node from its start
  double head_from_hand = 0;  ///< [m] of that node from its place on the skin
  int off_the_hand = 0;       ///< key points that are not on the rounded skin, of all frames
  int looked = 0;             ///< key points, of all frames
};

/// keys: nodes that must be on the skin.
SockNumbers measure(const Scene& scene, const std::vector<int>& keys) {
  const SkinSource& source = source_of(scene);
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const std::vector<int> cuff = lowest_nodes(mesh.rest_positions);
  const Matrix3X<double> start = skin_positions(source, 0.0);
  Eigen::Index head = 0;  // the puppet looks along +z
  start.row(2).maxCoeff(&head);
  SockNumbers numbers;
  run_scene(scene, [&](const SceneState& state) {
    const Matrix3X<double>& x = state.cloths[0].positions;
    const Matrix3X<double> skin = skin_positions(source, state.time);
    for (const int node : keys) {
      // The engine computes in single precision: the place is the nearest float, nothing else.
      const Vector3<double> rounded = skin.col(node).cast<float>().cast<double>();
      if (x.col(node) != rounded) ++numbers.off_the_hand;
      ++numbers.looked;
    }
    const double ratio = volume_of(mesh, cuff, x) / volume_of(mesh, cuff, skin);
    numbers.least_volume = std::min(numbers.least_volume, ratio);
    numbers.most_volume = std::max(numbers.most_volume, ratio);
    numbers.loosest = std::max(numbers.loosest, (x - skin).colwise().norm().maxCoeff());
    numbers.way_of_head = std::max(numbers.way_of_head, (x - start).col(head).norm());
    numbers.head_from_hand = std::max(numbers.head_from_hand, (x - skin).col(head).norm());
  });
  testing::Test::RecordProperty("least_volume", std::to_string(numbers.least_volume));
  testing::Test::RecordProperty("most_volume", std::to_string(numbers.most_volume));
  testing::Test::RecordProperty("loosest", std::to_string(numbers.loosest));
  testing::Test::RecordProperty("way_of_head", std::to_string(numbers.way_of_head));
  testing::Test::RecordProperty("head_from_hand", std::to_string(numbers.head_from_hand));
  return numbers;
}

Scene short_scene() {
  Scene scene = load_scene("sock_puppet");
  scene.world.duration = kDuration;
  return scene;
}

TEST(SockPuppetScene, HangsOnItsKeyPointsAndTheHandGivesItVolume) {
  const Scene scene = short_scene();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const auto num_keys = static_cast<int>(mesh.pinned.size());
  EXPECT_GT(num_keys, 100);
  EXPECT_LT(num_keys, mesh.num_nodes() / 2);  // most of the sock is free
  const SockNumbers numbers = measure(scene, mesh.pinned);
  EXPECT_EQ(numbers.looked, num_keys * 25);  // frames
  EXPECT_EQ(numbers.off_the_hand, 0);
  EXPECT_GT(numbers.least_volume, 0.85);
  EXPECT_LT(numbers.most_volume, 1.1);
  EXPECT_GT(numbers.way_of_head, 0.1);
  // Free cloth is no skin: it lags and sags, and never beyond its limit.
  EXPECT_GT(numbers.loosest, 0.005);
  EXPECT_LT(numbers.loosest, 0.03 + 1e-6);
}

TEST(SockPuppetScene, WithoutTheHandItFallsTogether) {
  Scene scene = short_scene();
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const std::vector<int> keys = mesh.pinned;
  // Only the cuff is held: the other key points are free, and so is what was near them.
  scene.cloths[0].pins = {NodePin{lowest_nodes(mesh.rest_positions)}};
  scene.characters[0].cloths[0].reach.paint.reset();
  scene.characters[0].cloths[0].reach.max_distance.reset();
  scene.world.duration = 0.4;
  const SockNumbers numbers = measure(scene, keys);
  EXPECT_GT(numbers.off_the_hand, numbers.looked / 2);
  EXPECT_LT(numbers.least_volume, 0.85);
  EXPECT_GT(numbers.head_from_hand, 0.03);
}

// Its neck folds, and triangles there are squeezed until hinges are many times as stiff as at rest: with the stiffness of the rest shape
// alone a quarter of the steps is not solved.
TEST(SockPuppetScene, IsSolvedToTheTolerance) {
  const SolveNumbers numbers = measure_solves(load_scene("sock_puppet"));
  EXPECT_LT(numbers.unsolved_share, 0.08);
  EXPECT_LT(numbers.largest_error, 5e-3);  // [m]
}

}  // namespace
}  // namespace weft::scenes
