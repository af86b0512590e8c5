#pragma once

// Stands in for oneTBB's header in builds with the thread sanitizer. The installed oneTBB library
// is not instrumented, so the sanitizer cannot see how it hands work to its threads and calls every
// shared byte a race. Started and joined as std::thread, the same bodies are judged as they are.

#include <algorithm>
#include <exception>
#include <thread>
#include <vector>

#include <tbb/blocked_range.h>

namespace tbb {

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  constexpr int kThreads = 4;
  std::vector<std::thread> threads;
  std::vector<std::exception_ptr> thrown(kThreads);
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([=, &body, &thrown] {
      try {
        for (Index i = first + static_cast<Index>(t); i < last; i += kThreads) body(i);
      } catch (...) {
        thrown[static_cast<std::size_t>(t)] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  const auto grain = static_cast<Value>(range.grainsize());
  const Value num_parts = (range.end() - range.begin() + grain - 1) / grain;
  parallel_for(Value{0}, num_parts, [&](Value part) {
    const Value begin = range.begin() + part * grain;
    body(blocked_range<Value>(begin, std::min<Value>(begin + grain, range.end())));
  });
}

}  // namespace tbb
