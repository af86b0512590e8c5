#include <cmath>
#include <cstdlib>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <weft/core/error.hpp>
#include <weft/fast_solver/implicit_solver.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::fast {
namespace {

constexpr double kTimeStep = 1.0 / 60;  // [s]
constexpr double kGravity = 9.81;       // [m/s^2]

ClothMesh solver_cloth(int n) {
  ClothGrid grid;
  grid.nodes = {n, n};
  grid.total_mass = 0.25;
  return make_cloth_grid(grid);
}

SpringNetwork springs(const ClothMesh& mesh, double stiffness, double damping = 0.0) {
  return make_network(mesh, {{"tension", {}, {{"stiffness", {stiffness}}}},
                             {"spring_damping", {}, {{"damping", {damping}}}}});
}

std::vector<bool> all_free_but(const ClothMesh& mesh, const std::vector<int>& pinned) {
  std::vector<bool> is_free(static_cast<std::size_t>(mesh.num_nodes()), true);
  for (const int node : pinned) is_free[static_cast<std::size_t>(node)] = false;
  return is_free;
}

/// In a vertical plane, its first row on top.
ClothMesh hanging_cloth() {
  ClothGrid grid;
  grid.nodes = {60, 60};
  grid.v_axis = {0, -1, 0};
  grid.total_mass = 0.25;
  return make_cloth_grid(grid);
}

/// Where free nodes fall to in one step.
Matrix3X<double> fallen(const Matrix3X<double>& x, const Matrix3X<double>& v,
                        const std::vector<bool>& is_free) {
  Matrix3X<double> y = x + kTimeStep * v;
  for (Eigen::Index i = 0; i < y.cols(); ++i) {
    if (is_free[static_cast<std::size_t>(i)]) y(1, i) -= kGravity * kTimeStep * kTimeStep;
  }
  return y;
}

/// Newton's method with a dense matrix of differences, to rounding: shares no formula with the solver
/// but the force.
Matrix3X<double> dense_solution(const SpringNetwork& network, const VectorX<double>& masses,
                                const std::vector<bool>& is_free, const Matrix3X<double>& q,
                                const Matrix3X<double>& y) {
  const Eigen::Index n = q.cols();
  Matrix3X<double> x = q;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!is_free[static_cast<std::size_t>(i)]) x.col(i) = y.col(i);
  }
  const auto residual = [&](const Matrix3X<double>& at) {
    Matrix3X<double> r = (y - at) * (masses / (kTimeStep * kTimeStep)).asDiagonal();
    for (Eigen::Index e = 0; e < network.edges.cols(); ++e) {
      const int i = network.edges(0, e);
      const int j = network.edges(1, e);
      const Vector3<double> d = at.col(j) - at.col(i);
      const double start = (q.col(j) - q.col(i)).norm();
      const double force = network.stiffness[e] * (d.norm() - network.rest_lengths[e]) +
                           network.damping[e] * (d.norm() - start) / kTimeStep;
      r.col(i) += force * d.normalized();
      r.col(j) -= force * d.normalized();
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_free[static_cast<std::size_t>(i)]) r.col(i).setZero();
    }
    return r;
  };
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Matrix3X<double> r = residual(x);
    if (r.norm() < 1e-10) break;
    Eigen::MatrixXd jacobian(3 * n, 3 * n);
    for (Eigen::Index c = 0; c < 3 * n; ++c) {
      Matrix3X<double> there = x;
      there.data()[c] += 1e-6;
      Matrix3X<double> back = x;
      back.data()[c] -= 1e-6;
      jacobian.col(c) = ((residual(there) - residual(back)) / 2e-6).reshaped();
      if (!is_free[static_cast<std::size_t>(c / 3)]) jacobian(c, c) = -1;
    }
    const Eigen::VectorXd step = jacobian.partialPivLu().solve(r.reshaped());
    x.reshaped() -= step;
  }
  return x;
}

