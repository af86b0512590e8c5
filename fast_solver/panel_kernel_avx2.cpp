// Compiled for AVX2 and FMA (CMakeLists.txt), called only on processors that have them.
#include <weft/fast_solver/panel_kernel.hpp>

namespace weft::fast {
namespace {

#include "panel_kernel_body.inc"

}  // namespace

const PanelKernel& panel_kernel_avx2();

const PanelKernel& panel_kernel_avx2() {
  static constexpr PanelKernel kKernel{&times, &transposed_times};
  return kKernel;
}

}  // namespace weft::fast
