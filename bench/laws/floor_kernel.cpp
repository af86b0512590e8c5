// The floor: nothing but the arithmetic of a spring, in loops that the compiler turns into AVX2 with
// fused multiply-add. No parameters, no degenerate springs, no fixed order of sums.
#include "bench/laws/floor_kernel.hpp"

namespace weft::bench {
namespace {

constexpr int kBatch = 64;

float root(float x) {
  return __builtin_sqrtf(x);
}
double root(double x) {
  return __builtin_sqrt(x);
}

template <class Scalar>
inline void evaluate(int count, Scalar stiffness, const Scalar* __restrict rest,
                     const Scalar* __restrict dx, const Scalar* __restrict dy,
                     const Scalar* __restrict dz, Scalar* __restrict fx, Scalar* __restrict fy,
                     Scalar* __restrict fz) {
  for (int k = 0; k < count; ++k) {
    const Scalar length = root(dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k]);
    const Scalar factor = stiffness - stiffness * rest[k] / length;
    fx[k] = factor * dx[k];
    fy[k] = factor * dy[k];
    fz[k] = factor * dz[k];
  }
}

}  // namespace

bool has_avx2_and_fma() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

template <class Scalar>
void evaluate_springs(const FloorArrays<Scalar>& a, int begin, int end) {
  const int n = a.num_springs;
  evaluate(end - begin, a.stiffness, a.rest_lengths + begin, a.differences + begin,
           a.differences + n + begin, a.differences + 2 * n + begin, a.spring_forces + begin,
           a.spring_forces + n + begin, a.spring_forces + 2 * n + begin);
}

template <class Scalar>
void gather_evaluate_scatter(const FloorArrays<Scalar>& a, Scalar* node_forces, int begin,
                             int end) {
  const int n = a.num_nodes;
  Scalar d[3][kBatch];
  Scalar f[3][kBatch];
  for (int start = begin; start < end; start += kBatch) {
    const int count = end - start < kBatch ? end - start : kBatch;
    const int* const first = a.first + start;
    const int* const second = a.second + start;
    for (int axis = 0; axis < 3; ++axis) {
      const Scalar* const x = a.positions + axis * n;
      for (int k = 0; k < count; ++k) d[axis][k] = x[second[k]] - x[first[k]];
    }
    evaluate(count, a.stiffness, a.rest_lengths + start, d[0], d[1], d[2], f[0], f[1], f[2]);
    for (int axis = 0; axis < 3; ++axis) {
      Scalar* const sum = node_forces + axis * n;
      for (int k = 0; k < count; ++k) {
        sum[first[k]] += f[axis][k];
        sum[second[k]] -= f[axis][k];
      }
    }
  }
}

template <class Scalar>
void evaluate_runs(const FloorArrays<Scalar>& a, Scalar* node_forces, int begin, int end) {
  const int n = a.num_nodes;
  Scalar d[3][kBatch];
  Scalar f[3][kBatch];
  for (int run = begin; run < end; ++run) {
    for (int start = a.run_begins[run]; start < a.run_begins[run + 1]; start += kBatch) {
      const int rest = a.run_begins[run + 1] - start;
      const int count = rest < kBatch ? rest : kBatch;
      const int i = a.first[start];
      const int j = a.second[start];
      for (int axis = 0; axis < 3; ++axis) {
        const Scalar* const x = a.positions + axis * n;
        for (int k = 0; k < count; ++k) d[axis][k] = x[j + k] - x[i + k];
      }
      evaluate(count, a.stiffness, a.rest_lengths + start, d[0], d[1], d[2], f[0], f[1], f[2]);
      for (int axis = 0; axis < 3; ++axis) {
        Scalar* const sum = node_forces + axis * n;
        for (int k = 0; k < count; ++k) sum[i + k] += f[axis][k];
        for (int k = 0; k < count; ++k) sum[j + k] -= f[axis][k];
      }
    }
  }
}

template void evaluate_runs<float>(const FloorArrays<float>&, float*, int, int);
template void evaluate_runs<double>(const FloorArrays<double>&, double*, int, int);
template void evaluate_springs<float>(const FloorArrays<float>&, int, int);
template void evaluate_springs<double>(const FloorArrays<double>&, int, int);
template void gather_evaluate_scatter<float>(const FloorArrays<float>&, float*, int, int);
template void gather_evaluate_scatter<double>(const FloorArrays<double>&, double*, int, int);

}  // namespace weft::bench
