#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/motion/path.hpp>

namespace weft::scenes {
namespace {

Path wave() {
  return {.times = {0.5, 1.0, 2.0, 2.5}, .points = {{0, 0, 0}, {1, 2, 0}, {2, -1, 1}, {0, 1, 0}}};
}

/// A circle about (3, 1, 0) of 3 m radius, through the origin of x and z, counter-clockwise seen
/// from below: it starts along +z.
Path circle() {
  Path path;
  constexpr int kPieces = 24;
  for (int i = 0; i <= kPieces; ++i) {
    const double phi = 2 * std::numbers::pi * (i % kPieces) / kPieces;
    path.times.push_back(6.0 * i / kPieces);
    path.points.emplace_back(3 - 3 * std::cos(phi), 1, 3 * std::sin(phi));
  }
  path.loop = true;
  return path;
}

TEST(Path, GoesThroughItsPointsToTheLastBit) {
  const PathMotion motion(wave());
  for (std::size_t i = 0; i < wave().times.size(); ++i) {
    EXPECT_EQ(motion.position(wave().times[i]), wave().points[i]) << i;
  }
}

TEST(Path, RestsBeforeItsFirstAndAfterItsLastTime) {
  const PathMotion motion(wave());
  EXPECT_EQ(motion.position(-1.0), wave().points.front());
  EXPECT_EQ(motion.position(9.0), wave().points.back());
  EXPECT_EQ(motion.velocity(0.2), Vector3<double>(0, 0, 0));
  EXPECT_EQ(motion.velocity(9.0), Vector3<double>(0, 0, 0));
  // Rounding of the spline's system, which has numbers of order 10.
  EXPECT_LT(motion.velocity(0.5 + 1e-12).norm(), 1e-9);
}

TEST(Path, VelocityAndAccelerationAreDerivatives) {
  Path path = circle();
  path.ease_in = 1.0;
  for (const PathMotion& motion : {PathMotion(wave()), PathMotion(path)}) {
    const double h = 1e-4;
    for (const double t : {0.3, 0.71, 1.37, 2.2, 5.9, 6.4, 7.1}) {
      const Vector3<double> slope = (motion.position(t + h) - motion.position(t - h)) / (2 * h);
      const Vector3<double> bend = (motion.velocity(t + h) - motion.velocity(t - h)) / (2 * h);
      // Not at 1 s, where the clock stops speeding up. Central differences: h^2 / 6 times the third derivative, at most some 1e2 here; at a knot,
      // where the third derivative jumps, h / 2 times it.
      EXPECT_LT((slope - motion.velocity(t)).norm(), 1e-5) << t;
      EXPECT_LT((bend - motion.acceleration(t)).norm(), 2e-2) << t;
    }
  }
}

TEST(Path, ALoopGoesOnSmoothly) {
  const PathMotion motion(circle());
  EXPECT_LT((motion.position(6.0 + 0.7) - motion.position(0.7)).norm(), 1e-12);
  EXPECT_LT((motion.velocity(6.0 + 1e-9) - motion.velocity(6.0 - 1e-9)).norm(), 1e-6);
  EXPECT_NEAR(motion.velocity(1.1).norm(), std::numbers::pi, 1e-3);  // 3 m radius in 6 s
}

TEST(Path, ALoopCanStartAtRest) {
  Path path = circle();
  path.ease_in = 1.0;
  const PathMotion motion(path);
  EXPECT_EQ(motion.velocity(0.0).norm(), 0.0);
  EXPECT_LT((motion.position(1.0) - PathMotion(circle()).position(0.5)).norm(), 1e-15);
  EXPECT_LT((motion.velocity(1.0) - PathMotion(circle()).velocity(0.5)).norm(), 1e-12);
}

TEST(Path, AHeadingTurnsWithTheDirectionOfTravel) {
  Path path = circle();
  path.follow = PathFollow::kHeading;
  const PathMotion motion(path);
  EXPECT_LT(motion.pose(0.0).orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-12);
  // A quarter of the circle: it goes along +x, from +z; a spline of 24 points is that good.
  const Vector3<double> ahead = motion.pose(1.5).orientation * Vector3<double>(0, 0, 1);
  EXPECT_LT((ahead - Vector3<double>(1, 0, 0)).norm(), 1e-3);
}

TEST(Path, ABankingFrameFeelsItsWeightStraightDown) {
  Path path = circle();
  path.follow = PathFollow::kBanked;
  const PathMotion motion(path);
  for (const double t : {0.4, 1.9, 4.4}) {
    const Vector3<double> up = motion.pose(t).orientation * Vector3<double>(0, 1, 0);
    const Vector3<double> felt = motion.acceleration(t) + Vector3<double>(0, 9.81, 0);
    // The spline's acceleration along its way, which is no matter of banking, is some 1e-3 m/s^2.
    EXPECT_LT((up - felt.normalized()).norm(), 1e-3) << t;
    EXPECT_GT(std::acos(up.y()), 0.3);  // atan(3.29 / 9.81)
  }
}

TEST(Path, TurnsAreAnglesAboutTheAxis) {
  Path path = wave();
  path.turns = {0, 0.5, -1, 2};
  path.turn_axis = {0, 0, 2};
  const PathMotion motion(path);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(path.turns[i], Vector3<double>::UnitZ()));
    EXPECT_LT(motion.pose(path.times[i]).orientation.angularDistance(expected), 1e-7) << i;
  }
}

TEST(Path, RefusesWhatIsNoMotion) {
  const auto refused = [](const auto& change) {
    Path path = wave();
    change(path);
    EXPECT_THROW(PathMotion{path}, InvalidArgument);
  };
  refused([](Path& p) { p.times[2] = p.times[1]; });
  refused([](Path& p) { p.times.pop_back(); });
  refused([](Path& p) { p.points[0].x() = std::nan(""); });
  refused([](Path& p) { p.loop = true; });
  refused([](Path& p) { p.turns = {1.0}; });
  refused([](Path& p) { p.turn_axis.setZero(); });
  refused([](Path& p) { p.ease_in = -1; });
  refused([](Path& p) {
    p.points[1] = p.points[0];
    p.follow = PathFollow::kHeading;
  });
}

}  // namespace
}  // namespace weft::scenes
