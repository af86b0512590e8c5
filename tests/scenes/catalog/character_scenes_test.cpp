// What must hold in the scenes of Werth 2008 and in the two winds of de Joya 2011.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>

#include "tests/scenes/catalog/scene_run.hpp"

namespace weft::scenes {
namespace {

/// Volume inside a closed surface [m^3], by the divergence theorem.
double volume_of(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Vector3<double> a = positions.col(mesh.triangles(0, t));
    const Vector3<double> b = positions.col(mesh.triangles(1, t));
    const Vector3<double> c = positions.col(mesh.triangles(2, t));
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

Vector3<double> center_of(const ClothMesh& mesh, const Matrix3X<double>& positions) {
  return positions * mesh.masses / mesh.masses.sum();
}

TEST(GhostScene, TheSheetStaysOnItsHeadAndOutOfIt) {
  const Scene scene = load_scene("ghost");
  const double radius = std::get<SphereShape>(scene.colliders[0].shape).radius;
  const double margin = scene.cloths[0].collision_margin;
  double deepest = 0;
  double loosest = 0;
  double widest = 0;
  run_scene(scene, [&](const SceneState& state) {
    if (state.time < 1.6) return;  // still falling
    const Matrix3X<double> arms = state.cloths[0].positions.colwise() - state.rigids[0].position;
    const double nearest = arms.colwise().norm().minCoeff();
    deepest = std::max(deepest, radius - nearest);
    loosest = std::max(loosest, nearest - radius);
    widest = std::max(widest, (state.rigids[0].position - Vector3<double>(0, 1.6, 0)).norm());
  });
  EXPECT_LT(deepest, margin);      // no node is deeper than the margin
  EXPECT_LT(loosest, 2 * margin);  // and some node always lies on the head
  EXPECT_GT(widest, 1.0);          // the head does travel
}

TEST(FlyingCarpetScene, TheLeadingEdgeIsOnItsSplineToTheLastBit) {
  const Scene scene = load_scene("flying_carpet");
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const PathMotion motion(*scene.cloths[0].moving_pins[0].path);
  const Pose start = motion.pose(0.0);
  int looked = 0;
  double lowest_bank = 1;
  run_scene(scene, [&](const SceneState& state) {
    if (state.time == 0) return;
    const Pose now = motion.pose(state.time);
    for (const int node : mesh.pinned) {
      const Vector3<double> arm =
          start.orientation.conjugate() * (mesh.rest_positions.col(node) - start.position);
      const Vector3<double> place = now.position + now.orientation * arm;
      // The engine computes in single precision: the place is the nearest float, nothing else.
      const Vector3<float> rounded = place.cast<float>();
      const Vector3<float> found = state.cloths[0].positions.col(node).cast<float>();
      ASSERT_EQ(found, rounded) << state.time;
      ++looked;
    }
    lowest_bank = std::min(lowest_bank, (now.orientation * Vector3<double>::UnitY()).y());
  });
  EXPECT_GT(looked, 1000);
  EXPECT_LT(lowest_bank, std::cos(0.2));  // it does bank, by more than 11 degrees
}

TEST(OozeScene, StandsTurnsAndReachesItsTarget) {
  const Scene scene = load_scene("ooze");
  const auto& seek = std::get<Seek>(scene.controllers[0]);
  const PathMotion target(seek.target);
  const int middle = 14 * 29 + 14;
  double lowest = 1;
  double distance = 9;
  double way_gone = 0;
  double most_turned = 0;
  run_scene(scene, [&](const SceneState& state) {
    const Matrix3X<double>& x = state.cloths[0].positions;
    if (state.time > 0.5) lowest = std::min(lowest, x(1, middle));
    Vector3<double> way = target.position(state.time) - x.col(middle);
    way.y() = 0;
    distance = way.norm();
    way_gone = std::max(way_gone, x.col(middle).norm());
    // Row of nodes through the middle, along +x at the start.
    const Vector3<double> row = x.col(middle + 5) - x.col(middle - 5);
    most_turned = std::max(most_turned, std::abs(std::atan2(row.z(), row.x())));
  });
  EXPECT_GT(lowest, 0.2);  // of 0.35 m at rest
  EXPECT_GT(way_gone, 0.4);
  EXPECT_GT(most_turned, 0.5);
  EXPECT_LT(distance, seek.arrival);
}

TEST(SquishyBallScene, RollsOnItsTorqueAndKeepsItsVolume) {
  const Scene scene = load_scene("squishy_ball");
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  const double rest = volume_of(mesh, mesh.rest_positions);
  const Vector3<double> start = center_of(mesh, mesh.rest_positions);
  double smallest = 9;
  double largest = 0;
  Vector3<double> end = start;
  run_scene(scene, [&](const SceneState& state) {
    const double ratio = volume_of(mesh, state.cloths[0].positions) / rest;
    smallest = std::min(smallest, ratio);
    largest = std::max(largest, ratio);
    end = center_of(mesh, state.cloths[0].positions);
  });
  EXPECT_GT(smallest, 0.8);
  EXPECT_LT(largest, 1.1);
  EXPECT_GT((end - start).norm(), 3.0);

  Scene still = scene;  // what rolls it is the torque, and nothing else
  still.controllers.clear();
  still.world.duration = 2;
  run_scene(still,
            [&](const SceneState& state) { end = center_of(mesh, state.cloths[0].positions); });
  EXPECT_LT(std::abs(end.x() - start.x()), 0.1);
}

TEST(WindScene, OneClothHoversAndTheFlagStreams) {
  const Scene scene = load_scene("wind");
  double lowest = 9;
  double highest = 0;
  double least_reach = 9;
  run_scene(scene, [&](const SceneState& state) {
    if (state.time < 2) return;
    const double height = state.cloths[1].positions.row(1).mean();
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    least_reach = std::min(least_reach, state.cloths[0].positions.row(0).maxCoeff() -
                                            state.cloths[0].positions.row(0).minCoeff());
  });
  EXPECT_GT(lowest, 1.0);             // it started at 1.2 m
  EXPECT_LT(highest - lowest, 0.25);  // and drifts by less than this in 3 s
  EXPECT_GT(least_reach, 0.8);        // of 1.2 m
}

TEST(DrapeTorsionScene, TheMoreTorsionTheWiderTheClothStands) {
  const Scene scene = load_scene("drape_torsion");
  std::vector<double> heights(scene.cloths.size());
  run_scene(scene, [&](const SceneState& state) {
    for (std::size_t c = 0; c < heights.size(); ++c) {
      heights[c] = state.cloths[c].positions.row(1).mean();
    }
  });
  for (std::size_t c = 2; c < heights.size(); ++c)
    EXPECT_GT(heights[c], heights[c - 1] + 0.01) << c;
  EXPECT_GE(heights[1], heights[0] - 0.002);  // soft folds stand about as low as a handkerchief
}

}  // namespace
}  // namespace weft::scenes
