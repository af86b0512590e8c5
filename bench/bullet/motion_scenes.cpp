#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include <fmt/core.h>
#include <tbb/task_arena.h>

#include <weft/core/error.hpp>
#include <weft/engines/bullet/bullet_simulator.hpp>
#include <weft/validation/motion/motion_figures.hpp>
#include <weft/validation/motion/motion_scenes.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

using validation::MotionFigure;
using validation::MotionFrames;
using validation::MotionScene;

const std::filesystem::path kTruthFile = WEFT_SOURCE_DIR "/bench/truth/motion_scenes.csv";

/// The right figures, by "scene,figure".
std::map<std::string, double> read_truths() {
  std::ifstream file(kTruthFile);
  std::map<std::string, double> truths;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    const std::size_t comma = line.rfind(',');
    try {
      truths[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
    } catch (const std::exception&) {
      throw Error(fmt::format("{}: '{}', expected scene,figure,number", kTruthFile.string(), line));
    }
  }
  if (truths.empty()) {
    throw Error(kTruthFile.string() + ": cannot be read; weft-bench scenes_truth makes it");
  }
  return truths;
}

std::string key_of(const MotionScene& motion, const MotionFigure& figure) {
  return motion.scene.name + "," + figure.name;
}

bool is_known(const MotionScene& motion, const std::map<std::string, double>& truths) {
  return std::all_of(motion.figures.begin(), motion.figures.end(), [&](const MotionFigure& figure) {
    return truths.contains(key_of(motion, figure));
  });
}

/// In the order of judged_motions(); rows of scenes that are judged no more are left out.
void write_truths(const std::map<std::string, double>& truths) {
  std::string text =
      "# scene,figure,value: laws integrated explicitly in short steps in Bullet's world "
      "(bullet_forces)\n";
  for (const MotionScene& motion : validation::judged_motions()) {
    for (const MotionFigure& figure : motion.figures) {
      const auto truth = truths.find(key_of(motion, figure));
      if (truth != truths.end()) text += fmt::format("{},{:.6g}\n", truth->first, truth->second);
    }
  }
  std::filesystem::create_directories(kTruthFile.parent_path());
  std::ofstream file(kTruthFile);
  file << text;
  file.close();
  if (!file) throw Error(kTruthFile.string() + ": cannot be written");
}

void add_rows(const MotionScene& motion, const std::map<std::string, double>& truths,
              ResultFile& file) {
  const std::unique_ptr<scenes::Simulator> solver = scenes::make_bullet_weft();
  const double start = processor_time();
  const MotionFrames frames = validation::frames_of(*solver, motion.scene);
  const double steps = motion.scene.world.duration / motion.scene.world.time_step;
  const double per_step = (processor_time() - start) / steps;
  const MotionFrames still = validation::standing_still(motion.scene);
  const MotionFrames free = validation::untouched(motion.scene);
  for (const MotionFigure& figure : motion.figures) {
    const auto right = truths.find(key_of(motion, figure));
    if (right == truths.end() && !figure.is_bound) {
      throw Error(fmt::format("{}: nothing of '{}' in '{}'; weft-bench scenes_truth makes it",
                              kTruthFile.string(), figure.name, motion.scene.name));
    }
    const double truth = figure.is_bound ? 0.0 : right->second;
    const double value = figure.of(motion.scene, frames);
    const bool is_right = figure.deviation(value, truth) <= figure.allowed;
    file.add({motion.scene.name, figure.name, figure.unit, three_digits(value), three_digits(truth),
              three_digits(figure.allowed), is_right ? "yes" : "NO",
              three_digits(figure.of(motion.scene, still)),
              three_digits(figure.of(motion.scene, free)), three_digits(per_step)});
  }
}

}  // namespace

void bench_motion_scenes(const Settings& settings) {
  const std::map<std::string, double> truths = read_truths();
  ResultFile file(
      "scenes in which cloth falls, is hit and carries, with the fast solver's default setting in "
      "steps of 1/60 s: figures "
      "from states, masses and laws, beside explicit integration of the same laws in short steps "
      "or what theory bounds; "
      "predictors that solve nothing: all stays where it starts, and nothing meets anything",
      {"scene", "figure", "unit", "measured", "right", "allowed", "is_right", "frozen", "untouched",
       "mean_ms"});
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (const MotionScene& motion : validation::judged_motions()) add_rows(motion, truths, file);
  });
  file.write(settings.folder / "motion_scenes.csv");
}

// Keeps the rows that are there, so that a new scene does not move what solvers were held against before. Each scene is
// written as soon as it is known: some take minutes.
void bench_scenes_truth(const Settings& /*settings*/) {
  std::map<std::string, double> truths;
  if (std::filesystem::exists(kTruthFile)) truths = read_truths();
  for (const MotionScene& motion : validation::judged_motions()) {
    if (is_known(motion, truths)) continue;
    const std::unique_ptr<scenes::Simulator> solver = scenes::make_bullet_forces();
    const scenes::Scene scene =
        validation::with_step(motion.scene, motion.exact_step, motion.scene.world.frame_interval);
    const MotionFrames frames = validation::frames_of(*solver, scene);
    for (const MotionFigure& figure : motion.figures) {
      const double value = figure.of(motion.scene, frames);
      truths[key_of(motion, figure)] = value;
      fmt::print("{},{:.6g}\n", key_of(motion, figure), value);
      std::fflush(stdout);
    }
    write_truths(truths);
  }
}

}  // namespace weft::bench
