#include "bench/stopwatch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <deque>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace weft::bench {
namespace {

/// Long against the clock's resolution (30 ns) and short against a scheduler's slice.
constexpr double kRoundTime = 2e-3;  // [s]

double seconds_of(int num_calls, const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < num_calls; ++i) call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Timing> race(const std::vector<Contender>& contenders, int num_rounds) {
  std::deque<tbb::task_arena> arenas;
  std::vector<int> num_calls;
  std::vector<std::vector<double>> times(contenders.size());
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    arenas.emplace_back(contenders[c].num_threads);
    arenas[c].execute([&] {
      contenders[c].call();  // memory is allocated, threads are awake
      const double once = seconds_of(3, contenders[c].call) / 3;
      num_calls.push_back(std::max(1, static_cast<int>(std::lround(kRoundTime / once))));
    });
  }
  for (int round = 0; round < num_rounds; ++round) {
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      arenas[c].execute([&] {
        contenders[c].call();  // caches are this contender's again
        times[c].push_back(seconds_of(num_calls[c], contenders[c].call) / num_calls[c]);
      });
    }
  }
  std::vector<Timing> result;
  for (std::vector<double>& t : times) {
    const double minimum = *std::min_element(t.begin(), t.end());
    result.push_back({median(t), minimum});
  }
  return result;
}

double processor_time() {
  timespec now{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double processor_time(const std::function<void()>& call) {
  const double start = processor_time();
  call();
  return processor_time() - start;
}

}  // namespace weft::bench
