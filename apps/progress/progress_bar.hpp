#pragma once

#include <chrono>
#include <string>

namespace weft::app {

/// A one-line progress bar with the time that is left, on standard error. Silent unless that is a
/// terminal.
class ProgressBar {
 public:
  /// Draws at once: what is done before the first update() may take minutes.
  explicit ProgressBar(const std::string& label);
  ~ProgressBar();  ///< clears the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// fraction: 0 to 1. Redraws at most ten times a second.
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool is_terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_draw_{};
};

}  // namespace weft::app
