#pragma once

// Tested by tests/custom_forces/assembly/batched_assembly_test.cpp.

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include <weft/core/eigen_alignment.hpp>
#include <weft/custom_forces/assembly/element_runs.hpp>
#include <weft/custom_forces/assembly/plain_vector.hpp>

namespace weft::forces {

/// A vector for each corner of an element.
template <class Number, int kNodes>
using Corners = std::array<PlainVector<Number>, static_cast<std::size_t>(kNodes)>;

// As in edge_kernel.hpp, the loops over k are written for the compiler's vectoriser, and what they compute does not depend on
// the width of the vectors.

template <class Scalar, int kNodes>
using CornerArrays = Scalar[kNodes][3][kElementBatch];

template <class Scalar, int kNodes>
[[gnu::always_inline]] inline void fetch_corners(const ElementRun& run,
                                                 const ElementRunsView<kNodes>& runs,
                                                 const Scalar* field,
                                                 CornerArrays<Scalar, kNodes>& out) {
  for (std::size_t corner = 0; corner < kNodes; ++corner) {
    const int* const slots = runs.slots[corner] + run.begin;
    for (int axis = 0; axis < 3; ++axis) {
      const Scalar* const values = field + axis * runs.num_slots;
      Scalar* const to = out[corner][axis];
      if (run.is_consecutive) {
        const Scalar* const from = values + slots[0];
        for (int k = 0; k < run.count; ++k) to[k] = from[k];
      } else {
        for (int k = 0; k < run.count; ++k) to[k] = values[slots[k]];
      }
    }
  }
}

template <class Scalar, int kNodes>
[[gnu::always_inline]] inline void add_to_corners(const ElementRun& run,
                                                  const ElementRunsView<kNodes>& runs,
                                                  const CornerArrays<Scalar, kNodes>& forces,
                                                  Scalar* sums) {
  for (std::size_t corner = 0; corner < kNodes; ++corner) {
    const int* const slots = runs.slots[corner] + run.begin;
    for (int axis = 0; axis < 3; ++axis) {
      Scalar* const values = sums + axis * runs.num_slots;
      const Scalar* const parts = forces[corner][axis];
      if (run.is_consecutive) {
        Scalar* const to = values + slots[0];
        for (int k = 0; k < run.count; ++k) to[k] += parts[k];
      } else {
        for (int k = 0; k < run.count; ++k) values[slots[k]] += parts[k];
      }
    }
  }
}

template <class Scalar, int kNodes>
[[gnu::always_inline]] inline Corners<Scalar, kNodes> corners_at(
    const CornerArrays<Scalar, kNodes>& arrays, int k) {
  Corners<Scalar, kNodes> corners;
  for (std::size_t corner = 0; corner < kNodes; ++corner) {
    corners[corner] = {arrays[corner][0][k], arrays[corner][1][k], arrays[corner][2][k]};
  }
  return corners;
}

/// work: the sums, then the fields, each as 3 arrays of num_slots numbers.
template <class Scalar, int kNodes, class Force, std::size_t... kFields>
[[gnu::always_inline]] inline void evaluate_elements_inline(const Force& force,
                                                            const ElementRunsView<kNodes>& runs,
                                                            Scalar* work,
                                                            std::index_sequence<kFields...>) {
  CornerArrays<Scalar, kNodes> fields[sizeof...(kFields)];
  CornerArrays<Scalar, kNodes> forces;
  for (const ElementRun* run = runs.begin; run != runs.end; ++run) {
    (fetch_corners<Scalar, kNodes>(
         *run, runs, work + 3 * (1 + kFields) * static_cast<std::size_t>(runs.num_slots),
         fields[kFields]),
     ...);
    for (int k = 0; k < run->count; ++k) {
      const Corners<Scalar, kNodes> parts =
          force(run->begin + k, corners_at<Scalar, kNodes>(fields[kFields], k)...);
      for (std::size_t corner = 0; corner < kNodes; ++corner) {
        forces[corner][0][k] = parts[corner].x;
        forces[corner][1][k] = parts[corner].y;
        forces[corner][2][k] = parts[corner].z;
      }
    }
    add_to_corners<Scalar, kNodes>(*run, runs, forces, work);
  }
}

/// Numbers that are added up, apart from each other, as wide as the widest vectors; their order does not depend on the vectors.
template <class Sum>
using PartialSums = Sum[16];

/// sums[k % 16] += value of the element at place begin + k of each run. field: 3 arrays of num_slots numbers.
template <class Scalar, int kNodes, class Sum, class Value>
[[gnu::always_inline]] inline void sum_elements_inline(const Value& value,
                                                       const ElementRunsView<kNodes>& runs,
                                                       const Scalar* field,
                                                       PartialSums<Sum>& sums) {
  constexpr int kNumSums = 16;
  CornerArrays<Scalar, kNodes> corners;
  Scalar values[kElementBatch];
  for (const ElementRun* run = runs.begin; run != runs.end; ++run) {
    fetch_corners<Scalar, kNodes>(*run, runs, field, corners);
    for (int k = 0; k < run->count; ++k) {
      values[k] = value(run->begin + k, corners_at<Scalar, kNodes>(corners, k));
    }
    for (int k = run->count; k % kNumSums != 0; ++k) values[k] = Scalar(0);
    for (int first = 0; first < run->count; first += kNumSums) {
      for (int k = 0; k < kNumSums; ++k) sums[k] += Sum(values[first + k]);
    }
  }
}

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
template <class Scalar, int kNodes, int kNumFields, class Force>
[[gnu::target("avx2"), gnu::flatten]] void evaluate_elements_avx2(
    const Force& force, const ElementRunsView<kNodes>& runs, Scalar* work) {
  evaluate_elements_inline<Scalar, kNodes>(force, runs, work,
                                           std::make_index_sequence<kNumFields>{});
}
template <class Scalar, int kNodes, class Sum, class Value>
[[gnu::target("avx2"), gnu::flatten]] void sum_elements_avx2(const Value& value,
                                                             const ElementRunsView<kNodes>& runs,
                                                             const Scalar* field,
                                                             PartialSums<Sum>& sums) {
  sum_elements_inline<Scalar, kNodes, Sum>(value, runs, field, sums);
}
#endif

/// Adds the forces of all elements in runs to the sums. On processors with AVX2 the same source runs
/// compiled for it: the same operations, and so the same bits.
template <class Scalar, int kNodes, int kNumFields, class Force>
[[gnu::flatten]] void evaluate_elements(const Force& force, const ElementRunsView<kNodes>& runs,
                                        Scalar* work) {
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
  if constexpr (std::is_floating_point_v<Scalar>) {
    if (__builtin_cpu_supports("avx2")) {
      evaluate_elements_avx2<Scalar, kNodes, kNumFields>(force, runs, work);
      return;
    }
  }
#endif
  evaluate_elements_inline<Scalar, kNodes>(force, runs, work,
                                           std::make_index_sequence<kNumFields>{});
}

/// Likewise for values that are only added up.
template <class Scalar, int kNodes, class Sum, class Value>
[[gnu::flatten]] void sum_elements(const Value& value, const ElementRunsView<kNodes>& runs,
                                   const Scalar* field, PartialSums<Sum>& sums) {
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
  if constexpr (std::is_floating_point_v<Scalar>) {
    if (__builtin_cpu_supports("avx2")) {
      sum_elements_avx2<Scalar, kNodes, Sum>(value, runs, field, sums);
      return;
    }
  }
#endif
  sum_elements_inline<Scalar, kNodes, Sum>(value, runs, field, sums);
}

}  // namespace weft::forces
