#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>

namespace weft::bridge {
namespace {

constexpr double kDampingPlaceEpsilon = std::numeric_limits<btScalar>::epsilon();
constexpr double kDampingPlaceTimeStep = 1.0 / 128;  // [s] exact in single precision
/// Bullet derives velocities from positions of 1 m: an error of eps x / h per step.
constexpr double kVelocityNoise = 2 * kDampingPlaceEpsilon / kDampingPlaceTimeStep;  // [m/s]

forces::LawSpecification damping_law(const std::string& id, const std::string& parameter,
                                     double value) {
  return {id, {}, {{parameter, {value}}}};
}

ClothMesh cloth(int n) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.size = {1.0, 1.0};
  grid.total_mass = 0.2;
  grid.stencil = GridStencil::k12Neighbour;
  return make_cloth_grid(grid);
}

/// A cloth of unequal masses in a world, with laws.
class Scene {
 public:
  Scene(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
        DampingPlace place, const ClothSettings& settings = {})
      : mesh_(mesh), body_(&world_.add(make_cloth_body(world_.info(), mesh, settings))) {
    world_.solver().attach(*body_, mesh, laws, place);
  }

  void step(int num_steps = 1, double time_step = kDampingPlaceTimeStep) {
    for (int i = 0; i < num_steps; ++i) world_.step(time_step);
  }
  [[nodiscard]] btSoftBody& body() { return *body_; }
  [[nodiscard]] SoftBodySolver& solver() { return world_.solver(); }
  [[nodiscard]] Matrix3X<double> positions() const { return read().first; }
  [[nodiscard]] Matrix3X<double> velocities() const { return read().second; }
  void set_velocities(const Matrix3X<double>& v) {
    write_node_velocities(v.cast<btScalar>(), *body_);
  }

  [[nodiscard]] Vector3<double> momentum() const { return velocities() * mesh_.masses; }
  /// About the centre of mass [kg m^2/s].
  [[nodiscard]] Vector3<double> spin_momentum() const {
    const Matrix3X<double> x = positions();
    const Matrix3X<double> v = velocities();
    const Vector3<double> center = x * mesh_.masses / mesh_.masses.sum();
    Vector3<double> sum = Vector3<double>::Zero();
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Vector3<double> r = x.col(i) - center;
      sum += mesh_.masses[i] * r.cross(Vector3<double>(v.col(i)));
    }
    return sum;
  }

 private:
  [[nodiscard]] std::pair<Matrix3X<double>, Matrix3X<double>> read() const {
    Matrix3X<btScalar> x;
    Matrix3X<btScalar> v;
    read_nodes(*body_, x, v);
    return {x.cast<double>(), v.cast<double>()};
  }

  SoftWorld world_{{}};
  ClothMesh mesh_;
  btSoftBody* body_;
};

/// A cloth with the masses of a lopsided body.
ClothMesh lopsided_cloth() {
  ClothMesh mesh = cloth(4);
  for (int i = 0; i < mesh.num_nodes(); ++i) mesh.masses[i] *= 1.0 + 0.2 * i;
  return mesh;
}

/// omega x r + drift, with a shake [m/s].
Matrix3X<double> tumbling(const ClothMesh& mesh) {
  Matrix3X<double> v(3, mesh.num_nodes());
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    v.col(i) = Vector3<double>(0.1, -0.05, 0.02) +
               Vector3<double>(0.9, -0.5, 1.3).cross(Vector3<double>(mesh.rest_positions.col(i)));
    v(i % 3, i) += 0.1;
  }
  return v;
}

/// |L_n - factor L_0| / |L_0| after one second.
double spin_error(DampingPlace place, double factor_per_step) {
  constexpr int kNumSteps = 128;
  const ClothMesh mesh = lopsided_cloth();
  Scene scene(
      mesh,
      {damping_law("tension", "stiffness", 5.0), damping_law("rotation_damping", "rate", 2.0)},
      place);
  scene.set_velocities(tumbling(mesh));
  const Vector3<double> start = scene.spin_momentum();
  scene.step(kNumSteps);
  const Vector3<double> exact = std::pow(factor_per_step, kNumSteps) * start;
  return (scene.spin_momentum() - exact).norm() / start.norm();
}

