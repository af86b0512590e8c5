// The bar of a run, on a terminal of its own.
#include "apps/progress/progress_bar.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace weft::app {
namespace {

/// A terminal that standard error goes to as long as it exists.
class Terminal {
 public:
  Terminal() : master_(posix_openpt(O_RDWR | O_NOCTTY)), saved_(dup(STDERR_FILENO)) {
    EXPECT_GE(master_, 0);
    EXPECT_EQ(grantpt(master_), 0);
    EXPECT_EQ(unlockpt(master_), 0);
    const int slave = open(ptsname(master_), O_RDWR | O_NOCTTY);
    EXPECT_GE(slave, 0);
    std::fflush(stderr);
    EXPECT_GE(dup2(slave, STDERR_FILENO), 0);
    close(slave);
  }
  ~Terminal() {
    std::fflush(stderr);
    dup2(saved_, STDERR_FILENO);
    close(saved_);
    close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// What has been written since the last call.
  [[nodiscard]] std::string shown() const {
    constexpr int kPatience = 1000;  // [ms]
    std::string text;
    pollfd ready{master_, POLLIN, 0};
    while (poll(&ready, 1, text.empty() ? kPatience : 0) == 1) {
      std::array<char, 512> buffer{};
      const ssize_t size = read(master_, buffer.data(), buffer.size());
      if (size <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return text;
  }

 private:
  int master_;
  int saved_;
};

// A scene of a million nodes takes most of a minute before its first step ends.
TEST(ProgressBar, IsThereBeforeTheFirstStep) {
  const Terminal terminal;
  std::string shown;
  std::string left;
  {
    const ProgressBar bar("hang");
    shown = terminal.shown();
  }
  left = terminal.shown();
  EXPECT_NE(shown.find("hang ["), std::string::npos) << shown;
  EXPECT_NE(shown.find("0 %"), std::string::npos) << shown;
  EXPECT_EQ(left, "\r\x1b[K");  // nothing is left of it
}

}  // namespace
}  // namespace weft::app
