// Compiled for AVX2 and FMA (CMakeLists.txt), called only on processors that have it.
#include <immintrin.h>

#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>

namespace weft::fast {
namespace {

constexpr int kVectorBytes = 32;
#include <weft/fast_solver/simd/vector_types.inc>

#include <weft/fast_solver/network/network_kernel_body.inc>

#include <weft/fast_solver/simd/vector_kernel_body.inc>

#include <weft/fast_solver/coarse/coarse_kernel_body.inc>

}  // namespace

template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx2();
template <class Scalar>
const SumKernel<Scalar>& sum_kernel_avx2();
const VectorKernel& vector_kernel_avx2();
const CoarseKernel& coarse_kernel_avx2();

template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx2() {
  return kKernel<Scalar>;
}

template <class Scalar>
const SumKernel<Scalar>& sum_kernel_avx2() {
  return kSums<Scalar>;
}

const VectorKernel& vector_kernel_avx2() {
  return kVectors;
}

const CoarseKernel& coarse_kernel_avx2() {
  return kCoarse;
}

template const NetworkKernel<float>& network_kernel_avx2();
template const NetworkKernel<double>& network_kernel_avx2();
template const SumKernel<float>& sum_kernel_avx2();
template const SumKernel<double>& sum_kernel_avx2();

}  // namespace weft::fast
