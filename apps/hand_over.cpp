#include "apps/hand_over.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <weft/core/error.hpp>

namespace weft::app {
namespace {

/// Environment variable: the number of the process that has become another executable.
constexpr const char* kHandedOver = "WEFT_HANDED_OVER";

}  // namespace

std::filesystem::path executable_for(const CommandLine& command_line,
                                     scenes::StoredPrecision precision) {
  const char* name = precision == scenes::StoredPrecision::kFloat32 ? "weft" : "weft-float64";
  return command_line.executable.parent_path() / name;
}

void hand_over(const CommandLine& command_line, scenes::StoredPrecision precision) {
  const std::filesystem::path other = executable_for(command_line, precision);
  if (other == command_line.executable) {
    throw Error("run: this program was built without Bullet, expected --engine reference");
  }
  // The process keeps its number: what has this one was started by the lines below, and must not do
  // the same again.
  const std::string self = std::to_string(getpid());
  const char* before = std::getenv(kHandedOver);
  if (before != nullptr && before == self) {
    throw Error(other.string() +
                ": is the same program under another name, expected that for Bullet's "
                "other precision");
  }
  setenv(kHandedOver, self.c_str(), 1);
  std::vector<std::string> words = command_line.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  execv(other.c_str(), arguments.data());
  throw Error(other.string() + ": cannot be started (" + std::strerror(errno) +
              "), expected the program for Bullet's other precision beside " +
              command_line.executable.string());
}

}  // namespace weft::app
