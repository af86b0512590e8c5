#include <memory>

#include <weft/custom_forces/registry.hpp>

#include "bench/bench.hpp"
#include "bench/laws/floor.hpp"
#include "bench/laws/law_cases.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

constexpr std::size_t kNumFloors = 4;

/// A law with a state in motion and all memory that a call needs.
template <class Scalar>
struct Subject {
  explicit Subject(const LawCase& c)
      : law(forces::make_law<Scalar>(c.specification, c.mesh)),
        positions((1.01 * c.mesh.rest_positions).cast<Scalar>()),
        velocities((0.1 * c.mesh.rest_positions).cast<Scalar>()),
        masses(c.mesh.masses.cast<Scalar>()),
        scratch(3, law->scratch_columns()),
        forces(Matrix3X<Scalar>::Zero(3, c.mesh.num_nodes())) {}
  void call() {
    const forces::State<Scalar> state{positions, velocities, masses};
    switch (law->info().traits.level) {
      case forces::LawTraits::Level::kInertia:
        law->redistribute_forces(state, forces);
        break;
      default:
        law->add_forces(state, scratch, forces);
    }
  }

  std::unique_ptr<forces::ForceLaw<Scalar>> law;
  Matrix3X<Scalar> positions, velocities;
  VectorX<Scalar> masses;
  Matrix3X<Scalar> scratch, forces;
};

template <class Scalar>
void measure(const Settings& settings, const std::string& precision, ResultFile& file) {
  const ClothMesh cloth = classic_cloth();
  const std::vector<LawCase> cases = law_cases(cloth);
  std::vector<std::unique_ptr<Subject<Scalar>>> subjects;
  Floor<Scalar> floor(cloth, Floor<Scalar>::Order::kGrid);
  Floor<Scalar> diagonal_floor(cloth, Floor<Scalar>::Order::kDiagonal);
  std::vector<Contender> contenders;
  std::vector<std::string> elements;
  const double num_springs = floor.num_springs();
  for (const int threads : {1, 2}) {
    contenders.push_back(
        {"floor_arithmetic", threads, num_springs, [&, threads] { floor.evaluate(threads); }});
    contenders.push_back({"floor_grid_order", threads, num_springs,
                          [&, threads] { floor.evaluate_between_nodes(threads); }});
    contenders.push_back({"floor_diagonal_order", threads, num_springs,
                          [&, threads] { diagonal_floor.evaluate_between_nodes(threads); }});
    contenders.push_back({"floor_runs", threads, num_springs,
                          [&, threads] { diagonal_floor.evaluate_in_runs(threads); }});
  }
  elements.assign(contenders.size(), "spring");
  for (const LawCase& c : cases) {
    Subject<Scalar>& subject = *subjects.emplace_back(std::make_unique<Subject<Scalar>>(c));
    for (const int threads : {1, 2}) {
      contenders.push_back({c.id, threads, c.num_elements, [&subject] { subject.call(); }});
      elements.push_back(c.element);
    }
  }
  const std::vector<Timing> timings = race(contenders, settings.num_rounds);
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const Contender& contender = contenders[c];
    // Floors of as many threads: arithmetic, grid order, diagonal order, runs.
    const std::size_t f = contender.num_threads == 1 ? 0 : kNumFloors;
    const double ns = 1e9 / contender.num_elements;
    const auto floor_ns = [&](std::size_t i) { return timings[f + i].minimum * 1e9 / num_springs; };
    const double own = timings[c].minimum * ns;
    const bool is_floor = c < 2 * kNumFloors;
    const double alone = timings[is_floor ? c % kNumFloors : c & ~std::size_t{1}].minimum;
    file.add({contender.name, precision, std::to_string(contender.num_threads), elements[c],
              three_digits(contender.num_elements), three_digits(own),
              three_digits(timings[c].median * ns), three_digits(own / floor_ns(0)),
              three_digits(own / floor_ns(1)), three_digits(own / floor_ns(3)),
              three_digits(alone / timings[c].minimum)});
  }
}

}  // namespace

void bench_laws(const Settings& settings) {
  ResultFile file(
      "time of add_forces per element on the classic cloth (closed surfaces: an icosphere); ratios "
      "of minima, to the floor with as many threads",
      {"law", "scalar", "threads", "element", "num_elements", "minimum_ns", "median_ns",
       "ratio_to_arithmetic", "ratio_to_floor_in_grid_order", "ratio_to_floor_in_runs",
       "speedup_over_one_thread"});
  measure<float>(settings, "float", file);
  measure<double>(settings, "double", file);
  file.write(settings.folder / "laws.csv");
}

}  // namespace weft::bench
