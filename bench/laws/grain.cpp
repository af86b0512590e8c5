#include <cmath>
#include <deque>

#include <weft/custom_forces/assembly/edge_assembly.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/laws/law_cases.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

using forces::EdgeAssembly;
using forces::PlainVector;

struct Subject {
  Subject(const ClothMesh& mesh, int grain)
      : assembly(mesh.edges_of({"stretch", "shear", "bend"}), mesh.num_nodes(), grain),
        positions(mesh.rest_positions.cast<float>()),
        scratch(3, assembly.scratch_columns(1)),
        forces(Matrix3X<float>::Zero(3, mesh.num_nodes())) {}
  void call() {
    const auto force = [](Eigen::Index, const PlainVector<float>& d) -> PlainVector<float> {
      const float length = std::sqrt(d.squared_norm());
      return ((length - 0.1F) / length) * d;
    };
    assembly.add_pairs<float>(force, scratch, forces, positions);
  }

  EdgeAssembly assembly;
  Matrix3X<float> positions, scratch, forces;
};

void measure(const Settings& settings, const ClothMesh& mesh, ResultFile& file) {
  std::deque<Subject> subjects;
  std::vector<Contender> contenders;
  const int grains[] = {256, 512, 1024, 2048, 4096, 8192, 16384};
  for (const int grain : grains) {
    Subject& subject = subjects.emplace_back(mesh, grain);
    for (const int threads : {1, 2}) {
      contenders.push_back({std::to_string(grain), threads, static_cast<double>(mesh.num_edges()),
                            [&subject] { subject.call(); }});
    }
  }
  const std::vector<Timing> timings = race(contenders, settings.num_rounds);
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const double ns = 1e9 / contenders[c].num_elements;
    file.add({std::to_string(mesh.num_edges()), contenders[c].name,
              std::to_string(contenders[c].num_threads), three_digits(timings[c].minimum * ns),
              three_digits(timings[c].median * ns)});
  }
}

}  // namespace

void bench_grain(const Settings& settings) {
  ResultFile file("springs per chunk against time per spring, float",
                  {"num_springs", "grain", "threads", "minimum_ns", "median_ns"});
  measure(settings, classic_cloth(), file);
  measure(settings, make_cloth_grid({.nodes = {200, 200}}), file);
  file.write(settings.folder / "grain.csv");
}

}  // namespace weft::bench