TEST(ImplicitSolver, SolvesTheEquationsThatADenseNewtonMethodSolves) {
  const ClothMesh mesh = solver_cloth(4);
  const SpringNetwork network = springs(mesh, 200.0, 0.1);
  const auto is_free = all_free_but(mesh, {0, 3});
  const Matrix3X<double> q = mesh.rest_positions;
  Matrix3X<double> v = Matrix3X<double>::Zero(3, mesh.num_nodes());
  v.row(2).setConstant(1.5);
  v.row(0) = 0.7 * q.row(1) + 2.0 * q.row(2);
  const Matrix3X<double> y = fallen(q, v, is_free);
  const Matrix3X<double> expected = dense_solution(network, mesh.masses, is_free, q, y);
  ImplicitSolver<double> solver(network, mesh.masses, is_free);
  Matrix3X<double> x = q + kTimeStep * v;
  solver.solve({y, q, kTimeStep, kTimeStep}, {20, 20, 0.0}, x);
  const double moved = (expected - q).norm();
  EXPECT_GT(moved, 0.05);
  // The positions are in double precision, whatever the corrections are in.
  EXPECT_LT((x - expected).norm(), 1e-9 * moved);
}

TEST(ImplicitSolver, FewIterationsComeClose) {
  ClothGrid grid;
  grid.nodes = {30, 30};
  grid.v_axis = {0, -1, 0};  // hangs from its first row's corners
  const ClothMesh mesh = make_cloth_grid(grid);
  const auto is_free = all_free_but(mesh, {0, 29});
  const SpringNetwork network = springs(mesh, 1000.0);
  const Matrix3X<double> q = mesh.rest_positions;
  const Matrix3X<double> v = Matrix3X<double>::Zero(3, mesh.num_nodes());
  const Matrix3X<double> y = fallen(q, v, is_free);
  ImplicitSolver<double> solver(network, mesh.masses, is_free);
  const auto solve = [&](const SolverSettings& solver_settings) {
    Matrix3X<double> x = q;
    solver.solve({y, q, kTimeStep, kTimeStep}, solver_settings, x);
    return x;
  };
  const Matrix3X<double> exact = solve({20, 30});
  const double moved = (exact - y).norm();
  EXPECT_GT(moved, 0.04);  // [m] over all nodes
  // Conjugate gradients with a condition number of 10 take the error to 2 (1 / 1.9)^k: 0.3 after three.
  EXPECT_LT((solve({1, 3}) - exact).norm(), 0.3 * moved);
  EXPECT_LT((solve({2, 6}) - exact).norm(), 0.05 * moved);
}

// One linear system, whose error each iteration makes smaller: also where more corrections are made than are kept.
TEST(ImplicitSolver, EachIterationComesCloser) {
  const ClothMesh mesh = hanging_cloth();
  const SpringNetwork network = springs(mesh, 3000.0);
  const auto is_free = all_free_but(mesh, {0, 59});
  const Matrix3X<double> q = mesh.rest_positions;
  const Matrix3X<double> y = fallen(q, Matrix3X<double>::Zero(3, q.cols()), is_free);
  ImplicitSolver<double> solver(network, mesh.masses, is_free);
  const auto solved = [&](int newton_iterations, int linear_iterations) {
    Matrix3X<double> x = q;
    solver.solve({y, q, kTimeStep, kTimeStep}, {newton_iterations, linear_iterations}, x);
    return x;
  };
  const Matrix3X<double> expected = solved(1, 60);
  const double first = (q - expected).norm();
  double last = first;
  for (int iterations = 1; iterations <= 2 * DirectionWeights::kMost; ++iterations) {
    const double error = (solved(1, iterations) - expected).norm();
    // Energy falls in each, positions mostly.
    EXPECT_LT(error, 1.2 * last + 2e-3 * first) << iterations << " iterations";
    if (iterations == DirectionWeights::kMost) {
      EXPECT_GT(error, 5e-3 * first);
    }
    last = error;
  }
  EXPECT_LT(last, 2e-3 * first);
}

