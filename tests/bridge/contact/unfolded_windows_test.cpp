// Which parts of a surface are known not to meet themselves in a step.
#include <weft/bridge/contact/unfolded_windows.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/icosphere.hpp>

namespace weft::bridge::unfolded_windows_test {
namespace {

constexpr double kSpacing = 0.02;  // [m]
constexpr double kReach = 0.012;   // [m]

ClothMesh sheet(int across, int along) {
  ClothGrid grid;
  grid.nodes = {across, along};
  grid.size = {kSpacing * (across - 1), kSpacing * (along - 1)};
  grid.total_mass = 0.1;
  return make_cloth_grid(grid);
}

using Place = std::function<btVector3(const btVector3&)>;
const Place kStays = [](const btVector3& x) { return x; };

btVector3 vector(double x, double y, double z) {
  return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
}

/// A surface whose rest shape is that of a mesh, in the plane of x and z if it is a sheet.
class Surface {
 public:
  explicit Surface(const ClothMesh& mesh)
      : body_(world_.add(make_cloth_body(world_.info(), mesh, {}))) {
    for (int i = 0; i < body_.m_nodes.size(); ++i) rest_.push_back(body_.m_nodes[i].m_x);
    windows_.find(body_);
  }
  /// Where a step begins and ends, from places at rest.
  bool is_apart(const Place& start, const Place& end) {
    ways_.clear();
    btVector3 motion(0, 0, 0);
    for (const btVector3& rest : rest_) {
      ways_.push_back({start(rest), end(rest)});
      motion += (end(rest) - start(rest)) / static_cast<btScalar>(rest_.size());
    }
    windows_.refit(ways_, motion, static_cast<btScalar>(kReach));
    return windows_.are_all_apart();
  }
  bool is_apart(const Place& place) { return is_apart(place, place); }
  [[nodiscard]] int num_apart() const {
    int count = 0;
    for (int f = 0; f < body_.m_faces.size(); ++f) count += windows_.is_apart(f) ? 1 : 0;
    return count;
  }
  [[nodiscard]] int num_faces() const { return body_.m_faces.size(); }
  /// The least distance over that at rest, of two nodes of faces that are apart from all, at any time of a step.
  [[nodiscard]] double least_ratio() const {
    std::vector<char> is_apart(rest_.size(), 1);
    for (int f = 0; f < body_.m_faces.size(); ++f) {
      for (const auto* const node : body_.m_faces[f].m_n) {
        if (!windows_.is_apart(f)) is_apart[static_cast<std::size_t>(node - &body_.m_nodes[0])] = 0;
      }
    }
    btScalar least = std::numeric_limits<btScalar>::max();
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (is_apart[i] == 0 && is_apart[j] == 0) continue;
        for (const double share : {0.0, 0.3, 0.6, 1.0}) {
          const auto at = [&](std::size_t k) {
            return ways_[k][0].lerp(ways_[k][1], static_cast<btScalar>(share));
          };
          const btScalar rest = (rest_[i] - rest_[j]).length();
          const btScalar now = (at(i) - at(j)).length();
          if (now < static_cast<btScalar>(kReach)) least = std::min(least, now / rest);
        }
      }
    }
    return static_cast<double>(least);
  }
  UnfoldedWindows& windows() { return windows_; }

 private:
  SoftWorld world_{{.gravity = {0, 0, 0}}};
  btSoftBody& body_;
  UnfoldedWindows windows_;
  std::vector<btVector3> rest_;
  std::vector<std::array<btVector3, 2>> ways_;
};

/// Rolled about an axis along z, by a radius.
Place rolled(double radius) {
  return [=](const btVector3& at) {
    const double angle = static_cast<double>(at.x()) / radius;
    return vector(radius * std::sin(angle), radius * (1 - std::cos(angle)),
                  static_cast<double>(at.z()));
  };
}

/// Bent in its own plane.
Place curled(double radius) {
  return [=](const btVector3& at) {
    const double angle = static_cast<double>(at.x()) / radius;
    const double distance = radius - static_cast<double>(at.z());
    return vector(distance * std::sin(angle), 0, radius - distance * std::cos(angle));
  };
}

/// The right half turned up about a line through the middle.
Place folded(double angle) {
  return [=](const btVector3& at) {
    const double x = static_cast<double>(at.x());
    if (x <= 0) return at;
    return vector(x * std::cos(angle), x * std::sin(angle), static_cast<double>(at.z()));
  };
}

