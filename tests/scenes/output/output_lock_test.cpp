#include <weft/scenes/output/output_lock.hpp>

#include <sys/wait.h>

#include <array>
#include <csignal>

#include <gmock/gmock.h>

#include <weft/core/error.hpp>

#include "tests/scenes/output/output_samples.hpp"

namespace weft::output {
namespace {

using samples::get;
using samples::message_of;
using samples::put;
using testing::HasSubstr;

class OutputLockTest : public samples::FolderTest {
 protected:
  /// A process that holds the lock until it is killed.
  [[nodiscard]] pid_t hold() const {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      const OutputLock lock(at("x.lock"), at("x"), OutputLock::AtEnd::kRemove);
      const ssize_t told = ::write(ends[1], "h", 1);
      ::pause();
      ::_exit(told == 1 ? 0 : 1);
    }
    char held = 0;
    EXPECT_EQ(::read(ends[0], &held, 1), 1);
    ::close(ends[0]);
    ::close(ends[1]);
    return child;
  }
  std::string try_lock() const {
    return message_of(
        [&] { const OutputLock lock(at("x.lock"), at("x"), OutputLock::AtEnd::kRemove); });
  }
};

TEST_F(OutputLockTest, HasOneHolderAndEndsWithItsProcess) {
  const pid_t holder = hold();
  EXPECT_THAT(try_lock(), HasSubstr("x: is being written by another run (process " +
                                    std::to_string(holder) + ")"));
  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);
  EXPECT_EQ(num_files(), 1);  // left by the kill, and in nobody's way
  EXPECT_EQ(try_lock(), "nothing was thrown");
  EXPECT_EQ(num_files(), 0);
}

TEST_F(OutputLockTest, TwiceInOneProcessNamesTheMistake) {
  const OutputLock lock(at("x.lock"), at("x"), OutputLock::AtEnd::kRemove);
  EXPECT_THAT(try_lock(), HasSubstr("named for two outputs"));
}

TEST_F(OutputLockTest, AnotherFileOfItsNameIsNotTouched) {
  put(at("x.lock"), "my notes");
  EXPECT_THAT(try_lock(), HasSubstr("x.lock: exists and is not a lock"));
  EXPECT_EQ(get(at("x.lock")), "my notes");
  std::filesystem::remove(at("x.lock"));
  put(at("target"), "");
  std::filesystem::create_symlink("target", at("x.lock"));
  EXPECT_THAT(try_lock(), HasSubstr("x.lock: exists and is not a lock"));
  EXPECT_EQ(get(at("target")), "");
}

}  // namespace
}  // namespace weft::output
