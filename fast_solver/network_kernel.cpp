#include <weft/fast_solver/network_kernel.hpp>

namespace weft::fast {

#ifdef WEFT_VECTOR_KERNELS
template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx2();
template <class Scalar>
const NetworkKernel<Scalar>& network_kernel_avx512();
BlockProduct block_product_avx2();
BlockProduct block_product_avx512();
#endif

namespace {

constexpr int kVectorBytes = 16;
#include "network_kernel_body.inc"

#ifdef WEFT_VECTOR_KERNELS
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl");
}
bool has_avx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
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

BlockProduct block_product() {
#ifdef WEFT_VECTOR_KERNELS
  if (has_avx512()) return block_product_avx512();
  if (has_avx2()) return block_product_avx2();
#endif
  return &multiply_blocks;
}

template const NetworkKernel<float>& network_kernel();
template const NetworkKernel<double>& network_kernel();

}  // namespace weft::fast
