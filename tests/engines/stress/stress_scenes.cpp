// Runs random scenes with every engine, each in a process of its own, and asserts that none of
// them crashes, uses more processor time than its budget, or makes numbers that are not finite
// without saying that it blew up.
//
//   stress_scenes --first 0 --count 1000             seeds 0 to 999, engines by turns
//   stress_scenes --first 17 --count 1 --write FILE  writes the scene of a seed
//   stress_scenes --scene FILE --engine NAME         the same checks of a scene file

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/format/scene_file.hpp>

#include "tests/engines/stress/random_scene.hpp"

namespace weft::scenes::stress {
namespace {

struct Options {
  std::uint64_t first = 0;
  int count = 40;
  int budget = 60;  ///< [s] of processor time per scene
  std::string scene;
  std::string engine;
  std::string write;
  bool is_verbose = false;
};

enum Outcome : int { kFine, kBlewUp, kRefused, kSilent, kBroken, kHung, kCrashed, kNumOutcomes };
constexpr std::array<const char*, kNumOutcomes> kOutcomeNames = {"fine",
                                                                 "blew up and said so",
                                                                 "refused with an error",
                                                                 "NOT FINITE IN SILENCE",
                                                                 "NO ERROR OF WEFT",
                                                                 "OVER BUDGET",
                                                                 "CRASHED"};

struct Result {
  Outcome outcome = kFine;
  std::string text;      ///< what the engine said
  double seconds = 0.0;  ///< of processor time
};

bool is_finite(const SceneState& state) {
  for (const ClothState& cloth : state.cloths) {
    if (!cloth.positions.allFinite() || !cloth.velocities.allFinite()) return false;
  }
  return std::all_of(state.rigids.begin(), state.rigids.end(), [](const RigidState& rigid) {
    return rigid.position.allFinite() && rigid.orientation.coeffs().allFinite() &&
           rigid.velocity.allFinite() && rigid.angular_velocity.allFinite();
  });
}

/// All steps of a scene, as record_run() takes them.
Result run_steps(const Scene& scene, const EngineInfo& engine) {
  const std::unique_ptr<Simulator> simulator = engine.make();
  simulator->load(scene);
  const bool starts_finite = is_finite(simulator->state());
  const auto num_steps = std::lround(scene.world.duration / scene.world.time_step);
  for (long step = 0; step < num_steps; ++step) {
    const StepReport report = simulator->step(scene.world.time_step);
    if (report.blow_up) {
      return {kBlewUp, fmt::format("step {}, {}: {}", report.blow_up->step, report.blow_up->body,
                                   report.blow_up->reason)};
    }
    if (!starts_finite || !is_finite(simulator->state())) {
      return {kSilent, fmt::format("step {}", report.step)};
    }
  }
  return {kFine, ""};
}

Scene scene_of(std::uint64_t seed, const EngineInfo& engine) {
  // Through the reader, which refuses what a scene file must not say.
  return read_scene_text(write_scene(random_scene(seed, engine.name)),
                         fmt::format("seed {}", seed));
}

Result run_here(const Options& options, std::uint64_t seed, const EngineInfo& engine) {
  try {
    return run_steps(
        options.scene.empty() ? scene_of(seed, engine) : read_scene_file(options.scene), engine);
  } catch (const Error& error) {
    return {kRefused, error.what()};
  } catch (const std::exception& error) {
    return {kBroken, error.what()};
  }
}

/// In a child, with its budget. The parent has no threads, so that a plain fork will do.
Result run_in_child(const Options& options, std::uint64_t seed, const EngineInfo& engine) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) throw Error("stress_scenes: no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw Error("stress_scenes: no process");
  if (child == 0) {
    close(pipe_ends[0]);
    const auto seconds = static_cast<rlim_t>(options.budget);
    const rlimit processor{seconds, seconds};
    const rlimit core{0, 0};
    setrlimit(RLIMIT_CPU, &processor);
    setrlimit(RLIMIT_CORE, &core);
    // A process that waits for ever uses no processor time.
    alarm(static_cast<unsigned>(30 * options.budget));
    const Result result = with_threads(1, [&] { return run_here(options, seed, engine); });
    const bool is_written = write(pipe_ends[1], result.text.data(), result.text.size()) >= 0;
    _exit(is_written ? result.outcome : kBroken);
  }
  close(pipe_ends[1]);
  Result result;
  std::array<char, 512> buffer{};
  for (ssize_t size = 0; (size = read(pipe_ends[0], buffer.data(), buffer.size())) > 0;) {
    result.text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  close(pipe_ends[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  result.seconds = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                   1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  if (WIFEXITED(status) && WEXITSTATUS(status) < kHung) {
    result.outcome = static_cast<Outcome>(WEXITSTATUS(status));
    return result;
  }
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const bool is_hung = signal == SIGXCPU || signal == SIGALRM ||
                       (signal == SIGKILL && result.seconds > 0.9 * options.budget);
  result.outcome = is_hung ? kHung : kCrashed;
  result.text = WIFSIGNALED(status) ? fmt::format("signal {}", signal)
                                    : fmt::format("exit status {}", WEXITSTATUS(status));
  return result;
}

const EngineInfo& engine_for(const Options& options, std::uint64_t seed) {
  const auto table = engine_table();
  if (options.engine.empty()) return table[seed % table.size()];
  for (const EngineInfo& engine : table) {
    if (engine.name == options.engine) return engine;
  }
  throw InvalidArgument("--engine " + options.engine + ": no such engine in this program");
}

int run(const Options& options) {
  if (!options.write.empty()) {
    const EngineInfo& engine = engine_for(options, options.first);
    std::ofstream file(options.write);
    file << write_scene(random_scene(options.first, engine.name));
    fmt::print("{}: seed {}, engine {}\n", options.write, options.first, engine.name);
    return file.good() ? 0 : 1;
  }
  std::map<std::string, std::array<int, kNumOutcomes>> counts;
  int num_faults = 0, num_refused = 0;
  double seconds = 0.0, longest = 0.0;
  const int count = options.scene.empty() ? options.count : 1;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t seed = options.first + static_cast<std::uint64_t>(i);
    const EngineInfo& engine = engine_for(options, seed);
    const Result result = run_in_child(options, seed, engine);
    ++counts[std::string(engine.name)][result.outcome];
    seconds += result.seconds;
    longest = std::max(longest, result.seconds);
    num_refused += result.outcome == kRefused ? 1 : 0;
    const bool is_fault = result.outcome >= kSilent;
    num_faults += is_fault ? 1 : 0;
    if (is_fault || options.is_verbose) {
      fmt::print("seed {} {}: {}, {} ({:.2f} s)\n", seed, engine.name,
                 kOutcomeNames[result.outcome], result.text, result.seconds);
    }
  }
  for (const auto& [engine, numbers] : counts) {
    fmt::print("{:26}", engine);
    for (std::size_t o = 0; o < kNumOutcomes; ++o) {
      if (numbers[o] > 0) fmt::print(" {} {};", numbers[o], kOutcomeNames[o]);
    }
    fmt::print("\n");
  }
  fmt::print("{} scenes, {:.1f} s of processor time, the longest {:.2f} s, {} faults\n", count,
             seconds, longest, num_faults);
  // Scenes that are refused test nothing.
  if (count >= 20 && 3 * num_refused > count) {
    fmt::print("{} of {} scenes were refused: the generator is wrong\n", num_refused, count);
    return 1;
  }
  return num_faults == 0 ? 0 : 1;
}

}  // namespace
}  // namespace weft::scenes::stress

int main(int argc, char** argv) {
  weft::scenes::stress::Options options;
  CLI::App parser{"Runs random scenes with every engine and looks for crashes, hangs and NaN"};
  parser.add_option("--first", options.first, "Seed of the first scene");
  parser.add_option("--count", options.count, "How many scenes");
  parser.add_option("--budget", options.budget, "Processor time of a scene [s]");
  parser.add_option("--engine", options.engine, "One engine instead of all by turns");
  parser.add_option("--scene", options.scene, "A scene file instead of random scenes");
  parser.add_option("--write", options.write, "Writes the first scene to a file");
  parser.add_flag("--verbose", options.is_verbose, "One line per scene");
  CLI11_PARSE(parser, argc, argv);
  try {
    return weft::scenes::stress::run(options);
  } catch (const weft::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
