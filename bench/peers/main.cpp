// Holds Weft against the cloth of other engines, in one process and in turns; results as a CSV file.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "bench/peers/peers.hpp"

namespace {

using namespace weft::bench;

int run(int argc, char** argv) {
  using Kind = Workload::Kind;
  const std::vector<Workload> workloads = {
      {"hang_50", Kind::kHang, 50, 1e3, 1.0 / 60, 60, 64, 128},
      {"hang_50_stiff", Kind::kHang, 50, 1e5, 1.0 / 60, 60, 640, 1000},
      {"hang_100", Kind::kHang, 100, 1e3, 1.0 / 60, 60, 128, 256},
      {"hang_200", Kind::kHang, 200, 1e3, 1.0 / 60, 18, 256, 512},
      {"classic", Kind::kClassic, 50, 1e3, 1.0 / 100, 240, 50, 0},
      {"crowd", Kind::kCrowd, 20, 100, 1.0 / 60, 24, 32, 64},
      {"crumple", Kind::kCrumple, 20, 100, 1.0 / 60, 36, 32, 64},
      {"ball", Kind::kBall, 8, 1e3, 1.0 / 60, 48, 64, 128}};
  std::vector<std::string> names;
  std::vector<std::string> known;
  for (const Workload& workload : workloads) known.push_back(workload.name);
  std::filesystem::path folder = WEFT_SOURCE_DIR "/bench/results";
  CLI::App parser("weft-bench-peers: Weft beside the cloth of other engines");
  parser.add_option("NAME", names, "Which workloads (default: all)")->check(CLI::IsMember(known));
  parser.add_option("-o,--output", folder, "Folder for peers.csv")->capture_default_str();
  CLI11_PARSE(parser, argc, argv);
  ResultFile file = work_precision_table(
      "Weft beside other engines in one process and on one thread: processor time for one step of "
      "the workload, and distance to explicit integration of the same springs in small steps, RMS "
      "over nodes and steps, and kinetic energy over its");
  std::filesystem::create_directories(folder);
  for (const Workload& workload : workloads) {
    if (!names.empty() && std::find(names.begin(), names.end(), workload.name) == names.end()) {
      continue;
    }
    fmt::print("== {}\n", workload.name);
    std::vector<Candidate> list = bullet_candidates(workload);
    const auto append = [&](std::vector<Candidate> more) {
      for (Candidate& one : more) list.push_back(std::move(one));
    };
    append(weft_candidates(workload));
#ifdef WEFT_WITH_NVCLOTH
    append(nvcloth_candidates(workload));
#endif
#ifdef WEFT_WITH_JOLT
    append(jolt_candidates(workload));
#endif
    measure(workload, std::move(list), file);
    file.write(folder / "peers.csv");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "weft-bench-peers: {}\n", error.what());
    return 2;
  }
}
