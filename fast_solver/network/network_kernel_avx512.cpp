// Compiled for AVX-512 (CMakeLists.txt), called only on processors that have it.
// Tested by tests/fast_solver/network/spring_network_test.cpp, tests/fast_solver/implicit_solver_test.cpp.
#include <immintrin.h>

#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>

namespace weft::fast {
namespace {

constexpr int kVectorBytes = 64;
#include <weft/fast_solver/simd/vector_types.inc>

#include <weft/fast_solver/network/network_kernel_body.inc>

#include <weft/fast_solver/simd/vector_kernel_body.inc>

#include <weft/fast_solver/coarse/coarse_kernel_body.inc>

}  // namespace

template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx512();
template <class Scalar>
const SumKernel<Scalar>& sum_kernel_avx512();
const VectorKernel& vector_kernel_avx512();
const CoarseKernel& coarse_kernel_avx512();

template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx512() {
  return kKernel<Scalar>;
}

template <class Scalar>
const SumKernel<Scalar>& sum_kernel_avx512() {
  return kSums<Scalar>;
}

const VectorKernel& vector_kernel_avx512() {
  return kVectors;
}

const CoarseKernel& coarse_kernel_avx512() {
  return kCoarse;
}

template const NetworkKernel<float>& network_kernel_avx512();
template const NetworkKernel<double>& network_kernel_avx512();
template const SumKernel<float>& sum_kernel_avx512();
template const SumKernel<double>& sum_kernel_avx512();

}  // namespace weft::fast
