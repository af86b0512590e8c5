// Measures Weft against the floor of the processor and against Bullet; results as CSV files.
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include <fmt/core.h>
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include "bench/bench.hpp"
#include "bench/laws/floor_kernel.hpp"

namespace {

int run(int argc, char** argv) {
  using namespace weft::bench;
  std::map<std::string, std::function<void(const Settings&)>> benches = {
      {"laws", bench_laws}, {"grain", bench_grain}, {"frame", bench_frame}};
#ifdef WEFT_WITH_BULLET
  benches["bullet"] = bench_bullet;
  benches["fast"] = bench_fast;
  benches["drape"] = bench_drape;
  benches["motion"] = bench_motion;
  benches["motion_scenes"] = bench_motion_scenes;
  benches["motion_rest"] = bench_motion_rest;
  benches["scenes_truth"] = bench_scenes_truth;
  benches["swing_truth"] = bench_swing_truth;
  benches["scaling"] = bench_scaling;
  benches["tear"] = bench_tear;
  benches["threads"] = bench_threads;
  benches["explosions"] = bench_explosions;
  benches["detail"] = bench_detail;
  benches["snapshot"] = bench_snapshot;
  benches["setup"] = bench_setup;
  benches["self_contact"] = bench_self_contact;
  benches["playback"] = bench_playback;
#endif
  Settings settings{.folder = WEFT_SOURCE_DIR "/bench/results"};
  std::vector<std::string> names;
  CLI::App parser("weft-bench: nanoseconds per spring, and what they compare with");
  std::vector<std::string> known;
  for (const auto& [name, bench] : benches) known.push_back(name);
  parser.add_option("NAME", names, "Which benches (default: all but those that make truths)")
      ->check(CLI::IsMember(known));
  parser.add_option("-o,--output", settings.folder, "Folder for the CSV files")
      ->capture_default_str();
  parser.add_option("-r,--rounds", settings.num_rounds, "How often each contender has its turn")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  CLI11_PARSE(parser, argc, argv);
  if (!has_avx2_and_fma()) {
    fmt::print(stderr, "weft-bench: the floor needs a processor with AVX2 and FMA\n");
    return 2;
  }
  // Two threads also on a machine of one core: the ratio then says so.
  const tbb::global_control allowed(
      tbb::global_control::max_allowed_parallelism,
      std::max<std::size_t>(
          2, tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
  std::filesystem::create_directories(settings.folder);
  // Not what makes truths: they are to be the same before and after a change.
  std::vector<std::string> chosen = names.empty() ? known : names;
  if (names.empty())
    std::erase_if(chosen, [](const auto& name) { return name.ends_with("_truth"); });
  for (const std::string& name : chosen) {
    fmt::print("== {}\n", name);
    benches.at(name)(settings);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "weft-bench: {}\n", error.what());
    return 2;
  }
}
