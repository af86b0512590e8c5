#include <weft/core/parallel/parallel_for.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/parallel/threads.hpp>

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

TEST(ParallelFor, DoesEachIndexOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    with_threads(threads, [&] {
      for (const std::size_t count : {0, 1, 2, 7, 1000}) {
        std::vector<std::atomic<int>> times(count);
        for (int again = 0; again < 50; ++again) {
          parallel_for(count, [&](std::size_t i) { ++times[i]; });
        }
        for (const auto& one : times) ASSERT_EQ(one, 50) << threads << " threads, " << count;
      }
    });
  }
}

TEST(ParallelFor, CutsARangeByTheGrainAlone) {
  using Chunk = std::pair<std::size_t, std::size_t>;
  const std::vector<Chunk> expected{{5, 15}, {15, 25}, {25, 28}};
  for (const int threads : {1, 2, 5}) {
    std::vector<Chunk> chunks;
    std::mutex mutex;
    with_threads(threads, [&] {
      parallel_for(IndexRange{5, 28}, 10, [&](IndexRange chunk) {
        const std::lock_guard lock(mutex);
        chunks.emplace_back(chunk.begin, chunk.end);
      });
    });
    std::sort(chunks.begin(), chunks.end());
    EXPECT_EQ(chunks, expected) << threads << " threads";
  }
}

TEST(ParallelFor, LeavesASingleChunkToTheCaller) {
  const std::thread::id caller = std::this_thread::get_id();
  int times = 0;
  const auto count = [&](IndexRange chunk) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    times += static_cast<int>(chunk.end - chunk.begin);
  };
  parallel_for(IndexRange{3, 13}, 10, count);
  parallel_for(IndexRange{3, 3}, 10, count);
  EXPECT_EQ(times, 10);
}

// Index 0 waits for another thread to take index 1. A thread may come late, therefore again and again.
TEST(ParallelFor, IsSharedByThreads) {
  std::atomic<bool> is_shared = false;
  with_threads(2, [&] {
    for (int loop = 0; loop < 1000 && !is_shared; ++loop) {
      std::atomic<int> num_begun = 0;
      parallel_for(2, [&](std::size_t) {
        ++num_begun;
        const auto end = Clock::now() + std::chrono::milliseconds(5);
        while (num_begun < 2 && Clock::now() < end) std::this_thread::yield();
        if (num_begun == 2) is_shared = true;
      });
    }
  });
  EXPECT_TRUE(is_shared);
}

TEST(ParallelFor, HasAtMostSoManyThreads) {
  for (const int threads : {1, 2, 3}) {
    std::atomic<int> num_now = 0;
    std::atomic<int> most = 0;
    with_threads(threads, [&] {
      parallel_for(60, [&](std::size_t) {
        const int now = ++num_now;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
        }
        std::this_thread::sleep_for(std::chrono::microseconds(300));
        --num_now;
      });
    });
    EXPECT_LE(most, threads);
  }
}

long nested_sum(std::size_t outer, std::size_t inner) {
  std::vector<long> sums(outer);
  parallel_for(outer, [&](std::size_t i) {
    std::vector<long> parts(inner);
    parallel_for(inner, [&](std::size_t k) { parts[k] = static_cast<long>(i * k); });
    sums[i] = std::accumulate(parts.begin(), parts.end(), 0L);
  });
  return std::accumulate(sums.begin(), sums.end(), 0L);
}

TEST(ParallelFor, MayStandInAnother) {
  with_threads(4, [] {
    for (int again = 0; again < 100; ++again) ASSERT_EQ(nested_sum(9, 30), 36 * 435);
  });
}

// Each thread's loops end, whatever the others do.
TEST(ParallelFor, IsForSeveralCallersAtOnce) {
  std::atomic<int> num_right = 0;
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&num_right, caller] {
      with_threads(1 + caller, [&] {
        for (int again = 0; again < 50; ++again) num_right += nested_sum(5, 20) == 10 * 190 ? 1 : 0;
      });
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(num_right, 200);
}

TEST(ParallelFor, ThrowsWhatAnIndexThrows) {
  for (const int threads : {1, 3}) {
    with_threads(threads, [] {
      for (int again = 0; again < 50; ++again) {
        EXPECT_THROW(parallel_for(20,
                                  [](std::size_t i) {
                                    if (i == 13) throw std::out_of_range("13");
                                  }),
                     std::out_of_range);
        ASSERT_EQ(nested_sum(3, 4), 3 * 6);
      }
    });
  }
}

}  // namespace
}  // namespace weft
