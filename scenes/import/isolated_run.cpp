#include <weft/scenes/import/isolated_run.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

#include <weft/core/error.hpp>

namespace weft::import {
namespace {

constexpr char kDone = 'd';
constexpr char kFailed = 'f';

/// Address space is no measure of memory for a sanitizer, which reserves terabytes.
constexpr bool has_address_sanitizer() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#elif defined(__has_feature)
  return __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) ||
         __has_feature(memory_sanitizer);
#else
  return false;
#endif
}

void limit(decltype(RLIMIT_CPU) resource, rlim_t value) {
  const rlimit wanted{value, value};
  (void)setrlimit(resource, &wanted);
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;  // the parent is gone
    done += static_cast<std::size_t>(count);
  }
}

/// Address space of this process [bytes]: a child begins with all of its parent's.
rlim_t address_space() {
  std::ifstream statistics("/proc/self/statm");
  rlim_t pages = 0;
  statistics >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void run_child(int file, const std::function<std::string()>& work,
                            const IsolationBudget& budget) {
  // A crash ends the child and is the parent's to report: handlers of the program (crash reporters) are not for it.
  for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(fatal, SIG_DFL);
  limit(RLIMIT_CPU, budget.seconds);
  limit(RLIMIT_CORE, 0);
  if (!has_address_sanitizer()) limit(RLIMIT_AS, address_space() + budget.bytes);
  std::string answer;
  try {
    answer = kDone + work();
  } catch (const std::bad_alloc&) {
    answer = std::string(1, kFailed) + "needs too much memory";
  } catch (const std::exception& error) {
    answer = kFailed + std::string(error.what());
  } catch (...) {
    answer = std::string(1, kFailed) + "fails for an unknown reason";
  }
  write_all(file, answer);
  // Without destructors and exit handlers: they belong to the parent.
  _exit(0);
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 1U << 16U> buffer{};
  while (true) {
    const ssize_t count = read(file, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

/// Why the child has ended without an answer.
std::string describe(int status, const IsolationBudget& budget) {
  if (!WIFSIGNALED(status)) return "ends without an answer";
  if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) {
    return "takes more than " + std::to_string(budget.seconds) + " s";
  }
  return "crashes (" + std::string(strsignal(WTERMSIG(status))) + ")";
}

}  // namespace

std::string run_isolated(const std::function<std::string()>& work, const IsolationBudget& budget) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw Error("cannot make a pipe: " + std::string(strerror(errno)));
  const pid_t child = fork();
  if (child < 0) {
    const std::string reason = strerror(errno);
    close(ends[0]);
    close(ends[1]);
    throw Error("cannot start a process: " + reason);
  }
  if (child == 0) {
    close(ends[0]);
    run_child(ends[1], work, budget);
  }
  close(ends[1]);
  const std::string answer = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool has_ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!has_ended || answer.empty()) throw Error(describe(status, budget));
  if (answer[0] != kDone) throw Error(answer.substr(1));
  return answer.substr(1);
}

}  // namespace weft::import
