#pragma once

// Tested by tests/custom_forces/trace_test.cpp.

#include <atomic>
#include <chrono>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace weft {

/// A record of which thread did what when. Off unless started; then a TraceScope costs one relaxed
/// load of an atomic flag. Times are of the wall clock: they go into a trace and nowhere else.
///
///   start_trace();
///   ...                                    // TraceScope scope("tension"); here and there
///   write_chrome_trace(stop_trace(), file);

/// One stretch of work, [begin, end) in nanoseconds since start_trace().
struct TraceEvent {
  std::string_view name;
  long long begin;
  long long end;
};

/// What one thread did, in the order in which it finished.
struct TraceThread {
  std::string name;
  std::vector<TraceEvent> events;
};

/// Forgets what was recorded and records from now on.
void start_trace();

/// Stops and hands over what was recorded, one entry per thread that recorded anything.
[[nodiscard]] std::vector<TraceThread> stop_trace();

/// Name of the calling thread in traces; a thread without one is called "worker 1", "worker 2", ...
void name_trace_thread(std::string name);

/// Writes Chrome's trace event format (JSON), which chrome://tracing and ui.perfetto.dev open.
void write_chrome_trace(const std::vector<TraceThread>& threads, std::ostream& out);

namespace detail {
inline std::atomic<bool> is_tracing{false};
using TraceClock = std::chrono::steady_clock;
void record_trace_event(std::string_view name, TraceClock::time_point begin,
                        TraceClock::time_point end);
}  // namespace detail

/// Records the time from its construction to its destruction. name must live until the trace is
/// written; a literal does.
class TraceScope {
 public:
  explicit TraceScope(std::string_view name) {
    if (!detail::is_tracing.load(std::memory_order_relaxed)) return;
    name_ = name;
    begin_ = detail::TraceClock::now();
  }
  ~TraceScope() {
    if (name_.data()) detail::record_trace_event(name_, begin_, detail::TraceClock::now());
  }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  std::string_view name_;  ///< without data: nothing is recorded
  detail::TraceClock::time_point begin_;
};

}  // namespace weft