TEST(DampingPlace, RotationDecaysByTheExactFactorAfterTheProjection) {
  const double factor = std::exp(-2.0 * kDampingPlaceTimeStep);
  const double tolerance = 100 * kVelocityNoise;  // 128 steps of noise of about 1 m/s
  EXPECT_LT(spin_error(DampingPlace::kAutomatic, factor), tolerance);
  EXPECT_LT(spin_error(DampingPlace::kAfterProjection, factor), tolerance);
}

TEST(DampingPlace, RotationDecaysByTheEulerFactorBeforeTheIntegration) {
  const double tolerance = 100 * kVelocityNoise;
  EXPECT_LT(spin_error(DampingPlace::kBeforeIntegration, 1 - 2.0 * kDampingPlaceTimeStep),
            tolerance);
  EXPECT_GT(spin_error(DampingPlace::kBeforeIntegration, std::exp(-2.0 * kDampingPlaceTimeStep)),
            1e-3);
}

TEST(DampingPlace, TranslationFeelsNothing) {
  const ClothMesh mesh = lopsided_cloth();
  for (const char* id : {"rotation_damping", "torsional_rotation_damping"}) {
    for (const DampingPlace place :
         {DampingPlace::kBeforeIntegration, DampingPlace::kAfterProjection}) {
      Scene scene(mesh, {damping_law(id, "rate", 2.0)}, place);
      const Matrix3X<double> v = Vector3<double>(0.5, -0.3, 0.2).replicate(1, mesh.num_nodes());
      scene.set_velocities(v);
      scene.step(64);
      EXPECT_LT((scene.velocities() - v).cwiseAbs().maxCoeff(), 64 * kVelocityNoise) << id;
    }
  }
}

TEST(DampingPlace, TheSpinOfABodyDoesNotFeelTorsionalDamping) {
  const ClothMesh mesh = lopsided_cloth();
  Scene scene(mesh,
              {damping_law("tension", "stiffness", 5.0),
               damping_law("torsional_rotation_damping", "rate", 2.0)},
              DampingPlace::kAutomatic);
  scene.set_velocities(tumbling(mesh));
  const Vector3<double> spin = scene.spin_momentum();
  const Vector3<double> momentum = scene.momentum();
  scene.step(128);
  EXPECT_LT((scene.spin_momentum() - spin).norm(), 100 * kVelocityNoise * spin.norm());
  EXPECT_LT((scene.momentum() - momentum).norm(), 100 * kVelocityNoise * mesh.masses.sum());
}

/// Two nodes with a spring, a metre apart, pulled apart by 0.1 m; the mean phase per step [rad] from
/// d_(n+1) + d_(n-1) = 2 cos(phase) d_n.
double phase_per_step(double beta) {
  ClothMesh mesh;
  mesh.rest_positions = Matrix3X<double>::Zero(3, 2);
  mesh.rest_positions.row(0) << -0.5, 0.5;
  mesh.triangles.resize(3, 0);
  mesh.edge_sets.push_back({"spring", Edges{{0}, {1}}});
  mesh.masses = Eigen::Vector2d(0.1, 0.3);
  Scene scene(mesh,
              {damping_law("tension", "stiffness", 100.0),
               damping_law("acceleration_damping", "beta", beta)},
              DampingPlace::kAutomatic);
  scene.body().m_nodes[1].m_x.setX(btScalar(0.6));
  std::vector<double> d;
  for (int step = 0; step < 300; ++step) {
    const Matrix3X<double> x = scene.positions();
    d.push_back(x(0, 1) - x(0, 0) - 1.0);
    scene.step();
  }
  double sum = 0, squares = 0;
  for (std::size_t n = 1; n + 1 < d.size(); ++n) {
    sum += d[n] * (d[n - 1] + d[n + 1]);
    squares += 2 * d[n] * d[n];
  }
  return std::acos(sum / squares);
}