TEST(UnfoldedWindows, AFlatSheetIsApartHoweverItMoves) {
  Surface surface(sheet(41, 33));
  EXPECT_TRUE(surface.is_apart(kStays));
  EXPECT_EQ(surface.num_apart(), surface.num_faces());
  const Place turned = [](const btVector3& at) {
    return at.rotate(btVector3(0, 0, 1), btScalar(0.2)) + btVector3(5, -3, 1);
  };
  EXPECT_TRUE(surface.is_apart(kStays, turned));
}

TEST(UnfoldedWindows, ASheetIsApartOverAWideBend) {
  Surface surface(sheet(41, 33));
  EXPECT_TRUE(surface.is_apart(rolled(0.5)));  // a window turns by 36 degrees
  EXPECT_TRUE(surface.is_apart(folded(0.6)));
}

TEST(UnfoldedWindows, ASharpFoldIsLookedAtAndNothingElse) {
  Surface surface(sheet(61, 33));
  EXPECT_FALSE(surface.is_apart(folded(2.0)));
  EXPECT_GT(surface.num_apart(), surface.num_faces() / 3);
  EXPECT_LT(surface.num_apart(), surface.num_faces());
}

TEST(UnfoldedWindows, LayersThatMeetAreLookedAt) {
  Surface surface(sheet(61, 33));
  // Both ends of a roll of 1.2 m come together where its circumference is that.
  const double radius = kSpacing * 60 / (2 * std::numbers::pi);
  EXPECT_FALSE(surface.is_apart(rolled(radius)));
  EXPECT_GT(surface.num_apart(), 0);
  EXPECT_TRUE(surface.is_apart(rolled(1.1 * radius)));
}

TEST(UnfoldedWindows, AStripThatCurlsUpInItsPlaneIsLookedAt) {
  Surface surface(sheet(101, 4));
  const double radius = kSpacing * 100 / (2 * std::numbers::pi);
  EXPECT_TRUE(surface.is_apart(curled(1.5 * radius)));
  EXPECT_FALSE(surface.is_apart(curled(radius)));
}

TEST(UnfoldedWindows, AStepThatPassesThroughItselfIsLookedAt) {
  Surface surface(sheet(61, 33));
  // It is flat at its start and its end, and turned inside out between them.
  const Place mirrored = [](const btVector3& at) { return btVector3(-at.x(), at.y(), at.z()); };
  EXPECT_FALSE(surface.is_apart(kStays, mirrored));
  EXPECT_EQ(surface.num_apart(), 0);
}

TEST(UnfoldedWindows, CompressionInItsPlaneCounts) {
  Surface surface(sheet(41, 33));
  const auto pressed = [](double share) -> Place {
    return [=](const btVector3& at) {
      return vector(share * static_cast<double>(at.x()), 0, static_cast<double>(at.z()));
    };
  };
  EXPECT_TRUE(surface.is_apart(pressed(0.75)));
  EXPECT_FALSE(surface.is_apart(pressed(0.65)));
}

TEST(UnfoldedWindows, ASheetWithASlitHasNoWindowThere) {
  // Two legs, whose ends come together in their plane: all normals are the same.
  ClothMesh mesh = sheet(41, 41);
  std::vector<int> kept;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    double x = 0;
    double z = 0;
    for (int k = 0; k < 3; ++k) {
      x += mesh.rest_positions(0, mesh.triangles(k, t)) / 3;
      z += mesh.rest_positions(2, mesh.triangles(k, t)) / 3;
    }
    if (std::abs(x) > 2 * kSpacing || z < 0) kept.push_back(static_cast<int>(t));
  }
  const Triangles whole = mesh.triangles;
  mesh.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t t = 0; t < kept.size(); ++t)
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = whole.col(kept[t]);
  ASSERT_LT(mesh.triangles.cols(), whole.cols());
  Surface surface(mesh);
  const Place closes = [](const btVector3& at) {
    const double z = static_cast<double>(at.z());
    const double x = static_cast<double>(at.x());
    const double by = z > 0 ? 0.1 * z : 0.0;
    return vector(x > 0 ? x - by : x + by, 0, z);
  };
  EXPECT_FALSE(surface.is_apart(kStays));
  EXPECT_GT(surface.num_apart(), 0);
  EXPECT_FALSE(surface.is_apart(closes));
}

