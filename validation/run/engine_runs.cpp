#include <weft/validation/run/engine_runs.hpp>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/output/output_folder.hpp>

namespace weft::validation {
namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// From "1.00 s simulated in 0.0123 s".
std::optional<double> engine_seconds(const std::string& log) {
  static constexpr std::string_view kBefore = " s simulated in ";
  const std::size_t at = log.find(kBefore);
  if (at == std::string::npos) return std::nullopt;
  std::istringstream text(log.substr(at + kBefore.size()));
  double seconds = 0.0;
  if (!(text >> seconds)) return std::nullopt;
  return seconds;
}

/// From a line "3 of 200 steps not solved to the tolerance; ...".
std::optional<double> unsolved_share(const std::string& log) {
  const std::size_t end = log.find(" steps not solved to the tolerance");
  if (end == std::string::npos) return std::nullopt;
  const std::size_t before = log.rfind('\n', end);
  std::istringstream line(log.substr(before == std::string::npos ? 0 : before + 1));
  double unsolved = 0;
  std::string of;
  double all = 0;
  if (!(line >> unsolved >> of >> all) || !(all > 0)) return std::nullopt;
  return unsolved / all;
}

std::filesystem::path with_suffix(const std::filesystem::path& folder, const std::string& label,
                                  const char* suffix) {
  return folder / (label + suffix);
}

/// Processes of ours and which run each one is; what still runs when it goes out of scope is ended.
class Children {
 public:
  Children() = default;
  ~Children() {
    for (const auto& [process, run] : runs_) kill(process, SIGTERM);
    for (const auto& [process, run] : runs_) waitpid(process, nullptr, 0);
  }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  void add(pid_t process, std::size_t run) { runs_[process] = run; }
  [[nodiscard]] std::size_t remove(pid_t process) {
    const std::size_t run = runs_.at(process);
    runs_.erase(process);
    return run;
  }
  [[nodiscard]] bool empty() const { return runs_.empty(); }
  [[nodiscard]] const std::map<pid_t, std::size_t>& processes() const { return runs_; }

 private:
  std::map<pid_t, std::size_t> runs_;
};

/// A file that is closed at the end; a child gets it only by dup2.
struct OpenFile {
  OpenFile(const std::string& path, int flags) : file(open(path.c_str(), flags | O_CLOEXEC)) {
    if (file < 0) throw Error(path + ": cannot be opened (" + std::strerror(errno) + ")");
  }
  ~OpenFile() { close(file); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int file;
};

/// Tells a parent why its child could not become another program; closed without a word if it could.
struct OpenPipe {
  OpenPipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw Error(std::string("engine runs: no pipe (") + std::strerror(errno) + ")");
    }
    read_end = ends[0];
    write_end = ends[1];
  }
  ~OpenPipe() {
    close(read_end);
    if (write_end >= 0) close(write_end);
  }
  OpenPipe(const OpenPipe&) = delete;
  OpenPipe& operator=(const OpenPipe&) = delete;
  int read_reason() {
    close(std::exchange(write_end, -1));
    int reason = 0;
    while (read(read_end, &reason, sizeof reason) < 0 && errno == EINTR) {
    }
    return reason;
  }
  int read_end = -1;
  int write_end = -1;
};

/// In the child after fork(): only calls that are safe there, for this process may have threads. The
/// program ends when its parent ends, however that happens.
[[noreturn]] void become(const char* program, char* const* arguments, const OpenFile& input,
                         const OpenFile& print, int failure, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it ended before the line above
  dup2(input.file, STDIN_FILENO);
  dup2(print.file, STDOUT_FILENO);
  dup2(print.file, STDERR_FILENO);
  execv(program, arguments);
  const int reason = errno;
  const ssize_t told = write(failure, &reason, sizeof reason);
  _exit(told > 0 ? 127 : 126);
}

struct Ended {
  pid_t process;
  int status;
};