// Pins may come and go between steps, and nodes be kinematic for a while: as a solver that was made with pins, to the bit.
TEST(ImplicitSolver, FollowsPins) {
  const ClothMesh mesh = hanging_cloth();
  const SpringNetwork network = springs(mesh, 3000.0);
  const Matrix3X<double> q = mesh.rest_positions;
  const std::vector<bool> none(static_cast<std::size_t>(mesh.num_nodes()), false);
  ImplicitSolver<double> solver(network, mesh.masses, none);
  ImplicitSolver<double> leader(network, mesh.masses, all_free_but(mesh, {}));
  for (const std::vector<int>& pins :
       {std::vector<int>{}, {0, 59}, {0, 59, 1830}, {0}, {3599, 0}}) {
    const auto is_free = all_free_but(mesh, pins);
    const Matrix3X<double> y = fallen(q, Matrix3X<double>::Zero(3, q.cols()), is_free);
    ImplicitSolver<double> fresh(network, mesh.masses, is_free);
    const auto solved = [&](ImplicitSolver<double>& by, const SolverSettings& solver_settings) {
      Matrix3X<double> x = q;
      by.solve({y, q, kTimeStep, kTimeStep}, solver_settings, x);
      return x;
    };
    solver.set_free(is_free);
    const Matrix3X<double> expected = solved(fresh, {8, 60});
    const double first = (q - expected).norm();
    EXPECT_EQ(solved(solver, {8, 60}), expected) << pins.size();
    EXPECT_EQ(solved(solver, {2, 8}), solved(fresh, {2, 8})) << pins.size();
    const auto solved_by_leader = [&](const SolverSettings& solver_settings) {
      std::vector<KinematicNode<double>> kinematic;
      for (const int pin : pins) kinematic.push_back({pin, y.col(pin)});
      Matrix3X<double> x = q;
      leader.solve({.inertial_positions = y,
                    .start_positions = q,
                    .time_step = kTimeStep,
                    .inertia_step = kTimeStep,
                    .kinematic = kinematic},
                   solver_settings, x);
      return x;
    };
    EXPECT_LT((solved_by_leader({8, 60}) - expected).norm(), 1e-3 * first) << pins.size();
    const Matrix3X<double> of_round = solved(fresh, {1, 60});  // iterations mean the same there
    const double left = (solved(fresh, {1, 8}) - of_round).norm();
    const double left_by_leader = (solved_by_leader({1, 8}) - of_round).norm();
    EXPECT_LT(left_by_leader, left + 1e-3 * first) << pins.size();
  }
  EXPECT_THROW(solver.set_free({true}), InvalidArgument);
}

// Random pins and kinematic nodes come and go, with a step after each change: the bits are those of a solver that knows only the
// last of them.
template <class Scalar>
void expect_bits_of_a_fresh_solver() {
  const ClothMesh mesh = solver_cloth(40);
  const SpringNetwork network = springs(mesh, 3000.0, 0.1);
  const Matrix3X<Scalar> q = mesh.rest_positions.template cast<Scalar>();
  std::mt19937 random(7);
  std::uniform_int_distribution<int> node(0, mesh.num_nodes() - 1);
  std::uniform_int_distribution<int> number(0, 12);
  const auto solved = [&](ImplicitSolver<Scalar>& by, const std::vector<bool>& is_free,
                          const std::vector<KinematicNode<Scalar>>& kinematic) {
    const Matrix3X<Scalar> y =
        fallen(mesh.rest_positions, Matrix3X<double>::Zero(3, q.cols()), is_free)
            .template cast<Scalar>();
    Matrix3X<Scalar> x = q;
    by.solve({.inertial_positions = y,
              .start_positions = q,
              .time_step = Scalar(kTimeStep),
              .inertia_step = Scalar(kTimeStep),
              .kinematic = kinematic},
             {}, x);
    return x;
  };
  ImplicitSolver<Scalar> used(network, mesh.masses, all_free_but(mesh, {}));
  for (int change = 0; change < 15; ++change) {
    std::vector<int> pins(static_cast<std::size_t>(number(random)));
    for (int& pin : pins) pin = node(random);
    const std::vector<bool> is_free = all_free_but(mesh, pins);
    std::vector<KinematicNode<Scalar>> kinematic;
    for (int k = number(random); k > 0; --k) {
      const int led = node(random);
      if (!is_free[static_cast<std::size_t>(led)]) continue;
      kinematic.push_back({led, q.col(led) + Vector3<Scalar>(0, 0, Scalar(1e-3))});
    }
    used.set_free(is_free);
    ImplicitSolver<Scalar> fresh(network, mesh.masses, is_free);
    ASSERT_EQ(solved(used, is_free, kinematic), solved(fresh, is_free, kinematic)) << change;
  }
}

