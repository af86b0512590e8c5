#include "apps/provenance.hpp"

#include <fstream>
#include <thread>

#include <fmt/core.h>
#include <Eigen/Core>

#include <weft/core/parallel/threads.hpp>
#include <weft/engines/engine_table.hpp>

namespace weft::app {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string compiler_name() {
#ifdef __clang__
  return fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

}  // namespace

scenes::Provenance build_provenance() {
  return {
      {"weft", WEFT_VERSION},
      {"revision", WEFT_REVISION},
      {"compiler", compiler_name()},
      {"flags", WEFT_FLAGS},
      {"bullet", scenes::bullet_description()},
      {"eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"thread_library", thread_library()},
      {"processor", processor_name()},
      {"hardware_threads", std::to_string(std::thread::hardware_concurrency())},
  };
}

}  // namespace weft::app
