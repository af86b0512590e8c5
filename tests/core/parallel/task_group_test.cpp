#include <weft/core/parallel/task_group.hpp>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/threads.hpp>

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;
using Place = TaskGroup::Place;

bool has_own_threads() {
  return thread_library() == "std::thread";
}

/// Whether another thread sets the flag in time. oneTBB may have no thread for long, for one that has been in another arena
/// may stay there for seconds: tests of it are then skipped.
bool is_set_by_another(const std::atomic<bool>& flag) {
  const auto end = Clock::now() + std::chrono::seconds(has_own_threads() ? 60 : 2);
  while (!flag && Clock::now() < end) std::this_thread::yield();
  return flag;
}

class TaskGroups : public testing::TestWithParam<Place> {
 protected:
  TaskGroup group_{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Both, TaskGroups, testing::Values(Place::kHere, Place::kApart),
                         [](const auto& info) {
                           return info.param == Place::kHere ? "Here" : "Apart";
                         });

TEST_P(TaskGroups, DoEachTaskOnce) {
  for (const int threads : {1, 2, 4}) {
    with_threads(threads, [&] {
      std::vector<std::atomic<int>> times(5);
      for (int again = 0; again < 200; ++again) {
        group_.start(times.size(), [&times](std::size_t i) { ++times[i]; });
        group_.wait();
        group_.wait();  // for nothing
      }
      for (const auto& one : times) ASSERT_EQ(one, 200) << threads << " threads";
    });
  }
}

TEST_P(TaskGroups, WaitForTheLastStart) {
  std::atomic<int> times = 0;
  for (int again = 0; again < 20; ++again) {
    group_.start(3, [&times](std::size_t) { ++times; });
  }
  group_.wait();
  EXPECT_EQ(times, 60);
}

TEST_P(TaskGroups, RunWhileTheCallerGoesOn) {
  with_threads(2, [&] {
    std::atomic<bool> has_run = false;
    group_.start(1, [&has_run](std::size_t) { has_run = true; });
    const bool is_in_time = is_set_by_another(has_run);
    group_.wait();
    if (!is_in_time && !has_own_threads()) GTEST_SKIP() << "oneTBB has no thread to spare";
    EXPECT_TRUE(is_in_time);
  });
}

TEST_P(TaskGroups, HaveNothingDoneBeforeWaitByOneThread) {
  with_threads(1, [&] {
    std::atomic<int> times = 0;
    group_.start(4, [&times](std::size_t) { ++times; });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(times, 0);
    group_.wait();
    EXPECT_EQ(times, 4);
  });
}

/// A task that is in a long loop, to be cancelled.
struct LongTask {
  std::atomic<bool> has_begun = false;
  std::atomic<int> num_done = 0;
  void run() {
    parallel_for(20000, [this](std::size_t) {
      has_begun = true;
      ++num_done;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  }
};

TEST_P(TaskGroups, LeaveOutTheRestOfALoopWhenCancelled) {
  with_threads(2, [&] {
    LongTask task;
    group_.start(1, [&task](std::size_t) { task.run(); });
    const bool has_begun = is_set_by_another(task.has_begun);
    group_.cancel();
    group_.wait();
    if (!has_begun && !has_own_threads()) GTEST_SKIP() << "oneTBB has no thread to spare";
    EXPECT_TRUE(has_begun);
    EXPECT_LT(task.num_done, 20000);
    // The next tasks are not.
    std::atomic<int> times = 0;
    group_.start(3, [&times](std::size_t) { ++times; });
    group_.wait();
    EXPECT_EQ(times, 3);
  });
}

TEST_P(TaskGroups, AreCancelledWhenDestroyed) {
  LongTask task;
  with_threads(2, [&] {
    TaskGroup group(GetParam());
    group.start(1, [&task](std::size_t) { task.run(); });
  });
  EXPECT_LT(task.num_done, 20000);
}

TEST_P(TaskGroups, ThrowWhatATaskThrows) {
  for (const int threads : {1, 3}) {
    with_threads(threads, [&] {
      for (int again = 0; again < 20; ++again) {
        int ignored = 0;
        group_.start(3, [at = &ignored](std::size_t i) {
          if (i == 1 && at) throw std::out_of_range("1");
        });
        ASSERT_THROW(group_.wait(), std::out_of_range);
        group_.wait();  // it is told once
      }
    });
  }
}

// wait() takes part in what the task has begun, so that it ends by two threads sooner than by one.
TEST_P(TaskGroups, ShareTheLoopsOfTasksWithTheirCaller) {
  bool is_shared = false;
  bool has_threads = true;
  with_threads(2, [&] {
    const std::thread::id caller = std::this_thread::get_id();
    for (int again = 0; again < 50 && !is_shared && has_threads; ++again) {
      struct {
        std::thread::id caller;
        std::atomic<bool> has_begun = false;
        std::atomic<bool> was_caller = false;
      } state;
      state.caller = caller;
      group_.start(1, [&state](std::size_t) {
        parallel_for(20, [&state](std::size_t) {
          state.has_begun = true;
          if (std::this_thread::get_id() == state.caller) state.was_caller = true;
          // MinGW does not sleep for less than a millisecond.
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        });
      });
      has_threads = is_set_by_another(state.has_begun);
      group_.wait();
      is_shared = has_threads && state.was_caller;
    }
  });
  if (!has_threads && !has_own_threads()) GTEST_SKIP() << "oneTBB has no thread to spare";
  EXPECT_TRUE(is_shared);
}

TEST(TaskGroup, ApartOutlivesTheLoopThatStartedIt) {
  TaskGroup group(Place::kApart);
  std::atomic<int> times = 0;
  for (int again = 0; again < 200; ++again) {
    with_threads(3, [&] {
      parallel_for(2, [&](std::size_t i) {
        if (i == 1) group.start(2, [&times](std::size_t) { ++times; });
      });
    });
    group.wait();
  }
  EXPECT_EQ(times, 400);
}

}  // namespace
}  // namespace weft
