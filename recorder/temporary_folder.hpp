#pragma once

// Tested by tests/recorder/back_end_test.cpp.

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include <weft/core/error.hpp>

namespace weft::recorder {

/// A folder of its own below the system's for temporary files, which goes away with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / "weft-recorder-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) {
      throw Error("recorder: no temporary folder " + name + ": " + std::strerror(errno));
    }
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;  // nobody can be told
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace weft::recorder
