#include <weft/core/parallel/threads.hpp>

#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/core/parallel/parallel_for.hpp>

namespace weft {
namespace {

TEST(Threads, AreOnePerProcessorUnlessSaidOtherwise) {
  EXPECT_GE(num_threads(), 1);
  EXPECT_LE(num_threads(), static_cast<int>(std::thread::hardware_concurrency()));
}

TEST(Threads, AreAsManyAsAskedForUntilTheWorkEnds) {
  const int before = num_threads();
  for (const int asked : {1, 2, 7}) {
    EXPECT_EQ(with_threads(asked, [] { return num_threads(); }), asked);
  }
  with_threads(3, [] {
    EXPECT_EQ(with_threads(2, [] { return num_threads(); }), 2);
    EXPECT_EQ(num_threads(), 3);
  });
  EXPECT_EQ(num_threads(), before);
}

TEST(Threads, AreAsManyInALoopInsideOfALoop) {
  with_threads(3, [] { parallel_for(10, [](std::size_t) { EXPECT_EQ(num_threads(), 3); }); });
}

TEST(Threads, GiveBackWhatTheWorkReturns) {
  const auto seven = with_threads(2, [] { return std::make_unique<int>(7); });
  EXPECT_EQ(*seven, 7);
}

TEST(Threads, LetExceptionsThrough) {
  EXPECT_THROW(with_threads(2, [] { throw InvalidArgument("no"); }), InvalidArgument);
  EXPECT_GE(num_threads(), 1);
}

TEST(Threads, AreAtLeastOne) {
  try {
    with_threads(0, [] {});
    FAIL() << "expected an error";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "with_threads: num_threads = 0, expected >= 1");
  }
}

TEST(Threads, ComeFromTheLibraryThatTheBuildHasChosen) {
  EXPECT_THAT(thread_library(), testing::StartsWith(WEFT_EXPECTED_THREADS));
}

TEST(Threads, ComputeIsolatedWork) {
  int sum = 0;
  isolated([&] { sum = 3; });
  EXPECT_EQ(sum, 3);
}

}  // namespace
}  // namespace weft