TEST(DampingPlace, AddedInertiaMakesPeriodsLonger) {
  const double half = 0.5 * kDampingPlaceTimeStep * std::sqrt(100.0 / 0.075);  // of omega h [-]
  // 1000: rounding of positions relative to the elongation, over the square of the phase.
  const double tolerance = 1000 * kDampingPlaceEpsilon;
  for (const double beta : {0.0, 0.5, 1.0, 3.0}) {
    const double exact = 2 * std::asin(half / std::sqrt(1 + beta));
    EXPECT_NEAR(phase_per_step(beta) / exact, 1.0, tolerance) << "beta " << beta;
  }
}

/// Whether a disturbance of the cloth grows in the force-driven world.
bool is_stable(double beta, double time_step) {
  // Above the rounding of positions in single precision, and far below a spring's length.
  constexpr double kDisturbance = 1e-4;  // [m]
  constexpr double kGrown = 1e-2;        // [m]
  const ClothMesh mesh = cloth(6);
  Scene scene(mesh,
              {damping_law("tension", "stiffness", 200.0),
               damping_law("acceleration_damping", "beta", beta)},
              DampingPlace::kAutomatic);
  for (int i = 0; i < mesh.num_nodes(); ++i) {
    scene.body().m_nodes[i].m_x += btVector3(btScalar(kDisturbance * std::sin(7.0 * i + 1)), 0,
                                             btScalar(kDisturbance * std::sin(11.0 * i + 2)));
  }
  for (int step = 0; step < 300; ++step) {
    scene.step(1, time_step);
    const Matrix3X<double> moved = scene.positions() - mesh.rest_positions;
    if (!(moved.cwiseAbs().maxCoeff() < kGrown)) return false;
  }
  return true;
}

double largest_stable_step(double beta) {
  double stable = 1e-4, unstable = 1e-1;  // [s]
  while (unstable > 1.005 * stable) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(beta, middle) ? stable : unstable) = middle;
  }
  return std::sqrt(stable * unstable);
}

TEST(DampingPlace, AddedInertiaMakesTheStableStepLonger) {
  const double plain = largest_stable_step(0.0);
  // Two brackets of 0.5 %; the disturbance must grow 100 times in 300 steps to be seen.
  constexpr double kResolution = 0.015;
  for (const double beta : {0.5, 1.0, 3.0}) {
    EXPECT_NEAR(largest_stable_step(beta) / plain / std::sqrt(1 + beta), 1.0, kResolution)
        << "beta " << beta;
  }
}

TEST(DampingPlace, AClothExplodesWithoutAddedInertiaAndComesToRestWithIt) {
  ClothMesh mesh = cloth(6);
  mesh.pinned = {0, 5};
  const double time_step = largest_stable_step(0.0) * std::pow(4.0, 0.25);  // half way to beta = 3
  const auto hang = [&](double beta, int num_steps) {
    auto scene = std::make_unique<Scene>(
        mesh,
        std::vector<forces::LawSpecification>{damping_law("tension", "stiffness", 200.0),
                                              damping_law("velocity_damping", "rate", 4.0),
                                              damping_law("acceleration_damping", "beta", beta),
                                              {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}},
        DampingPlace::kAutomatic);
    scene->step(num_steps, time_step);
    return scene;
  };
  const int num_steps = static_cast<int>(10.0 / time_step);
  const auto without = hang(0.0, num_steps);
  EXPECT_TRUE(without->solver().blow_up(without->body()).has_value() ||
              !(without->velocities().cwiseAbs().maxCoeff() < 100.0));
  const auto with = hang(3.0, num_steps);
  EXPECT_FALSE(with->solver().blow_up(with->body()).has_value());
  EXPECT_LT(with->velocities().cwiseAbs().maxCoeff(), 1e-3);  // [m/s] what counts as rest
}

