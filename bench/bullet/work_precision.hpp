#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/bullet/workloads/workload.hpp"
#include "bench/result_file.hpp"

namespace weft::bench {

/// One solver at one setting, and what is measured of it.
struct Candidate {
  std::string solver;
  std::string settings;
  std::unique_ptr<WorkloadRun> run;
  int num_steps = 1;               ///< of the workload that one of its own is long
  std::vector<double> times = {};  ///< [ms] for a step of the workload
  double squared_error = 0.0;      ///< [m^2] sum over its steps
  double last_error = 0.0;         ///< [m]
  double speeds = 0.0;             ///< sum of squares over its steps [m^2/s^2], from places
  double exact_speeds = 0.0;       ///< of the reference over the same steps
  Matrix3X<double> last_places = {};
};

/// Bullet and Weft at the settings that a user might choose.
[[nodiscard]] std::vector<Candidate> bullet_candidates(const Workload& workload);
[[nodiscard]] std::vector<Candidate> weft_candidates(const Workload& workload);

/// A table of time and error; every row of it is a candidate or a predictor.
[[nodiscard]] ResultFile work_precision_table(const std::string& title);

/// Runs the candidates in turns on one thread and adds their rows, and those of predictors that solve nothing.
void measure(const Workload& workload, std::vector<Candidate> candidates, ResultFile& file);

}  // namespace weft::bench
