#include <weft/validation/run/engine_runs.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include <weft/custom_forces/core/error.hpp>
#include <weft/scenes/scene_file.hpp>

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
  const std::filesystem::path scene = with_suffix(folder_, run.request.label, ".toml");
  std::ofstream file(scene);
  file << scenes::write_scene(run.request.scene);
  file.close();
  if (!file) throw Error(scene.string() + ": cannot be written");

  std::vector<std::string> words = command(run);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const std::string log = with_suffix(folder_, run.request.label, ".log").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, weft_.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw Error(weft_.string() + ": cannot be started (" + std::strerror(error) + ")");
  }
  return process;
}

void EngineRuns::finish(Run& run, int wait_status) const {
  const std::string& label = run.request.label;
  run.outcome.exit_code =
      WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : 128 + WTERMSIG(wait_status);
  run.outcome.log = read_text(with_suffix(folder_, label, ".log"));
  run.outcome.engine_seconds = engine_seconds(run.outcome.log);
  run.outcome.recording = with_suffix(folder_, label, ".weftrec");
  run.done = true;
}

void EngineRuns::run_all(
    const std::function<void(double fraction, const std::string& label)>& progress) {
  Children running;
  std::size_t next = 0;
  std::size_t num_done = 0;
  const auto start_next = [&] {
    while (next < runs_.size() && runs_[next].done) ++next, ++num_done;
    if (next < runs_.size()) running.add(start(runs_[next]), next), ++next;
  };
  for (int job = 0; job < jobs_; ++job) start_next();
  while (!running.empty()) {
    const auto [process, status] = wait_for_one(running.processes());
    Run& run = runs_[running.remove(process)];
    finish(run, status);
    ++num_done;
    progress(static_cast<double>(num_done) / static_cast<double>(runs_.size()), run.request.label);
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
