#include "bench/bullet/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/task_arena.h>

#include <weft/validation/motion/swing.hpp>

#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

/// Steps of the workload that a candidate takes before it is another's turn: a multiple of its own.
constexpr int kTurn = 120;

/// Masses of a workload's nodes are alike, so that squares of speeds stand for kinetic energy.
void compare(const Matrix3X<double>& x, const Matrix3X<double>& exact,
             const Matrix3X<double>& exact_before, double time_step, Candidate& c) {
  c.last_error = std::sqrt((x - exact).squaredNorm() / static_cast<double>(x.cols()));
  c.squared_error += c.last_error * c.last_error;
  c.exact_speeds += ((exact - exact_before) / time_step).squaredNorm();
  c.speeds += ((x - c.last_places) / time_step).squaredNorm();
  c.last_places = x;
}

/// A predictor takes no solver: places stay as they are at the start, and a hanging sheet is a rigid plate, or at rest.
struct Predictor {
  std::string name;
  validation::Places places;
};

std::vector<Predictor> predictors(const Workload& workload, const Matrix3X<double>& start) {
  const int n = workload.num_steps;
  std::vector<Predictor> list = {
      {"stays at its start", validation::Places(static_cast<std::size_t>(n) + 1, start)}};
  if (workload.kind == Workload::Kind::kHang) {
    const ClothMesh mesh = meshes_of(workload)[0];
    list.push_back({"rigid plate", validation::rigid_plate(mesh, workload.time_step, n)});
    list.push_back({"hangs flat and still", validation::hanging_flat(mesh, n)});
  }
  return list;
}

/// As many steps as a candidate has numbers to be compared with, in a row: its memory stays in the caches, as it
/// would in a program of its own.
void take_turn(const Workload& workload, const validation::Places& exact, int begin, int end,
               Candidate& c) {
  for (int step = begin + c.num_steps; step <= end; step += c.num_steps) {
    const double start = processor_time();
    c.run->step(c.num_steps * workload.time_step);
    c.times.push_back((processor_time() - start) / c.num_steps);
    if (exact.empty()) continue;
    const auto now = static_cast<std::size_t>(step);
    compare(c.run->positions(), exact[now], exact[now - static_cast<std::size_t>(c.num_steps)],
            c.num_steps * workload.time_step, c);
  }
}

/// Empty without a reference.
validation::Places reference_run(const Workload& workload) {
  if (workload.reference_steps == 0) return {};
  const auto reference = BulletRun::laws(workload, workload.reference_steps);
  validation::Places exact = {reference->positions()};
  for (int step = 0; step < workload.num_steps; ++step) {
    reference->step(workload.time_step);
    exact.push_back(reference->positions());
  }
  return exact;
}

/// time: median of a step [ms], none for a predictor. errors: how many are summed up.
void add_row(const Workload& workload, Candidate& c, double bullet, std::size_t errors,
             ResultFile& file) {
  const double error = std::sqrt(c.squared_error / static_cast<double>(errors));
  const double time = c.run ? median(c.times) : 0;
  const auto [largest, mean] = c.run ? c.run->stretch() : std::pair(0.0, 0.0);
  const auto if_run = [&](double value) { return c.run ? three_digits(value) : std::string("-"); };
  const auto if_compared = [&](double value) {
    return c.exact_speeds > 0 ? three_digits(value) : std::string("-");
  };
  file.add({workload.name, c.solver, c.settings, if_run(time), if_run(bullet / time),
            if_compared(error), if_compared(c.last_error), if_compared(c.speeds / c.exact_speeds),
            if_run(100 * largest), if_run(100 * mean)});
}

}  // namespace

std::vector<Candidate> bullet_candidates(const Workload& workload) {
  std::vector<Candidate> list;
  for (const int iterations : {10, 20, 50}) {
    list.push_back(
        {"bullet", std::to_string(iterations), BulletRun::links(workload, iterations, false)});
  }
  for (const int iterations : {10, 50}) {
    list.push_back({"bullet_reordered", std::to_string(iterations),
                    BulletRun::links(workload, iterations, true)});
  }
  for (const int iterations : {10, 50}) {
    list.push_back({"bullet_substeps", std::to_string(iterations) + " in 4 steps",
                    BulletRun::links(workload, iterations, false, 4)});
  }
  list.push_back({"bullet_forces", std::to_string(workload.explicit_steps) + " steps",
                  BulletRun::laws(workload, workload.explicit_steps)});
  return list;
}

std::vector<Candidate> weft_candidates(const Workload& workload) {
  std::vector<Candidate> list;
  struct Setting {
    std::string name;
    fast::SolverSettings solver = {};
    int num_steps = 1;
    int substeps = 1;
    bool is_second_order = true;
  };
  const Setting settings[] = {{"default"},
                              {"default with implicit Euler", {}, 1, 1, false},
                              {"tolerance 0.03", {.tolerance = 0.03}},
                              {"tolerance 0.01", {.tolerance = 0.01}},
                              {"tolerance 0.003", {.tolerance = 0.003}},
                              {"tolerance 0.0001", {.newton_iterations = 200, .tolerance = 1e-4}},
                              {"at most 1 x 4", {.newton_iterations = 1, .linear_iterations = 4}},
                              {"at most 2 x 4", {.newton_iterations = 2, .linear_iterations = 4}},
                              {"at most 4 x 8", {.newton_iterations = 4, .linear_iterations = 8}},
                              {"default each 2 steps", {}, 2},
                              {"default each 4 steps", {}, 4},
                              {"default in 2 steps", {}, 1, 2},
                              {"default in 4 steps", {}, 1, 4}};
  for (const Setting& one : settings) {
    list.push_back(
        {"weft", one.name,
         BulletRun::fast(
             workload,
             {.solver = one.solver, .is_second_order = one.is_second_order, .may_sleep = false},
             one.substeps),
         one.num_steps});
  }
  return list;
}

ResultFile work_precision_table(const std::string& title) {
  return ResultFile(title, {"workload", "solver", "settings", "median_ms",
                            "times_faster_than_bullet_50", "rms_error_m", "last_error_m",
                            "kinetic_energy_ratio", "max_stretch_percent", "mean_stretch_percent"});
}

void measure(const Workload& workload, std::vector<Candidate> list, ResultFile& file) {
  validation::Places exact;
  tbb::task_arena arena(1);
  arena.execute([&] {
    exact = reference_run(workload);
    for (Candidate& c : list) c.last_places = c.run->positions();
    for (int begin = 0; begin < workload.num_steps; begin += kTurn) {
      const int end = std::min(begin + kTurn, workload.num_steps);
      for (Candidate& c : list) take_turn(workload, exact, begin, end, c);
    }
  });
  const auto is_bullet_50 = [](const Candidate& c) {
    return c.solver == "bullet" && c.settings == "50";
  };
  const double bullet = median(std::find_if(list.begin(), list.end(), is_bullet_50)->times);
  for (Candidate& c : list) add_row(workload, c, bullet, c.times.size(), file);
  if (exact.empty()) return;
  for (const Predictor& predictor : predictors(workload, exact[0])) {
    Candidate c{"predictor", predictor.name, nullptr};
    c.last_places = predictor.places[0];
    for (std::size_t step = 1; step < exact.size(); ++step) {
      compare(predictor.places[step], exact[step], exact[step - 1], workload.time_step, c);
    }
    add_row(workload, c, bullet, exact.size() - 1, file);
  }
}

}  // namespace weft::bench
