#include <cmath>

#include <fmt/core.h>

#include "bench/bench.hpp"
#include "bench/bullet/workloads/rest_drape.hpp"
#include "bench/result_file.hpp"

namespace weft::bench {

void bench_drape(const Settings& settings) {
  ResultFile file(
      "two damped drapes of 1 m with one state of rest up to a mirror, 6 s after their start: "
      "distance of the "
      "places to those of the "
      "fast solver at 1/240 s with 4 rounds of 20 conjugate gradients",
      {"drape", "solver", "settings", "time_step_s", "rms_percent_of_size",
       "largest_percent_of_size"});
  for (const RestDrape drape : {RestDrape::kHammock, RestDrape::kBanner}) {
    const Matrix3X<double> reference = rest_of(drape, {4, 20, 1.0 / 240});
    const auto measure = [&](const DrapeSolver& solver) {
      const VectorX<double> apart = distances(drape, rest_of(drape, solver), reference);
      const bool is_fast = solver.rounds > 0;
      file.add(
          {to_string(drape), is_fast ? "weft" : "bullet",
           is_fast ? fmt::format("{}x{}", solver.rounds, solver.iterations)
                   : std::to_string(solver.iterations),
           fmt::format("1/{:.0f}", 1 / solver.time_step),
           three_digits(100 * std::sqrt(apart.squaredNorm() / static_cast<double>(apart.size()))),
           three_digits(100 * apart.maxCoeff())});
    };
    for (const double rate : {30.0, 60.0, 120.0, 240.0}) {
      for (const auto& [rounds, iterations] :
           {std::pair{1, 1}, {1, 2}, {1, 3}, {2, 3}, {2, 6}, {4, 10}}) {
        measure({rounds, iterations, 1 / rate});
      }
      for (const int iterations : {5, 10, 20, 50}) measure({0, iterations, 1 / rate});
    }
  }
  file.write(settings.folder / "drape.csv");
}

}  // namespace weft::bench
