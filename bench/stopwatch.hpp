#pragma once

#include <functional>
#include <string>
#include <vector>

namespace weft::bench {

/// Something to be timed.
struct Contender {
  std::string name;
  int num_threads = 1;      ///< it runs in a task arena of so many
  double num_elements = 1;  ///< what one call works through
  std::function<void()> call;
};

/// Times of one call [s].
struct Timing {
  double median;
  double minimum;
};

/// Times all contenders turn by turn, so that a neighbor on the machine disturbs them alike: in
/// each of num_rounds rounds each contender is called until about 2 ms have passed.
[[nodiscard]] std::vector<Timing> race(const std::vector<Contender>& contenders, int num_rounds);

/// Processor time of this thread [ms]: what else runs on the machine, and a limit on real-time threads, do not count.
[[nodiscard]] double processor_time();
/// Likewise, of one call [ms].
[[nodiscard]] double processor_time(const std::function<void()>& call);

/// Median of values; they are reordered.
[[nodiscard]] double median(std::vector<double>& values);

}  // namespace weft::bench
