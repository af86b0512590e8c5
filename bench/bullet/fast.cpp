#include <utility>
#include <vector>

#include "bench/bench.hpp"
#include "bench/bullet/work_precision.hpp"

namespace weft::bench {

void bench_fast(const Settings& settings) {
  using Kind = Workload::Kind;
  const Workload workloads[] = {{"hang_50", Kind::kHang, 50, 1e3, 1.0 / 60, 60, 64, 128},
                                {"classic", Kind::kClassic, 50, 1e3, 1.0 / 100, 240, 50, 0},
                                {"hang_100", Kind::kHang, 100, 1e3, 1.0 / 60, 40, 128, 256},
                                {"hang_200", Kind::kHang, 200, 1e3, 1.0 / 60, 16, 256, 512},
                                {"crowd", Kind::kCrowd, 20, 100, 1.0 / 60, 24, 32, 64},
                                {"ball", Kind::kBall, 8, 1e3, 1.0 / 60, 48, 64, 128}};
  ResultFile file = work_precision_table(
      "work and precision: processor time for one step of the workload (1/60 s; classic: 1/100 s) "
      "on one thread, and distance to explicit integration of the same springs (1000 N/m) in small "
      "steps, RMS over nodes and steps, and mean kinetic energy over its; the same for predictors "
      "that solve nothing: a sheet that stays at its start, one that hangs, a rigid plate");
  for (const Workload& workload : workloads) {
    std::vector<Candidate> list = bullet_candidates(workload);
    for (Candidate& one : weft_candidates(workload)) list.push_back(std::move(one));
    measure(workload, std::move(list), file);
    file.write(settings.folder / (sizeof(btScalar) == 4 ? "fast_float32.csv" : "fast_float64.csv"));
  }
}

}  // namespace weft::bench
