#include <weft/core/trace.hpp>

#include <algorithm>
#include <memory>
#include <mutex>
#include <ostream>
#include <utility>

namespace weft {
namespace {

/// Filled by one thread and emptied by the one that stops the trace; its lock is almost always
/// free.
struct Buffer {
  std::mutex mutex;
  std::string name;
  std::vector<TraceEvent> events;
};

struct Recorder {
  std::mutex mutex;
  detail::TraceClock::time_point start;
  std::vector<std::shared_ptr<Buffer>> buffers;  ///< in the order in which threads came
};

Recorder& recorder() {
  static Recorder instance;
  return instance;
}

Buffer& buffer_of_this_thread() {
  thread_local std::shared_ptr<Buffer> buffer;
  if (!buffer) {
    buffer = std::make_shared<Buffer>();
    const std::lock_guard lock(recorder().mutex);
    recorder().buffers.push_back(buffer);
  }
  return *buffer;
}

long long nanoseconds(detail::TraceClock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

void write_text(std::string_view text, std::ostream& out) {
  constexpr char kDigits[] = "0123456789abcdef";
  out << '"';
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out << '\\' << c;
    } else if (code < 0x20) {
      out << "\\u00" << kDigits[code / 16] << kDigits[code % 16];
    } else {
      out << c;
    }
  }
  out << '"';
}

/// Microseconds with three decimals, without rounding through floating point.
void write_microseconds(long long nanoseconds, std::ostream& out) {
  const long long rest = nanoseconds % 1000;
  out << nanoseconds / 1000 << '.' << rest / 100 << rest / 10 % 10 << rest % 10;
}

}  // namespace

void start_trace() {
  const std::lock_guard lock(recorder().mutex);
  auto& buffers = recorder().buffers;
  // Threads that have ended left the recorder as the only owner.
  buffers.erase(std::remove_if(buffers.begin(), buffers.end(),
                               [](const auto& buffer) { return buffer.use_count() == 1; }),
                buffers.end());
  for (const auto& buffer : buffers) {
    const std::lock_guard buffer_lock(buffer->mutex);
    buffer->events.clear();
  }
  recorder().start = detail::TraceClock::now();
  detail::is_tracing = true;
}

std::vector<TraceThread> stop_trace() {
  detail::is_tracing = false;
  const std::lock_guard lock(recorder().mutex);
  std::vector<TraceThread> threads;
  int num_workers = 0;
  for (const auto& buffer : recorder().buffers) {
    const std::lock_guard buffer_lock(buffer->mutex);
    if (buffer->events.empty()) continue;
    std::string name = buffer->name;
    if (name.empty()) name = "worker " + std::to_string(++num_workers);
    threads.push_back({std::move(name), std::exchange(buffer->events, {})});
  }
  return threads;
}

void name_trace_thread(std::string name) {
  Buffer& buffer = buffer_of_this_thread();
  const std::lock_guard lock(buffer.mutex);
  buffer.name = std::move(name);
}

void detail::record_trace_event(std::string_view name, TraceClock::time_point begin,
                                TraceClock::time_point end) {
  Buffer& buffer = buffer_of_this_thread();
  TraceClock::time_point start;
  {
    const std::lock_guard lock(recorder().mutex);
    start = recorder().start;
  }
  if (begin < start) return;  // from before the trace
  const std::lock_guard lock(buffer.mutex);
  buffer.events.push_back({name, nanoseconds(begin - start), nanoseconds(end - start)});
}

void write_chrome_trace(const std::vector<TraceThread>& threads, std::ostream& out) {
  out << "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [";
  const char* separator = "\n";
  for (std::size_t t = 0; t < threads.size(); ++t) {
    out << std::exchange(separator, ",\n") << R"({"ph": "M", "pid": 1, "tid": )" << t
        << R"(, "name": "thread_name", "args": {"name": )";
    write_text(threads[t].name, out);
    out << "}}";
    for (const TraceEvent& event : threads[t].events) {
      out << separator << R"({"ph": "X", "pid": 1, "tid": )" << t << R"(, "name": )";
      write_text(event.name, out);
      out << ", \"ts\": ";
      write_microseconds(event.begin, out);
      out << ", \"dur\": ";
      write_microseconds(event.end - event.begin, out);
      out << '}';
    }
  }
  out << "\n]}\n";
}

}  // namespace weft
