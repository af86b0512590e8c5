#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <weft/core/parallel/index_work.hpp>

// How many threads Weft uses. They come from oneTBB or are Weft's own, as the option WEFT_THREADS of the build says; results have the
// same bits with either and for any number. With oneTBB an arena of the calling program counts, as for its own loops.

namespace weft {

/// Threads that loops of the calling thread may use, itself included: one per processor unless with_threads() or, with oneTBB, an arena
/// says otherwise.
[[nodiscard]] int num_threads();

/// The library that the threads come from, with its version: "oneTBB 2021.8" or "std::thread".
[[nodiscard]] std::string thread_library();

/// with_threads() without a result. Throws InvalidArgument for num_threads < 1.
void call_with_threads(int num_threads, IndexWork work);

/// The result of work(), whose loops use at most num_threads threads, the caller included; more than there are processors if asked
/// for. With one thread nothing runs on another. Throws InvalidArgument for num_threads < 1, and what work throws.
template <class Work>
auto with_threads(int num_threads, Work&& work) {
  using Result = std::invoke_result_t<Work&>;
  if constexpr (std::is_void_v<Result>) {
    const auto call = [&](std::size_t) { work(); };
    call_with_threads(num_threads, IndexWork(call));
  } else {
    std::optional<Result> result;
    const auto call = [&](std::size_t) { result.emplace(work()); };
    call_with_threads(num_threads, IndexWork(call));
    return Result(std::move(*result));
  }
}

/// isolated() by the compiled library.
void call_isolated(IndexWork work);

/// work(), in which a thread that waits for a loop takes no task that was begun outside of work.
template <class Work>
void isolated(const Work& work) {
  const auto call = [&](std::size_t) { work(); };
  call_isolated(IndexWork(call));
}

}  // namespace weft
