#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <weft/core/parallel/threads.hpp>

namespace weft {
namespace {

// A program that uses oneTBB itself says with its own arena how many threads Weft has.
TEST(TbbThreads, AreThoseOfTheProgramsArena) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 5);
  tbb::task_arena arena(5);
  EXPECT_EQ(arena.execute([] { return num_threads(); }), 5);
}

}  // namespace
}  // namespace weft