TEST(DampingPlace, FreeFallIsTheSameAtEveryPlace) {
  const ClothMesh mesh = lopsided_cloth();
  const auto drop = [&](DampingPlace place, double beta) {
    Scene scene(mesh,
                {{"gravity", {}, {{"acceleration", {0, -9.81, 0}}}},
                 damping_law("acceleration_damping", "beta", beta)},
                place);
    scene.step(64);
    return scene.positions();
  };
  const Matrix3X<double> expected = drop(DampingPlace::kAutomatic, 0.0);
  // eps x / h per step in velocity, twice summed over 64 steps.
  const double tolerance = 64 * 64 * kDampingPlaceEpsilon;
  for (const DampingPlace place :
       {DampingPlace::kBeforeIntegration, DampingPlace::kAfterProjection}) {
    EXPECT_LT((drop(place, 2.0) - expected).cwiseAbs().maxCoeff(), tolerance);
  }
}

ClothSettings with_links() {
  ClothSettings settings;
  settings.links = {{{}, 100.0}};
  settings.time_step = kDampingPlaceTimeStep;
  return settings;
}

TEST(DampingPlace, InertiaAfterTheProjectionDividesTheChangeOfVelocity) {
  constexpr double kBeta = 1.5;
  ClothMesh mesh = lopsided_cloth();
  mesh.pinned = {0};
  const auto step = [&](const std::vector<forces::LawSpecification>& laws) {
    Scene scene(mesh, laws, DampingPlace::kAutomatic, with_links());
    Matrix3X<double> v = tumbling(mesh);
    v.col(0).setZero();
    scene.set_velocities(v);
    scene.step();
    return std::pair{scene.positions(), scene.velocities()};
  };
  const auto [x_plain, v_plain] = step({});
  const auto [x, v] = step({damping_law("acceleration_damping", "beta", kBeta)});
  EXPECT_EQ(x, x_plain);
  Matrix3X<double> start = tumbling(mesh);
  start.col(0).setZero();
  const Matrix3X<double> change = v_plain - start;
  const auto n = mesh.num_nodes() - 1;  // free nodes
  const Vector3<double> mean =
      change.rightCols(n) * mesh.masses.tail(n) / mesh.masses.tail(n).sum();
  ASSERT_GT((change.rightCols(n).colwise() - mean).norm(), 0.1);
  Matrix3X<double> expected = start;
  expected.rightCols(n).colwise() += mean * (1 - 1 / (1 + kBeta));
  expected.rightCols(n) += change.rightCols(n) / (1 + kBeta);
  EXPECT_LT((v - expected).cwiseAbs().maxCoeff(), 16 * kDampingPlaceEpsilon);
}

TEST(DampingPlace, AutomaticIsAfterTheProjectionForABodyWithLinks) {
  const ClothMesh mesh = lopsided_cloth();
  const auto end = [&](DampingPlace place, const ClothSettings& settings) {
    Scene scene(mesh,
                {damping_law("spring_damping", "damping", 0.05),
                 damping_law("acceleration_damping", "beta", 1.0),
                 damping_law("torsional_rotation_damping", "rate", 3.0)},
                place, settings);
    scene.set_velocities(tumbling(mesh));
    scene.step(16);
    return scene.positions();
  };
  const Matrix3X<double> linked = end(DampingPlace::kAutomatic, with_links());
  EXPECT_EQ(linked, end(DampingPlace::kAfterProjection, with_links()));
  EXPECT_NE(linked, end(DampingPlace::kBeforeIntegration, with_links()));
  const Matrix3X<double> free = end(DampingPlace::kAutomatic, {});
  EXPECT_NE(free, end(DampingPlace::kAfterProjection, {}));    // inertia
  EXPECT_NE(free, end(DampingPlace::kBeforeIntegration, {}));  // velocity-level laws
}

}  // namespace
}  // namespace weft::bridge
