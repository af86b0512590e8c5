#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <weft/core/error.hpp>
#include <weft/core/trace.hpp>
#include <weft/custom_forces/deferred_forces.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>

#include "bench/bench.hpp"
#include "bench/result_file.hpp"
#include "bench/stopwatch.hpp"

namespace weft::bench {
namespace {

using Laws = forces::LawSet<float>;
using Clock = std::chrono::steady_clock;

constexpr auto kOtherWork = std::chrono::milliseconds(8);  // half a frame at 60 Hz

/// Rendering, sound, rules of the game: work of the main thread that knows nothing of TBB.
void other_work() {
  const TraceScope trace("other work");
  const auto end = Clock::now() + kOtherWork;
  volatile double x = 1;
  while (Clock::now() < end) {
    for (int i = 0; i < 100; ++i) x = std::sqrt(x + 1);
  }
}

/// A cloth whose forces take some milliseconds.
struct HeavyCloth {
  HeavyCloth() {
    laws.add(forces::make_law<float>({"tension", {}, {{"stiffness", {100.0}}}}, mesh));
    laws.add(forces::make_law<float>({"spring_damping", {}, {{"damping", {0.5}}}}, mesh));
    laws.add(forces::make_law<float>({"hinge_torsion", {}, {{"rigidity", {1e-3}}}}, mesh));
  }
  [[nodiscard]] forces::State<float> state() const { return {positions, velocities, masses}; }

  ClothMesh mesh = make_cloth_grid({.nodes = {160, 160}});
  Matrix3X<float> positions = (1.01 * mesh.rest_positions).cast<float>();
  Matrix3X<float> velocities = (0.1 * mesh.rest_positions).cast<float>();
  VectorX<float> masses = mesh.masses.cast<float>();
  Matrix3X<float> forces = Matrix3X<float>::Zero(3, mesh.num_nodes());
  Laws laws;
  forces::DeferredForces<float> deferred{laws, Laws::VelocityLaws::kAsForces};
};

void add_up(HeavyCloth& cloth) {
  const TraceScope trace("forces");
  cloth.forces.setZero();
  (void)cloth.laws.add_forces(cloth.state(), Laws::VelocityLaws::kAsForces, cloth.forces);
}

/// One way to get the forces of a frame.
struct Way {
  std::string name;
  int num_threads;
  std::function<void(HeavyCloth&)> at_start;  ///< of the frame: the forces are needed now
  std::function<void(HeavyCloth&)> at_end;    ///< of the frame: positions are final
};

double milliseconds_of(const std::function<void()>& call) {
  const auto start = Clock::now();
  call();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct FrameTimes {
  std::vector<double> at_start, at_end, waiting;  ///< [ms]
};

/// Time in events of this name [ms].
double time_in(const std::vector<TraceThread>& threads, std::string_view name) {
  double sum = 0;
  for (const TraceThread& thread : threads) {
    for (const TraceEvent& event : thread.events) {
      if (event.name == name) sum += static_cast<double>(event.end - event.begin) * 1e-6;
    }
  }
  return sum;
}

void frame(const Way& way, HeavyCloth& cloth, FrameTimes& times) {
  const TraceScope trace("frame");
  times.at_start.push_back(milliseconds_of([&] { way.at_start(cloth); }));
  times.at_end.push_back(milliseconds_of([&] { way.at_end(cloth); }));
  other_work();
}

void write_trace(const Settings& settings, const Way& way, HeavyCloth& cloth) {
  FrameTimes ignored;
  frame(way, cloth, ignored);
  start_trace();
  for (int i = 0; i < 3; ++i) frame(way, cloth, ignored);
  const std::vector<TraceThread> threads = stop_trace();
  const auto path = settings.folder / ("trace_" + way.name + ".json");
  std::ofstream file(path);
  write_chrome_trace(threads, file);
  if (!file) throw Error(path.string() + ": cannot be written");
}

}  // namespace

void bench_frame(const Settings& settings) {
  name_trace_thread("main");
  HeavyCloth cloth;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const auto nothing = [](HeavyCloth&) {};
  const std::vector<Way> ways = {
      {"one_thread", 1, add_up, nothing},
      {"all_threads", cores, add_up, nothing},
      {"deferred", cores, [](HeavyCloth& c) { (void)c.deferred.finish(c.state(), c.forces); },
       [](HeavyCloth& c) { c.deferred.begin(c.state()); }},
  };
  std::vector<FrameTimes> times(ways.size());
  for (int round = 0; round < settings.num_rounds; ++round) {
    for (std::size_t w = 0; w < ways.size(); ++w) {
      tbb::task_arena arena(ways[w].num_threads);
      arena.execute([&] {
        FrameTimes ignored;
        frame(ways[w], cloth, ignored);  // threads are awake, the first begin() is made
        start_trace();
        frame(ways[w], cloth, times[w]);
        times[w].waiting.push_back(time_in(stop_trace(), "wait for forces"));
        cloth.deferred.drop();
      });
    }
  }
  for (const Way& way : ways) {
    tbb::task_arena(way.num_threads).execute([&] { write_trace(settings, way, cloth); });
    cloth.deferred.drop();
  }
  ResultFile file(
      "main thread's time for the forces of a cloth of 160 x 160 nodes in a frame with 8 ms of "
      "other work; medians",
      {"way", "threads", "frame_start_ms", "frame_end_ms", "of_this_waiting_ms",
       "busy_over_one_thread", "waiting_over_one_thread"});
  const double alone = median(times[0].at_start);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const double start = median(times[w].at_start);
    const double end = median(times[w].at_end);
    const double waiting = median(times[w].waiting);
    file.add({ways[w].name, std::to_string(ways[w].num_threads), three_digits(start),
              three_digits(end), three_digits(waiting), three_digits((start + end) / alone),
              three_digits(waiting / alone)});
  }
  file.write(settings.folder / "frame.csv");
}

}  // namespace weft::bench