/// Asks each process in turn and never "any child": a host program may have children of its own.
Ended wait_for_one(const std::map<pid_t, std::size_t>& processes) {
  for (;;) {
    for (const auto& [process, run] : processes) {
      int status = 0;
      const pid_t ended = waitpid(process, &status, WNOHANG);
      if (ended == process) return {process, status};
      if (ended < 0 && errno != EINTR) {
        throw Error(std::string("engine runs: a process cannot be waited for (") +
                    std::strerror(errno) + ")");
      }
    }
    usleep(5000);  // runs take seconds
  }
}

}  // namespace

EngineRuns::EngineRuns(std::filesystem::path weft, std::filesystem::path folder, int jobs)
    : weft_(std::move(weft)), folder_(std::move(folder)), jobs_(std::max(1, jobs)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw Error(folder_.string() + ": cannot be created (" + error.message() + ")");
}

void EngineRuns::add(const RunRequest& request) {
  const bool known = std::any_of(runs_.begin(), runs_.end(), [&](const Run& run) {
    return run.request.label == request.label;
  });
  if (!known) runs_.push_back({request, {}, false});
}

void EngineRuns::add_recording(const std::string& label, const std::filesystem::path& recording) {
  RunRequest request;
  request.label = label;
  runs_.push_back({request, {.exit_code = 0, .log = "", .recording = recording}, true});
}

std::vector<std::string> EngineRuns::command(const Run& run) const {
  const RunRequest& request = run.request;
  const bool is_single = request.precision == scenes::StoredPrecision::kFloat32;
  return {weft_.string(),
          "run",
          with_suffix(folder_, request.label, ".toml").string(),
          "--engine",
          request.engine,
          "--precision",
          is_single ? "float32" : "float64",
          "--output",
          with_suffix(folder_, request.label, ".weftrec").string(),
          "--force",
          "--threads",
          std::to_string(request.threads)};
}

int EngineRuns::start(const Run& run) const {
  output::replace_file(with_suffix(folder_, run.request.label, ".toml"),
                       scenes::write_scene(run.request.scene));
  const std::string log = with_suffix(folder_, run.request.label, ".log").string();
  output::replace_file(log, "");
  std::vector<std::string> words = command(run);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const OpenFile input("/dev/null", O_RDONLY);
  const OpenFile print(log, O_WRONLY | O_NOFOLLOW);
  OpenPipe failure;
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process == 0)
    become(weft_.c_str(), arguments.data(), input, print, failure.write_end, parent);
  if (process < 0) {
    throw Error(std::string("engine runs: no process can be started (") + std::strerror(errno) +
                ")");
  }
  if (const int reason = failure.read_reason(); reason != 0) {
    waitpid(process, nullptr, 0);
    throw Error(weft_.string() + ": cannot be started (" + std::strerror(reason) + ")");
  }
  return process;
}

void EngineRuns::finish(Run& run, int wait_status) const {
  const std::string& label = run.request.label;
  run.outcome.exit_code =
      WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
  run.outcome.log = read_text(with_suffix(folder_, label, ".log"));
  run.outcome.engine_seconds = engine_seconds(run.outcome.log);
  run.outcome.unsolved_share = unsolved_share(run.outcome.log);
  run.outcome.recording = with_suffix(folder_, label, ".weftrec");
  run.done = true;
}

void EngineRuns::run_all(
    const std::function<void(double fraction, const std::string& label)>& progress) {
  Children running;
  std::size_t next = 0;
  std::size_t num_done = 0;
  const auto num_to_do = static_cast<double>(
      std::count_if(runs_.begin(), runs_.end(), [](const Run& run) { return !run.done; }));
  const auto start_next = [&] {
    while (next < runs_.size() && runs_[next].done) ++next;
    if (next < runs_.size()) running.add(start(runs_[next]), next), ++next;
  };
  for (int job = 0; job < jobs_; ++job) start_next();
  while (!running.empty()) {
    const auto [process, status] = wait_for_one(running.processes());
    Run& run = runs_[running.remove(process)];
    finish(run, status);
    ++num_done;
    progress(static_cast<double>(num_done) / num_to_do, run.request.label);
    start_next();
  }
}

const EngineRuns::Outcome& EngineRuns::outcome(const std::string& label) const {
  for (const Run& run : runs_) {
    if (run.request.label == label && run.done) return run.outcome;
  }
  throw InvalidArgument("engine runs: '" + label + "' was not run");
}

}  // namespace weft::validation
