#include <weft/core/parallel/thread_pool.hpp>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/threads.hpp>

namespace weft {
namespace {

int sum_of_indices() {
  std::atomic<int> sum = 0;
  parallel_for(100, [&](std::size_t i) { sum += static_cast<int>(i); });
  return sum;
}

// Its threads are not copied by fork(). The second process has loops, and ends, as any other.
TEST(ThreadPool, StartsAnewInAForkedProcess) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer allows no thread in a forked process";
#endif
  EXPECT_EQ(with_threads(3, sum_of_indices), 4950);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) std::exit(with_threads(3, sum_of_indices) == 4950 ? 0 : 1);
  int status = -1;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, WNOHANG)) == 0 &&
         std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (ended == 0) kill(child, SIGKILL);
  ASSERT_EQ(ended, child) << "it does not end";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(ThreadPool, KnowsWhichJobIsInsideWhich) {
  pool::Arena arena;
  const auto nothing = [](std::size_t) {};
  pool::Job outer(1, IndexWork(nothing), arena, nullptr);
  pool::Job inner(1, IndexWork(nothing), arena, &outer);
  const pool::Job other(1, IndexWork(nothing), arena, nullptr);
  EXPECT_TRUE(inner.is_inside(outer));
  EXPECT_TRUE(outer.is_inside(outer));
  EXPECT_FALSE(outer.is_inside(inner));
  EXPECT_FALSE(inner.is_inside(other));
  outer.is_stopped = true;
  EXPECT_TRUE(inner.is_cancelled());
  EXPECT_FALSE(other.is_cancelled());
}

}  // namespace
}  // namespace weft
