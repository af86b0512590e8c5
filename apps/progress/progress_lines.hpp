#pragma once

#include <chrono>
#include <string>

namespace weft::app {

/// Progress for a log file or a pipe: a line for each thing that is done, with their number and the
/// time since the start, on standard error. Written at once. Silent on a terminal, which has
/// ProgressBar.
class ProgressLines {
 public:
  ProgressLines();

  /// number: how many are done, of total. E.g. "case 3 of 21: hang (42 s)".
  void done(const std::string& kind, int number, int total, const std::string& name) const;

 private:
  using Clock = std::chrono::steady_clock;
  bool is_terminal_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace weft::app
