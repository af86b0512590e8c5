#include "bench/line_transfer.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "bench/stopwatch.hpp"

namespace weft::bench {

double line_transfer_time() {
  constexpr int kBatches = 20;
  constexpr int kTimes = 100;  // there and back
  struct alignas(128) Ball {
    std::atomic<int> number{0};
  };
  Ball there;
  Ball back;
  std::thread other([&] {
    for (int i = 1; i <= kBatches * kTimes; ++i) {
      while (there.number.load(std::memory_order_acquire) != i) {
      }
      back.number.store(i, std::memory_order_release);
    }
  });
  std::vector<double> times;
  int i = 0;
  for (int batch = 0; batch < kBatches; ++batch) {
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < kTimes; ++k) {
      there.number.store(++i, std::memory_order_release);
      while (back.number.load(std::memory_order_acquire) != i) {
      }
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    times.push_back(1e6 * time.count() / (2 * kTimes));
  }
  other.join();
  return median(times);
}

}  // namespace weft::bench