TEST(ImplicitSolver, ForgetsWhatWasPinnedBefore) {
  expect_bits_of_a_fresh_solver<float>();
  expect_bits_of_a_fresh_solver<double>();
}

// By the recursion itself, with directions that are numbers.
TEST(DirectionWeights, AreThoseOfTheRecursion) {
  const std::array<float, 4> corrections{3.0F, -1.0F, 0.5F, 2.0F};
  const std::array<float, 4> shares{0.25F, -0.5F, 0.75F, 0.125F};
  const std::array<float, 4> lengths{0.5F, 0.75F, 1.5F, -0.25F};
  const float before = 5.0F;
  DirectionWeights weights;
  float direction = before;
  float step = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_FALSE(weights.is_full());
    weights.add(shares[k], lengths[k]);
    direction = corrections[k] - shares[k] * direction;
    step += lengths[k] * direction;
    const auto sum = [&](const DirectionWeights::Weights& of) {
      float total = of[k + 1] * before;
      for (std::size_t j = 0; j <= k; ++j) total += of[j] * corrections[j];
      return total;
    };
    EXPECT_FLOAT_EQ(sum(weights.of_last_direction()), direction);
    EXPECT_FLOAT_EQ(sum(weights.of_step()), step);
  }
  EXPECT_TRUE(weights.is_full());
}

TEST(ImplicitSolver, ThreadsChangeNoBit) {
  const ClothMesh mesh = solver_cloth(100);  // sixteen parts
  const auto is_free = all_free_but(mesh, {0, 99});
  const Matrix3X<float> q = mesh.rest_positions.cast<float>();
  const Matrix3X<float> y =
      fallen(mesh.rest_positions, Matrix3X<double>::Zero(3, mesh.num_nodes()), is_free)
          .cast<float>();
  const auto solve = [&](int num_threads) {
    WorkerTeam team;
    const WorkerTeam::Scope scope(team, num_threads);
    ImplicitSolver<float> solver(springs(mesh, 500.0), mesh.masses, is_free);
    Matrix3X<float> x = q;
    const auto h = static_cast<float>(kTimeStep);
    solver.solve({y, q, h, h}, {2, 3}, x, team);
    return x;
  };
  const Matrix3X<float> expected = solve(1);
  for (const int num_threads : {2, 3, 4}) EXPECT_EQ(solve(num_threads), expected) << num_threads;
}

/// One node of 1 kg without springs on a plane.
class OnAPlane : public testing::Test {
 protected:
  OnAPlane() : solver_(network_, VectorX<double>::Ones(1), {true}) { network_.edges.resize(2, 0); }

  /// The node's place after a step from the origin, which is on the plane.
  Vector3<double> step(const Vector3<double>& velocity, const Vector3<double>& force,
                       double friction, const Vector3<double>& motion = Vector3<double>::Zero(),
                       double squeeze = 0, double squeeze_friction = 0) {
    const Matrix3X<double> q = Matrix3X<double>::Zero(3, 1);
    const Matrix3X<double> y = kTimeStep * velocity + kTimeStep * kTimeStep * force;
    PlaneContact<double> contact;
    contact.normal = {0, 1, 0};
    contact.friction = friction;
    contact.motion = motion;
    contact.squeeze = squeeze;
    contact.squeeze_friction = squeeze_friction;
    const std::vector<PlaneContact<double>> contacts = {contact};
    Matrix3X<double> x = kTimeStep * velocity;
    solver_.solve({y, q, kTimeStep, kTimeStep, contacts}, {12, 4}, x);
    return x;
  }

  SpringNetwork network_;
  ImplicitSolver<double> solver_;
};

TEST_F(OnAPlane, StaysWhereFrictionHolds) {
  EXPECT_EQ(step({0, 0, 0}, {4.9, -10, 0}, 0.5), Vector3<double>(0, 0, 0));
  EXPECT_NEAR(solver_.constraint_force(0)[0], -4.9, 1e-12);
  EXPECT_NEAR(solver_.constraint_force(0)[1], 10.0, 1e-12);
}

