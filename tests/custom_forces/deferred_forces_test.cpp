#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/custom_forces/deferred_forces.hpp>

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::forces {
namespace {

template <class Scalar>
LawSet<Scalar> some_laws(const ClothMesh& mesh) {
  LawSet<Scalar> laws;
  laws.add(make_law<Scalar>({"tension", {}, {{"stiffness", {100.0}}}}, mesh));
  laws.add(make_law<Scalar>({"spring_damping", {}, {{"damping", {0.5}}}}, mesh));
  laws.add(make_law<Scalar>({"velocity_damping", {}, {{"rate", {0.5}}}}, mesh));
  return laws;
}

/// A cloth in motion, and its forces with and without waiting.
template <class Scalar>
class Cloth {
 public:
  Cloth() {
    positions *= Scalar(1.01);
    for (Eigen::Index i = 0; i < positions.cols(); ++i) {
      velocities.col(i) << Scalar(0.1) * static_cast<Scalar>(i % 7), 1, -2;
    }
  }

  [[nodiscard]] State<Scalar> state() const { return {positions, velocities, masses}; }
  [[nodiscard]] Matrix3X<Scalar> direct() {
    LawSet<Scalar> laws = some_laws<Scalar>(mesh);
    Matrix3X<Scalar> result = Matrix3X<Scalar>::Zero(3, mesh.num_nodes());
    EXPECT_TRUE(laws.add_forces(state(), kLevel, result).ok());
    return result;
  }
  [[nodiscard]] Matrix3X<Scalar> finished() {
    Matrix3X<Scalar> result;
    EXPECT_TRUE(deferred.finish(state(), result).ok());
    return result;
  }

  static constexpr auto kLevel = LawSet<Scalar>::VelocityLaws::kAsForces;
  ClothMesh mesh = make_cloth_grid({.nodes = {40, 40}});
  Matrix3X<Scalar> positions = mesh.rest_positions.cast<Scalar>();
  Matrix3X<Scalar> velocities = Matrix3X<Scalar>::Zero(3, mesh.num_nodes());
  VectorX<Scalar> masses = mesh.masses.cast<Scalar>();
  LawSet<Scalar> laws = some_laws<Scalar>(mesh);
  DeferredForces<Scalar> deferred{laws, kLevel};
};

template <class Scalar>
bool same_bits(const Matrix3X<Scalar>& a, const Matrix3X<Scalar>& b) {
  return a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(Scalar)) == 0;
}

template <class Scalar>
class DeferredForcesTest : public testing::Test {
 protected:
  Cloth<Scalar> cloth_;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(DeferredForcesTest, Scalars);

TYPED_TEST(DeferredForcesTest, AreTheForcesOfTheLawsBitForBit) {
  for (int step = 0; step < 100; ++step) {
    this->cloth_.positions(step % 3, step) += TypeParam(0.001);
    this->cloth_.deferred.begin(this->cloth_.state());
    EXPECT_TRUE(this->cloth_.deferred.is_in_flight());
    ASSERT_TRUE(same_bits(this->cloth_.finished(), this->cloth_.direct())) << "step " << step;
    EXPECT_FALSE(this->cloth_.deferred.is_in_flight());
  }
  EXPECT_EQ(this->cloth_.deferred.num_recomputed(), 0);
}

TYPED_TEST(DeferredForcesTest, DoNotDependOnThreads) {
  const Matrix3X<TypeParam> expected = this->cloth_.direct();
  for (const int threads : {1, 2, 4, 1}) {
    with_threads(threads, [&] { this->cloth_.deferred.begin(this->cloth_.state()); });
    EXPECT_TRUE(same_bits(this->cloth_.finished(), expected)) << threads << " threads";
  }
}

TYPED_TEST(DeferredForcesTest, AreComputedAnewIfOneBitOfTheStateChanged) {
  const auto nudge = [](TypeParam& value) { value = std::nextafter(value, TypeParam(100)); };
  Cloth<TypeParam>& cloth = this->cloth_;
  for (TypeParam* value : {&cloth.positions(1, 77), &cloth.velocities(2, 1599), &cloth.masses[3]}) {
    const long before = cloth.deferred.num_recomputed();
    cloth.deferred.begin(cloth.state());
    nudge(*value);
    EXPECT_TRUE(same_bits(cloth.finished(), cloth.direct()));
    EXPECT_EQ(cloth.deferred.num_recomputed(), before + 1);
  }
}

TYPED_TEST(DeferredForcesTest, AreComputedAnewAtAnotherTime) {
  State<TypeParam> state = this->cloth_.state();
  this->cloth_.deferred.begin(state);
  state.time += 0.01;
  Matrix3X<TypeParam> forces;
  EXPECT_TRUE(this->cloth_.deferred.finish(state, forces).ok());
  EXPECT_EQ(this->cloth_.deferred.num_recomputed(), 1);
}

TYPED_TEST(DeferredForcesTest, WithoutBeginAreComputedAtOnce) {
  EXPECT_TRUE(same_bits(this->cloth_.finished(), this->cloth_.direct()));
  EXPECT_EQ(this->cloth_.deferred.num_recomputed(), 0);
}

TYPED_TEST(DeferredForcesTest, ADroppedOrRepeatedBeginLeavesNothingBehind) {
  Cloth<TypeParam>& cloth = this->cloth_;
  cloth.deferred.begin(cloth.state());
  cloth.deferred.drop();
  cloth.positions(0, 5) += TypeParam(0.01);
  cloth.deferred.begin(cloth.state());
  cloth.positions(0, 6) += TypeParam(0.01);
  cloth.deferred.begin(cloth.state());
  EXPECT_TRUE(same_bits(cloth.finished(), cloth.direct()));
  EXPECT_EQ(cloth.deferred.num_recomputed(), 0);
  cloth.deferred.begin(cloth.state());  // still in flight when everything goes away
}

TYPED_TEST(DeferredForcesTest, TheStateMayBeGoneBeforeFinish) {
  const Matrix3X<TypeParam> expected = this->cloth_.direct();
  {
    const auto copy = std::make_unique<Matrix3X<TypeParam>>(this->cloth_.positions);
    this->cloth_.deferred.begin({*copy, this->cloth_.velocities, this->cloth_.masses});
    copy->setConstant(TypeParam(1e6));
  }
  EXPECT_TRUE(same_bits(this->cloth_.finished(), expected));
}

TYPED_TEST(DeferredForcesTest, ReportAStateThatIsNotFinite) {
  Cloth<TypeParam>& cloth = this->cloth_;
  cloth.positions(1, 42) = std::numeric_limits<TypeParam>::quiet_NaN();
  cloth.deferred.begin(cloth.state());
  Matrix3X<TypeParam> forces;
  const ForceReport report = cloth.deferred.finish(cloth.state(), forces);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(*report.first_non_finite_node, 42);
  EXPECT_EQ(cloth.deferred.num_recomputed(), 0) << "a NaN has the bits it had";
}

TYPED_TEST(DeferredForcesTest, OtherParallelWorkInBetweenDoesNotDisturb) {
  Cloth<TypeParam>& cloth = this->cloth_;
  const Matrix3X<TypeParam> expected = cloth.direct();
  for (int repetition = 0; repetition < 20; ++repetition) {
    cloth.deferred.begin(cloth.state());
    std::vector<double> other(1000);
    parallel_for(other.size(), [&](std::size_t i) { other[i] = std::sqrt(i); });
    ASSERT_TRUE(same_bits(cloth.finished(), expected));
  }
}

}  // namespace
}  // namespace weft::forces
