#include <weft/fast_solver/panel_kernel.hpp>

namespace weft::fast {

#ifdef WEFT_VECTOR_KERNELS
const PanelKernel& panel_kernel_avx2();
#endif

namespace {

#include "panel_kernel_body.inc"

}  // namespace

const PanelKernel& panel_kernel() {
#ifdef WEFT_VECTOR_KERNELS
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return panel_kernel_avx2();
#endif
  static constexpr PanelKernel kKernel{&times, &transposed_times};
  return kKernel;
}

}  // namespace weft::fast
