#pragma once

namespace weft::fast {

/// Numbers that a panel's leading dimension, and the strides of the vectors that it meets, are multiples
/// of. All arrays are aligned to as many.
inline constexpr int kPanelBlock = 16;

/// A dense matrix of the factor, column by column.
struct Panel {
  const float* entries;
  int num_rows;  ///< multiple of kPanelBlock, distance between columns; filled up with zeros
  int num_columns;
};

/// Products of a panel with three vectors at once, which is what a cloth has: x, y and z. Vectors are
/// three arrays one after the other, each as long as its stride.
struct PanelKernel {
  /// out (3 arrays, stride num_rows) = panel in (3 arrays of num_columns, stride in_stride)
  void (*times)(const Panel& panel, const float* in, int in_stride, float* out);
  /// out (3 arrays of num_columns, stride out_stride) = panel^T in (3 arrays, stride num_rows)
  void (*transposed_times)(const Panel& panel, const float* in, float* out, int out_stride);
};

/// The fastest that this processor runs. Its results are the same in every call, but not those of
/// another processor: AVX2 brings fused operations.
[[nodiscard]] const PanelKernel& panel_kernel();

}  // namespace weft::fast
