#include <weft/fast_solver/coarse/coarse_kernel.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>

#ifdef WEFT_VECTOR_KERNELS
#include <cpuid.h>
#endif

namespace weft::fast {

#ifdef WEFT_VECTOR_KERNELS
template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx2();
template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx512();
template <class Scalar>
const SumKernel<Scalar>& sum_kernel_avx2();
template <class Scalar>
const SumKernel<Scalar>& sum_kernel_avx512();
const VectorKernel& vector_kernel_avx2();
const VectorKernel& vector_kernel_avx512();
const CoarseKernel& coarse_kernel_avx2();
const CoarseKernel& coarse_kernel_avx512();
#endif

namespace {

constexpr int kVectorBytes = 16;
#include <weft/fast_solver/simd/vector_types.inc>

#include <weft/fast_solver/network/network_kernel_body.inc>

#include <weft/fast_solver/simd/vector_kernel_body.inc>

#include <weft/fast_solver/coarse/coarse_kernel_body.inc>

#ifdef WEFT_VECTOR_KERNELS
// Half precision goes with AVX2 in every processor, but not in every virtual machine; not all compilers know its name.
bool ask_for_halves() {
  unsigned eax = 0;
  unsigned ebx = 0;
  unsigned ecx = 0;
  unsigned edx = 0;
  return __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0 && (ecx & bit_F16C) != 0;
}
bool has_halves() {
  static const bool has = ask_for_halves();  // a question that takes microseconds
  return has;
}
bool has_avx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && has_halves();
}
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && has_avx2();
}
#endif

}  // namespace

template <class Scalar>
const NetworkKernel<Scalar>& network_kernel() {
#ifdef WEFT_VECTOR_KERNELS
  if (has_avx512()) return network_kernel_avx512<Scalar>();
  if (has_avx2()) return network_kernel_avx2<Scalar>();
#endif
  return kKernel<Scalar>;
}

template <class Scalar>
const SumKernel<Scalar>& sum_kernel() {
#ifdef WEFT_VECTOR_KERNELS
  if (has_avx512()) return sum_kernel_avx512<Scalar>();
  if (has_avx2()) return sum_kernel_avx2<Scalar>();
#endif
  return kSums<Scalar>;
}

const VectorKernel& vector_kernel() {
#ifdef WEFT_VECTOR_KERNELS
  if (has_avx512()) return vector_kernel_avx512();
  if (has_avx2()) return vector_kernel_avx2();
#endif
  return kVectors;
}

const CoarseKernel& coarse_kernel() {
#ifdef WEFT_VECTOR_KERNELS
  if (has_avx512()) return coarse_kernel_avx512();
  if (has_avx2()) return coarse_kernel_avx2();
#endif
  return kCoarse;
}

template const NetworkKernel<float>& network_kernel();
template const NetworkKernel<double>& network_kernel();
template const SumKernel<float>& sum_kernel();
template const SumKernel<double>& sum_kernel();

}  // namespace weft::fast
