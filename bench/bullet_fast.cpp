#include <algorithm>
#include <memory>

#include <tbb/task_arena.h>

#include "bench/bench.hpp"
#include "bench/bullet_workload.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

/// Steps of the workload that a contender takes before it is another's turn: a multiple of its own.
constexpr int kTurn = 120;

struct Contender {
  std::string solver;
  std::string settings;
  std::unique_ptr<WorkloadRun> run;
  int num_steps = 1;               ///< of the workload that one of its own is long
  std::vector<double> times = {};  ///< [ms] for a step of the workload
  double squared_error = 0.0;      ///< [m^2] sum over its steps
  double last_error = 0.0;         ///< [m]
};

std::vector<Contender> contenders(const Workload& workload) {
  std::vector<Contender> list;
  for (const int iterations : {10, 20, 50}) {
    list.push_back(
        {"bullet", std::to_string(iterations), WorkloadRun::links(workload, iterations, false)});
  }
  for (const int iterations : {10, 50}) {
    list.push_back({"bullet_reordered", std::to_string(iterations),
                    WorkloadRun::links(workload, iterations, true)});
  }
  for (const int iterations : {10, 50}) {
    list.push_back({"bullet_substeps", std::to_string(iterations) + " in 4 steps",
                    WorkloadRun::links(workload, iterations, false, 4)});
  }
  list.push_back({"bullet_forces", std::to_string(workload.reference_steps / 2) + " steps",
                  WorkloadRun::laws(workload, workload.reference_steps / 2)});
  struct Effort {
    int rounds, iterations, num_steps, substeps = 1;
  };
  for (const Effort& e :
       {Effort{1, 1, 1}, {1, 2, 1},    {1, 4, 1},    {1, 6, 1},    {2, 2, 1},   {2, 4, 1},
        {2, 8, 1},       {4, 8, 1},    {8, 16, 1},   {1, 2, 2},    {2, 4, 2},   {1, 2, 3},
        {1, 2, 4},       {2, 4, 4},    {1, 2, 8},    {1, 4, 8},    {1, 2, 12},  {1, 4, 1, 2},
        {1, 4, 1, 3},    {2, 4, 1, 2}, {3, 4, 1, 2}, {2, 3, 1, 3}, {2, 4, 1, 4}}) {
    for (const bool is_second_order : {true, false}) {
      std::string name = std::to_string(e.rounds) + "x" + std::to_string(e.iterations);
      if (e.num_steps > 1) name += " each " + std::to_string(e.num_steps) + " steps";
      if (e.substeps > 1) name += " in " + std::to_string(e.substeps) + " steps";
      list.push_back({is_second_order ? "weft" : "weft_euler", name,
                      WorkloadRun::fast(workload,
                                        {.effort = {e.rounds, e.iterations},
                                         .is_second_order = is_second_order,
                                         .may_sleep = false},
                                        e.substeps),
                      e.num_steps});
    }
  }
  return list;
}

/// As many steps as a contender has numbers to be compared with, in a row: its memory stays in the caches, as it
/// would in a program of its own.
void take_turn(const Workload& workload, const std::vector<Matrix3X<double>>& exact, Contender& c) {
  for (std::size_t end = static_cast<std::size_t>(c.num_steps); end <= exact.size();
       end += static_cast<std::size_t>(c.num_steps)) {
    const double start = processor_time();
    c.run->step(c.num_steps * workload.time_step);
    c.times.push_back((processor_time() - start) / c.num_steps);
    const Matrix3X<double>& x = exact[end - 1];
    c.last_error =
        std::sqrt((c.run->positions() - x).squaredNorm() / static_cast<double>(x.cols()));
    c.squared_error += c.last_error * c.last_error;
  }
}

void measure(const Workload& workload, ResultFile& file) {
  std::vector<Contender> list = contenders(workload);
  const auto reference = WorkloadRun::laws(workload, workload.reference_steps);
  tbb::task_arena arena(1);
  arena.execute([&] {
    for (int done = 0; done < workload.num_steps; done += kTurn) {
      std::vector<Matrix3X<double>> exact;
      for (int step = 0; step < std::min(kTurn, workload.num_steps - done); ++step) {
        reference->step(workload.time_step);
        exact.push_back(reference->positions());
      }
      for (Contender& c : list) take_turn(workload, exact, c);
    }
  });
  const auto is_bullet_50 = [](const Contender& c) {
    return c.solver == "bullet" && c.settings == "50";
  };
  const double bullet = median(std::find_if(list.begin(), list.end(), is_bullet_50)->times);
  for (Contender& c : list) {
    const auto [largest, mean] = c.run->stretch();
    const double time = median(c.times);
    const double error = std::sqrt(c.squared_error / static_cast<double>(c.times.size()));
    file.add({workload.name, c.solver, c.settings, three_digits(time), three_digits(bullet / time),
              three_digits(error), three_digits(c.last_error), three_digits(100 * largest),
              three_digits(100 * mean)});
  }
}

}  // namespace

void bench_fast(const Settings& settings) {
  using Kind = Workload::Kind;
  const Workload workloads[] = {{"hang_50", Kind::kHang, 50, 1.0 / 60, 240, 128},
                                {"classic", Kind::kClassic, 50, 1.0 / 100, 240, 100},
                                {"hang_100", Kind::kHang, 100, 1.0 / 60, 40, 256},
                                {"hang_200", Kind::kHang, 200, 1.0 / 60, 16, 512},
                                {"crowd", Kind::kCrowd, 20, 1.0 / 60, 24, 64},
                                {"ball", Kind::kBall, 8, 1.0 / 60, 48, 128}};
  ResultFile file(
      "work and precision: processor time for one step of the workload (1/60 s; classic: 1/100 s) "
      "on "
      "one thread, and distance to explicit integration of the same springs (1000 N/m) in small "
      "steps, "
      "RMS over nodes and steps",
      {"workload", "solver", "settings", "median_ms", "times_faster_than_bullet_50", "rms_error_m",
       "last_error_m", "max_stretch_percent", "mean_stretch_percent"});
  for (const Workload& workload : workloads) {
    measure(workload, file);
    file.write(settings.folder / (sizeof(btScalar) == 4 ? "fast_float32.csv" : "fast_float64.csv"));
  }
}

}  // namespace weft::bench