TEST_F(OnAPlane, SlidesWithWhatCoulombLeaves) {
  const Vector3<double> x = step({0, 0, 0}, {6.0, -10, 0}, 0.5);
  // (6 - 0.5 * 10) N on 1 kg over one implicit step; corrections are in single precision.
  EXPECT_NEAR(x[0], 1.0 * kTimeStep * kTimeStep, 1e-8);
  EXPECT_NEAR(x[1], 0.0, 1e-9);
}

// The plane bears the squeeze and what the node pushes with, the surface that squeezes it only the squeeze; a node that pulls
// harder than that bears on this surface alone.
TEST_F(OnAPlane, SlidesBetweenTwoSurfacesByTheFrictionOfBoth) {
  for (const auto& [push, bound] : {std::pair{10.0, 0.5 * 13 + 0.3 * 3},
                                    {0.0, 0.5 * 3 + 0.3 * 3},
                                    {-2.0, 0.5 * 1 + 0.3 * 3},
                                    {-7.0, 0.3 * 7}}) {
    const Vector3<double> x = step({0, 0, 0}, {12, -push, 0}, 0.5, {0, 0, 0}, 3, 0.3);
    // Corrections are in single precision.
    EXPECT_NEAR(x[0] / (kTimeStep * kTimeStep), 12 - bound, 1e-3) << push;
    EXPECT_NEAR(x[1], 0.0, 1e-9) << push;
  }
}

TEST_F(OnAPlane, SlowsDownAsCoulombSays) {
  const Vector3<double> x = step({2, 0, 0}, {0, -10, 0}, 0.3);
  EXPECT_NEAR(x[0] / kTimeStep, 2 - 3 * kTimeStep, 1e-6);
  const Vector3<double> stopped = step({0.02, 0, 0}, {0, -10, 0}, 0.3);
  EXPECT_NEAR(stopped[0], 0.0, 1e-12);
}

TEST_F(OnAPlane, IsCarriedByASurfaceThatMoves) {
  const Vector3<double> motion(0.01, 0, 0);
  EXPECT_NEAR(step({0.6, 0, 0}, {0, -10, 0}, 0.5, motion)[0], 0.01, 1e-9);
}

TEST_F(OnAPlane, LeavesWithoutBeingHeld) {
  const Vector3<double> x = step({0, 0, 0}, {0, 3, 0}, 0.5);
  EXPECT_NEAR(x[1], 3 * kTimeStep * kTimeStep, 1e-12);
  EXPECT_EQ(solver_.constraint_force(0).norm(), 0.0);
}

TEST_F(OnAPlane, IsStoppedAtAnySpeed) {
  const Vector3<double> x = step({0, -20, 0}, {0, -10, 0}, 0.0);
  EXPECT_NEAR(x[1], 0.0, 1e-8);
  EXPECT_NEAR(solver_.constraint_force(0)[1], 20 / kTimeStep + 10, 1e-4);
}

TEST(ImplicitSolver, LeadsANodeAndSaysWhatThatTakes) {
  const ClothMesh mesh = solver_cloth(3);
  const SpringNetwork network = springs(mesh, 100.0);
  ImplicitSolver<double> solver(network, mesh.masses, all_free_but(mesh, {}));
  const Matrix3X<double> q = mesh.rest_positions;
  std::vector<KinematicNode<double>> kinematic(1);
  kinematic[0].node = 4;
  kinematic[0].position = q.col(4) + Vector3<double>(0, 0.01, 0);
  Matrix3X<double> x = q;
  solver.solve({q, q, kTimeStep, kTimeStep, {}, kinematic}, {10, 10}, x);
  EXPECT_EQ(x.col(4), kinematic[0].position);
  // Nothing else pushes: the force has given all the momentum there is.
  const Vector3<double> momentum = (x - q) * mesh.masses / kTimeStep;
  EXPECT_GT(momentum[1], 1e-3);
  EXPECT_LT((momentum - kTimeStep * solver.constraint_force(4)).norm(), 1e-6 * momentum.norm());
}

