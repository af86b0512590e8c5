#include "bench/line_transfer.hpp"

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>
#include <vector>

#include "bench/stopwatch.hpp"

namespace weft::bench {

double line_transfer_time() {
  using Clock = std::chrono::steady_clock;
  constexpr int kBatches = 20;
  constexpr int kTimes = 100;  // there and back
  constexpr std::chrono::milliseconds kPatience(20);
  struct alignas(128) Ball {
    std::atomic<int> number{0};
  };
  Ball there;
  Ball back;
  std::atomic<bool> is_over = false;
  std::thread other([&] {
    for (int i = 1; !is_over.load(std::memory_order_relaxed); ++i) {
      while (there.number.load(std::memory_order_acquire) != i) {
        if (is_over.load(std::memory_order_relaxed)) return;
      }
      back.number.store(i, std::memory_order_release);
    }
  });
  std::vector<double> times;
  int i = 0;
  const Clock::time_point deadline = Clock::now() + kPatience;
  bool is_late = false;
  for (int batch = 0; batch < kBatches && !is_late; ++batch) {
    const Clock::time_point start = Clock::now();
    for (int k = 0; k < kTimes && !is_late; ++k) {
      there.number.store(++i, std::memory_order_release);
      for (int looks = 1; back.number.load(std::memory_order_acquire) != i && !is_late; ++looks) {
        is_late = looks % 1024 == 0 && Clock::now() > deadline;
      }
    }
    const std::chrono::duration<double> time = Clock::now() - start;
    times.push_back(1e6 * time.count() / (2 * kTimes));
  }
  is_over.store(true, std::memory_order_relaxed);
  other.join();
  return is_late ? std::numeric_limits<double>::infinity() : median(times);
}

}  // namespace weft::bench
