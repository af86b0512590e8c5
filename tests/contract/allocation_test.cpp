// A law allocates nothing while it runs.
//
// The linker's --wrap replaces every reference to malloc, operator new (_Znwm, and with alignment
// _ZnwmSt11align_val_t) and their relatives in the object files of this program, and with them in
// the laws and in Eigen, whose temporaries come from malloc. Shared libraries keep their own
// references, so what oneTBB takes from its pool for its tasks is not counted: it is TBB's own
// recycled memory, not the law's. The counter is per process, so that worker threads count too.

#include <atomic>
#include <cstddef>
#include <new>
#include <ostream>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <weft/custom_forces/law_set.hpp>

#include "tests/contract/sample.hpp"
#include "tests/contract/subject.hpp"

namespace {
std::atomic<long> num_allocations{0};
}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** memory, std::size_t alignment, std::size_t size);
void* __real__Znwm(std::size_t size);
void* __real__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment);

void* __wrap_malloc(std::size_t size) {
  ++num_allocations;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++num_allocations;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* memory, std::size_t size) {
  ++num_allocations;
  return __real_realloc(memory, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  ++num_allocations;
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++num_allocations;
  return __real_posix_memalign(memory, alignment, size);
}
void* __wrap__Znwm(std::size_t size) {
  ++num_allocations;
  return __real__Znwm(size);
}
void* __wrap__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment) {
  ++num_allocations;
  return __real__ZnwmSt11align_val_t(size, alignment);
}
}

namespace weft::contract {

void PrintTo(const Subject& subject, std::ostream* out) {
  *out << subject.name;
}

namespace {

template <class Scalar>
long allocations_of(const Subject& subject, int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
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
  call_everything();  // warm-up: TBB starts its threads
  const long before = num_allocations;
  call_everything();
  return num_allocations - before;
}

class LawAllocation : public testing::TestWithParam<Subject> {};

INSTANTIATE_TEST_SUITE_P(Registry, LawAllocation, testing::ValuesIn(all_subjects()),
                         [](const auto& info) { return info.param.name; });

TEST_P(LawAllocation, IsZeroAfterWarmUp) {
  for (const int threads : {1, 2}) {
    EXPECT_EQ(allocations_of<float>(GetParam(), threads), 0) << threads << " threads";
    EXPECT_EQ(allocations_of<double>(GetParam(), threads), 0) << threads << " threads";
  }
}

TEST(LawAllocation, TheCounterSeesEigenAndOperatorNew) {
  const long before = num_allocations;
  const Matrix3X<double> temporary = random_directions(100, 1);
  EXPECT_GT(num_allocations, before) << temporary.cols();
  const long between = num_allocations;
  // Called as a function: a compiler may leave out the allocation of an unused container.
  ::operator delete(::operator new(100));
  EXPECT_GT(num_allocations, between);
}

}  // namespace
}  // namespace weft::contract
