#include <algorithm>
#include <memory>

#include <tbb/task_arena.h>

#include "bench/bench.hpp"
#include "bench/bullet_workload.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr double kTime = 4.0;     // [s]
constexpr double kSettled = 2.0;  // [s] from which on stretch is looked at
constexpr int kRuns =
    3;  // with steps that differ a little: a sheet that wrinkles forgets its start
constexpr double kStepShare = 2e-5;  // by which the steps of one run differ from those of the next
constexpr int kTurn = 60;            // steps that a run takes before it is another's turn

struct Effort {
  int rounds;
  int iterations;
};
/// The last one has converged: twice as much changes its stretch by less than a hundredth.
constexpr Effort kEfforts[] = {{1, 2}, {1, 3}, {1, 4}, {1, 6},  {1, 8}, {2, 3},
                               {2, 4}, {2, 6}, {2, 8}, {2, 10}, {4, 8}, {8, 16}};

struct Contender {
  Effort effort;
  double time_step;  ///< [s]
  std::unique_ptr<WorkloadRun> run;
  double time = 0;       ///< simulated [s]
  double largest = 0;    ///< [1] since it has settled
  double sum_means = 0;  ///< [1]
  int num_means = 0;
};

struct Measured {
  std::vector<double> times;  ///< [ms] of each step
  double largest = 0;         ///< mean over runs [1]
  double mean = 0;
};

void take_turn(Contender& c, std::vector<double>& times) {
  for (int step = 0; step < kTurn && c.time < kTime; ++step) {
    const double start = processor_time();
    c.run->step(c.time_step);
    times.push_back(processor_time() - start);
    c.time += c.time_step;
    if (c.time < kSettled) continue;
    const auto [largest, mean] = c.run->stretch();
    c.largest = std::max(c.largest, largest);
    c.sum_means += mean;
    ++c.num_means;
  }
}

/// Measures each effort, all in turns, so that the machine is the same for all.
std::vector<Measured> measured(const Workload& workload) {
  std::vector<Measured> results(std::size(kEfforts));
  std::vector<std::vector<Contender>> runs(results.size());
  for (std::size_t e = 0; e < runs.size(); ++e) {
    const Effort& effort = kEfforts[e];
    for (int k = 0; k < kRuns; ++k) {
      runs[e].push_back({effort, workload.time_step * (1 + kStepShare * k),
                         WorkloadRun::fast(workload,
                                           {.effort = {effort.rounds, effort.iterations},
                                            .is_second_order = false,
                                            .may_sleep = false},
                                           1)});
    }
  }
  while (runs[0].back().time < kTime) {
    for (std::size_t e = 0; e < runs.size(); ++e) {
      for (Contender& c : runs[e]) take_turn(c, results[e].times);
    }
  }
  for (std::size_t e = 0; e < runs.size(); ++e) {
    for (const Contender& c : runs[e]) {
      results[e].largest += c.largest / kRuns;
      results[e].mean += c.sum_means / c.num_means / kRuns;
    }
  }
  return results;
}

double lower_quartile(std::vector<double> values) {
  const auto quarter = values.begin() + std::ssize(values) / 4;
  std::nth_element(values.begin(), quarter, values.end());
  return *quarter;
}

}  // namespace

void bench_stretch(const Settings& settings) {
  using Kind = Workload::Kind;
  ResultFile file(
      "stretch of a sheet of 1 m and 1 kg (1000 N/m) that hangs at two corners, by the fast solver "
      "with implicit Euler in "
      "steps of 1/60 s on one thread: the largest of a spring between 2 and 4 s, and the mean, "
      "each the mean of three runs; "
      "ratios to 8 x 16, which has converged",
      {"workload", "effort", "median_ms", "lower_quartile_ms", "max_stretch_percent",
       "mean_stretch_percent", "max_ratio", "mean_ratio"});
  for (const Workload& workload : {Workload{"hang_50", Kind::kHang, 50, 1.0 / 60, 0, 0},
                                   Workload{"hang_100", Kind::kHang, 100, 1.0 / 60, 0, 0}}) {
    std::vector<Measured> list;
    tbb::task_arena arena(1);
    arena.execute([&] { list = measured(workload); });
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Effort& effort = kEfforts[k];
      file.add({workload.name,
                std::to_string(effort.rounds) + "x" + std::to_string(effort.iterations),
                three_digits(median(list[k].times)), three_digits(lower_quartile(list[k].times)),
                three_digits(100 * list[k].largest), three_digits(100 * list[k].mean),
                three_digits(list[k].largest / list.back().largest),
                three_digits(list[k].mean / list.back().mean)});
    }
    file.write(settings.folder / "stretch.csv");
  }
}

}  // namespace weft::bench
