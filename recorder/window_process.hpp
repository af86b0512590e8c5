#pragma once

// Tested by tests/recorder/back_end_test.cpp.

#include <sys/types.h>

#include <filesystem>
#include <string>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// `weft view` beside the program that records: it follows the recording while that grows.
class WindowProcess {
 public:
  /// program: Weft's command, a path or a name in PATH. Throws Error if it cannot be started.
  WindowProcess(const std::string& program, const std::filesystem::path& recording);
  WindowProcess(const WindowProcess&) = delete;
  WindowProcess& operator=(const WindowProcess&) = delete;
  /// The window stays.
  ~WindowProcess();

  /// Until the window is closed.
  void wait();

 private:
  pid_t process_ = 0;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
