#include <weft/recorder/window_process.hpp>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

WindowProcess::WindowProcess(const std::string& program, const std::filesystem::path& recording) {
  std::string words[] = {program, "view", recording.string()};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  const int fault = posix_spawnp(&process_, program.c_str(), nullptr, nullptr, arguments, environ);
  if (fault != 0) {
    throw Error(fmt::format(
        "recorder: window_program = '{}': {}, expected Weft's command, a path or a name in PATH",
        program, std::strerror(fault)));
  }
}

WindowProcess::~WindowProcess() {
  // One that is closed already must not stay as a zombie.
  if (process_ > 0) (void)waitpid(process_, nullptr, WNOHANG);
}

void WindowProcess::wait() {
  while (process_ > 0 && waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