/// Two meshes that share no nodes.
ClothMesh beside(ClothMesh mesh, const ClothMesh& other, double way) {
  const auto n = mesh.rest_positions.cols();
  const auto t = mesh.triangles.cols();
  mesh.rest_positions.conservativeResize(3, n + other.rest_positions.cols());
  mesh.rest_positions.rightCols(other.rest_positions.cols()) = other.rest_positions;
  mesh.rest_positions.row(0).tail(other.rest_positions.cols()).array() += way;
  mesh.triangles.conservativeResize(3, t + other.triangles.cols());
  mesh.triangles.rightCols(other.triangles.cols()) = other.triangles.array() + static_cast<int>(n);
  mesh.masses.setConstant(mesh.rest_positions.cols(), 1e-4);
  mesh.edge_sets.clear();
  mesh.texture_coordinates = {};
  return mesh;
}

TEST(UnfoldedWindows, PiecesThatTouchButAreNotJoinedAreLookedAt) {
  constexpr int kNodes = 21;
  Surface surface(beside(sheet(kNodes, kNodes), sheet(kNodes, kNodes), kSpacing * (kNodes - 1)));
  // The left one is lifted, moved over the right one and dropped.
  const double edge = kSpacing * (kNodes - 1) / 2;
  const auto over = [=](double height) -> Place {
    return [=](const btVector3& at) {
      const double x = static_cast<double>(at.x());
      const bool is_left = x < edge - 1e-4;
      return is_left ? at + vector(0.05, height, 0) : at;
    };
  };
  EXPECT_FALSE(surface.is_apart(over(0.01), over(-0.01)));
}

TEST(UnfoldedWindows, FacesFarFromEachOtherGetFewBlocks) {
  ClothMesh mesh = sheet(2, 2);
  for (const double way : {1.0, 1e3, 1e3, 1e6}) mesh = beside(mesh, sheet(2, 2), way);
  Surface surface(mesh);
  EXPECT_FALSE(surface.is_apart(kStays));
}

TEST(UnfoldedWindows, AClosedSurfaceHasNone) {
  Surface surface(make_icosphere({.radius = 0.3, .frequency = 12}));
  EXPECT_FALSE(surface.is_apart(kStays));
  EXPECT_EQ(surface.num_apart(), 0);
}

TEST(UnfoldedWindows, NothingIsApartOfASurfaceThatIsForgottenOrHasExploded) {
  Surface surface(sheet(41, 33));
  const Place explodes = [](const btVector3& at) {
    return at.x() > 0 ? btVector3(std::numeric_limits<btScalar>::quiet_NaN(), 0, 0) : at;
  };
  EXPECT_FALSE(surface.is_apart(kStays, explodes));
  EXPECT_TRUE(surface.is_apart(kStays));
  surface.windows().forget();
  EXPECT_FALSE(surface.is_apart(kStays));
  EXPECT_EQ(surface.num_apart(), 0);
}

// Waves of random amplitudes and lengths: some are flat, some have folds and layers in each other.
TEST(UnfoldedWindows, WhatIsApartKeepsItsDistance) {
  Surface surface(sheet(33, 29));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  int num_apart = 0;
  int num_looked_at = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::array<double, 12> c{};
    for (double& number : c) number = share(random);
    const double amplitude = 0.15 * c[0] * c[0];
    const auto wave = [=](double more) -> Place {
      return [=](const btVector3& at) {
        const double x = static_cast<double>(at.x());
        const double z = static_cast<double>(at.z());
        const double a = 6 + 25 * c[1];
        const double b = 6 + 25 * c[2];
        const double up =
            amplitude * more * std::sin(a * x + 6 * c[3]) * std::sin(b * z + 6 * c[4]);
        const double along = amplitude * more * std::sin(b * x + 6 * c[5] + up * 10);
        const double across = amplitude * more * std::sin(a * z + 6 * c[6]);
        return vector(x + c[7] * along, up, z + c[8] * across);
      };
    };
    const bool is_apart = surface.is_apart(wave(1), wave(1 + c[9]));
    num_apart += is_apart ? 1 : 0;
    num_looked_at += is_apart ? 0 : 1;
    // Places that are apart come nearer than the reach only if they are near each other at rest.
    EXPECT_GT(surface.least_ratio(), 0.99 * static_cast<double>(UnfoldedWindows::kLeast)) << trial;
  }
  EXPECT_GT(num_apart, 5);
  EXPECT_GT(num_looked_at, 5);
}

}  // namespace
}  // namespace weft::bridge::unfolded_windows_test
