#pragma once

// Tested by tests/custom_forces/assembly/edge_assembly_test.cpp.

#include <cstddef>
#include <type_traits>
#include <utility>

#include <weft/core/eigen_alignment.hpp>
#include <weft/custom_forces/assembly/element_runs.hpp>
#include <weft/custom_forces/assembly/plain_vector.hpp>

namespace weft::forces {

// The loops over k below are written for the compiler's vectoriser: fixed arrays, no branches, one
// simple statement each. What they compute is defined edge by edge, in a fixed order of additions,
// and without fused operations; it does not depend on the width of the vectors.

template <class Scalar>
using EdgeVectors = Scalar[3][kElementBatch];

template <class Scalar>
[[gnu::always_inline]] inline void subtract_ends(const ElementRun& run,
                                                 const ElementRunsView<2>& runs,
                                                 const Scalar* field, EdgeVectors<Scalar>& out) {
  const int* const first = runs.slots[0] + run.begin;
  const int* const second = runs.slots[1] + run.begin;
  for (int axis = 0; axis < 3; ++axis) {
    const Scalar* const values = field + axis * runs.num_slots;
    if (run.is_consecutive) {
      const Scalar* const a = values + first[0];
      const Scalar* const b = values + second[0];
      for (int k = 0; k < run.count; ++k) out[axis][k] = b[k] - a[k];
    } else {
      for (int k = 0; k < run.count; ++k) out[axis][k] = values[second[k]] - values[first[k]];
    }
  }
}

template <class Scalar>
[[gnu::always_inline]] inline void add_to_ends(const ElementRun& run,
                                               const ElementRunsView<2>& runs,
                                               const EdgeVectors<Scalar>& forces, Scalar* sums) {
  const int* const first = runs.slots[0] + run.begin;
  const int* const second = runs.slots[1] + run.begin;
  for (int axis = 0; axis < 3; ++axis) {
    Scalar* const values = sums + axis * runs.num_slots;
    if (run.is_consecutive) {
      Scalar* const a = values + first[0];
      Scalar* const b = values + second[0];
      for (int k = 0; k < run.count; ++k) a[k] += forces[axis][k];
      for (int k = 0; k < run.count; ++k) b[k] -= forces[axis][k];
    } else {
      for (int k = 0; k < run.count; ++k) values[first[k]] += forces[axis][k];
      for (int k = 0; k < run.count; ++k) values[second[k]] -= forces[axis][k];
    }
  }
}

/// work: the sums, then the fields, each as 3 arrays of num_slots numbers.
template <class Scalar, class Force, std::size_t... kFields>
[[gnu::always_inline]] inline void evaluate_runs_inline(const Force& force,
                                                        const ElementRunsView<2>& runs,
                                                        Scalar* work,
                                                        std::index_sequence<kFields...>) {
  EdgeVectors<Scalar> differences[sizeof...(kFields)];
  EdgeVectors<Scalar> forces;
  for (const ElementRun* run = runs.begin; run != runs.end; ++run) {
    (subtract_ends(*run, runs, work + 3 * (1 + kFields) * static_cast<std::size_t>(runs.num_slots),
                   differences[kFields]),
     ...);
    for (int k = 0; k < run->count; ++k) {
      const PlainVector<Scalar> f =
          force(run->begin + k,
                PlainVector<Scalar>{differences[kFields][0][k], differences[kFields][1][k],
                                    differences[kFields][2][k]}...);
      forces[0][k] = f.x;
      forces[1][k] = f.y;
      forces[2][k] = f.z;
    }
    add_to_ends(*run, runs, forces, work);
  }
}

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
template <class Scalar, int kNumFields, class Force>
[[gnu::target("avx2"), gnu::flatten]] void evaluate_runs_avx2(const Force& force,
                                                              const ElementRunsView<2>& runs,
                                                              Scalar* work) {
  evaluate_runs_inline(force, runs, work, std::make_index_sequence<kNumFields>{});
}
#endif

/// Adds the forces of all edges in runs to the sums. On processors with AVX2 the same source runs
/// compiled for it: the same operations, and so the same bits.
template <class Scalar, int kNumFields, class Force>
[[gnu::flatten]] void evaluate_runs(const Force& force, const ElementRunsView<2>& runs,
                                    Scalar* work) {
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
  if constexpr (std::is_floating_point_v<Scalar>) {
    if (__builtin_cpu_supports("avx2")) {
      evaluate_runs_avx2<Scalar, kNumFields>(force, runs, work);
      return;
    }
  }
#endif
  evaluate_runs_inline(force, runs, work, std::make_index_sequence<kNumFields>{});
}

}  // namespace weft::forces
