#include "apps/progress/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "apps/terminal.hpp"

namespace weft::app {
namespace {

constexpr int kWidth = 30;  ///< characters

}  // namespace

ProgressBar::ProgressBar(const std::string& label)
    : label_(printable(label)), is_terminal_(isatty(STDERR_FILENO) == 1) {
  update(0.0);
}

ProgressBar::~ProgressBar() {
  if (is_terminal_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressBar::update(double fraction) {
  if (!is_terminal_) return;
  const auto now = Clock::now();
  if (now - last_draw_ < std::chrono::milliseconds(100)) return;
  last_draw_ = now;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const int filled = static_cast<int>(std::lround(fraction * kWidth));
  const std::string left = fraction > 0.02
                               ? fmt::format("{:.0f} s left", elapsed * (1 - fraction) / fraction)
                               : std::string("...");
  fmt::print(stderr, "\r{} [{:=<{}}{:<{}}] {:3.0f} %  {}\x1b[K", label_, "", filled, "",
             kWidth - filled, 100 * fraction, left);
  std::fflush(stderr);
}

}  // namespace weft::app
