#pragma once

#include <algorithm>
#include <cstddef>

#include <weft/core/parallel/index_work.hpp>

namespace weft {

/// work(i) for each i < count, by the threads of num_threads(), each index by one of them; returns when all are done. Which thread has
/// which index is left to chance: a result has the same bits for any number of threads only if an index writes what no
/// other one writes. Throws what work throws, one exception if there are several; then some indices may be left out.
void run_parallel(std::size_t count, IndexWork work);

template <class Work>
void parallel_for(std::size_t count, const Work& work) {
  run_parallel(count, IndexWork(work));
}

/// The indices begin, ..., end - 1.
struct IndexRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// work(chunk) for chunks of grain indices, the last of what is left. Chunks depend on range and grain only, never on threads.
/// A single chunk is computed by the caller, without waking anybody. grain: at least 1.
template <class Work>
void parallel_for(IndexRange range, std::size_t grain, const Work& work) {
  const std::size_t size = range.end - range.begin;
  if (size <= grain) {
    if (size > 0) work(range);
    return;
  }
  parallel_for((size + grain - 1) / grain, [&](std::size_t chunk) {
    const std::size_t begin = range.begin + chunk * grain;
    work(IndexRange{begin, std::min(begin + grain, range.end)});
  });
}

}  // namespace weft