/// Holds four nodes at a time by c^2 / 2 with c = s |x0 - x1 + x2 - x3 - r|^2 / 2: without stiffness at rest, and stiff where they have left it.
class StiffeningForces : public StepForces<double> {
 public:
  StiffeningForces(ElementStiffness::Elements elements, const Matrix3X<double>& rest, bool knows)
      : elements_(std::move(elements)), rest_(rest), knows_stiffness_(knows) {
    stiffness_.set_elements(elements_, static_cast<int>(rest.cols()));
  }
  void add_forces(ConstMatrix3XRef<double> positions, Matrix3XRef<double> forces) const override {
    for (Eigen::Index e = 0; e < elements_.cols(); ++e) {
      const Vector3<double> left = left_of(e, positions);
      for (int corner = 0; corner < 4; ++corner) {
        forces.col(elements_(corner, e)) -=
            kSigns[corner] * kScale * kScale / 2 * left.squaredNorm() * left;
      }
    }
  }
  [[nodiscard]] double energy(ConstMatrix3XRef<double> positions) const override {
    double sum = 0;
    for (Eigen::Index e = 0; e < elements_.cols(); ++e) {
      sum += std::pow(kScale / 2 * left_of(e, positions).squaredNorm(), 2) / 2;
    }
    return sum;
  }
  [[nodiscard]] bool has_stiffness() const override { return knows_stiffness_; }
  [[nodiscard]] ElementStiffness* stiffness(ConstMatrix3XRef<double> positions) const override {
    for (Eigen::Index e = 0; e < elements_.cols(); ++e) {
      const Vector3<double> gradient = kScale * left_of(e, positions);
      for (int corner = 0; corner < 4; ++corner) {
        stiffness_.gradients().col(e).segment<3>(3 * corner) =
            (kSigns[corner] * gradient).cast<float>();
      }
    }
    return &stiffness_;
  }

 private:
  static constexpr double kScale = 1000;  // [sqrt(N/m)/m]
  static constexpr int kSigns[] = {1, -1, 1, -1};
  [[nodiscard]] Vector3<double> left_of(Eigen::Index e, ConstMatrix3XRef<double> positions) const {
    Vector3<double> left = Vector3<double>::Zero();
    for (int corner = 0; corner < 4; ++corner) {
      const int node = elements_(corner, e);
      left += kSigns[corner] * (positions.col(node) - rest_.col(node));
    }
    return left;
  }
  ElementStiffness::Elements elements_;
  Matrix3X<double> rest_;
  bool knows_stiffness_;
  mutable ElementStiffness stiffness_;
};

// As bending of triangles that are squeezed is: many times as stiff as the matrix that the network has for it.
TEST(ImplicitSolver, FollowsTheStiffnessOfForcesThatStiffen) {
  const ClothMesh mesh = solver_cloth(16);
  const auto is_free = all_free_but(mesh, {0, 15});
  const Matrix3X<double> q = mesh.rest_positions;
  ElementStiffness::Elements elements(4, 60);
  for (int e = 0; e < 60; ++e) elements.col(e) << 4 * e, 4 * e + 1, 4 * e + 2, 4 * e + 3;
  std::srand(1);
  Matrix3X<double> v = Matrix3X<double>::Random(3, q.cols());
  for (const int pin : {0, 15}) v.col(pin).setZero();
  const Matrix3X<double> y = fallen(q, v, is_free);
  ImplicitSolver<double> solver(springs(mesh, 200.0), mesh.masses, is_free);
  const auto report = [&](bool knows_stiffness) {
    const StiffeningForces forces(elements, q, knows_stiffness);
    Matrix3X<double> x = q + kTimeStep * v;
    solver.solve({.inertial_positions = y,
                  .start_positions = q,
                  .time_step = kTimeStep,
                  .inertia_step = kTimeStep,
                  .forces = &forces},
                 {}, x);
    return solver.report();
  };
  EXPECT_TRUE(report(true).is_converged);
  EXPECT_FALSE(report(false).is_converged);
}

}  // namespace
}  // namespace weft::fast
