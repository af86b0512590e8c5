// A law allocates nothing while it runs.
#include <new>
#include <ostream>

#include <gtest/gtest.h>

#include <weft/core/parallel/threads.hpp>
#include <weft/custom_forces/law_set.hpp>

#include "tests/contract/sample.hpp"
#include "tests/contract/subject.hpp"
#include "tests/support/allocation_counter.hpp"

namespace weft::contract {

void PrintTo(const Subject& subject, std::ostream* out) {
  *out << subject.name;
}

namespace {

template <class Scalar>
long allocations_of(const Subject& subject) {
  const ClothMesh mesh = subject.large_mesh();
  forces::LawSet<Scalar> laws;
  laws.add(subject.make<Scalar>(mesh));
  const Sample<Scalar> sample = cast<Scalar>(deformed(mesh, Deformation::kMixed));
  const Matrix3X<Scalar> b = random_directions(mesh.num_nodes(), 3).template cast<Scalar>();
  Matrix3X<Scalar> result = Matrix3X<Scalar>::Zero(3, mesh.num_nodes());
  const forces::State<Scalar> state = sample.state();
  const auto call_everything = [&] {
    (void)laws.add_forces(state, forces::LawSet<Scalar>::VelocityLaws::kAsForces, result);
    laws.add_stiffness_product(state, b, result);
    laws.add_damping_product(state, b, result);
    laws.advance_velocities(state, Scalar(0.01), result);
    laws.redistribute_forces(state, result);
    (void)laws.potential_energy(state);
    (void)laws.non_conservative_power(state);
  };
  call_everything();  // warm-up: threads are started
  const long before = test::num_allocations();
  call_everything();
  return test::num_allocations() - before;
}

class LawAllocation : public testing::TestWithParam<Subject> {};

INSTANTIATE_TEST_SUITE_P(Registry, LawAllocation, testing::ValuesIn(all_subjects()),
                         [](const auto& info) { return info.param.name; });

TEST_P(LawAllocation, IsZeroAfterWarmUp) {
  for (const int threads : {1, 2}) {
    with_threads(threads, [&] {
      EXPECT_EQ(allocations_of<float>(GetParam()), 0) << threads << " threads";
      EXPECT_EQ(allocations_of<double>(GetParam()), 0) << threads << " threads";
    });
  }
}

TEST(LawAllocation, TheCounterSeesEigenAndOperatorNew) {
  const long before = test::num_allocations();
  const Matrix3X<double> temporary = random_directions(100, 1);
  EXPECT_GT(test::num_allocations(), before) << temporary.cols();
  const long between = test::num_allocations();
  // Called as a function: a compiler may leave out the allocation of an unused container.
  ::operator delete(::operator new(100));
  EXPECT_GT(test::num_allocations(), between);
}

}  // namespace
}  // namespace weft::contract
