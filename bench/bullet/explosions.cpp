#include <algorithm>

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include "bench/bench.hpp"
#include "bench/bullet/workloads/random_cloth.hpp"
#include "bench/result_file.hpp"

namespace weft::bench {
namespace {

constexpr int kNumCloths = 1000;

struct Contender {
  std::string name;
  RandomClothSolver solver;
};

/// The value that so many of 100 values are below.
double percentile(std::vector<double> values, int percent) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0
                        : values[(values.size() - 1) * static_cast<std::size_t>(percent) / 100];
}

void add(const std::string& solver, const std::string& fate, const std::vector<Explosion>& runs,
         ResultFile& file) {
  std::vector<double> ratios;
  double fastest = 0;
  std::size_t explosions = 0;
  for (const Explosion& run : runs) {
    if (run.any()) ++explosions;
    if (!run.is_finite) continue;
    ratios.push_back(run.energy_ratio);
    fastest = std::max(fastest, run.fastest);
  }
  file.add({solver, fate, std::to_string(runs.size()), std::to_string(explosions),
            std::to_string(runs.size() - ratios.size()), three_digits(percentile(ratios, 50)),
            three_digits(percentile(ratios, 99)), three_digits(percentile(ratios, 100)),
            three_digits(fastest)});
}

}  // namespace

void bench_explosions(const Settings& settings) {
  ResultFile file(
      "1000 random cloths (8 x 8 nodes, 1 N/m to 1 MN/m, 1 g to 100 kg, 1/1000 to 1/30 s), thrown "
      "or pulled: an "
      "explosion is a place or speed that is not finite or beyond 1e6 m/s, or more than twice the "
      "kinetic energy "
      "that start, gravity and pull have put in",
      {"solver", "fate", "runs", "explosions", "of_them_not_finite", "median_energy_ratio",
       "99_percent_energy_ratio", "largest_energy_ratio", "fastest_node_m_per_s"});
  using Kind = RandomClothSolver::Kind;
  for (const Contender& contender :
       {Contender{"bullet_weft", {}}, Contender{"bullet 10", {Kind::kLinks, 10}},
        Contender{"bullet 50", {Kind::kLinks, 50}}, Contender{"bullet_forces", {Kind::kLaws}}}) {
    std::vector<Explosion> runs(kNumCloths);
    tbb::parallel_for(0, kNumCloths, [&](int i) {
      runs[static_cast<std::size_t>(i)] = run_random_cloth(random_cloth(i), contender.solver);
    });
    const char* const fates[] = {"thrown", "thrown, pinned", "pulled", "pulled, pinned"};
    for (int fate = 0; fate < 4; ++fate) {
      std::vector<Explosion> part;
      for (int i = fate; i < kNumCloths; i += 4) part.push_back(runs[static_cast<std::size_t>(i)]);
      add(contender.name, fates[fate], part, file);
    }
    add(contender.name, "all", runs, file);
    for (int i = 0; i < kNumCloths; ++i) {
      const Explosion& run = runs[static_cast<std::size_t>(i)];
      if (contender.solver.kind != Kind::kFast || !run.any()) continue;
      fmt::print("  cloth {}: {:.3g} times the energy, {:.3g} m/s\n", i, run.energy_ratio,
                 run.fastest);
    }
  }
  file.write(settings.folder / "explosions.csv");
}

}  // namespace weft::bench
