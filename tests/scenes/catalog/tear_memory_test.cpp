// A minute of a scene that tears: it stays finite, and memory stays flat.
#include <unistd.h>

#include <fstream>

#include <gtest/gtest.h>

#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>

namespace weft::scenes {
namespace {

/// Resident memory of this process [MiB].
double memory() {
  std::ifstream file("/proc/self/statm");
  double total = 0;
  double resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

TEST(TornScenes, AMinuteNeedsNoMoreMemoryThanTenSeconds) {
  Scene scene = load_scene("tear");
  scene.cloths.at(0).grid().nodes = {21, 21};
  scene.world.time_step = 1.0 / 1024;
  for (const EngineInfo& info : engine_table()) {
    if (info.name.starts_with("bullet_deformable")) continue;
    const auto simulator = info.make();
    simulator->load(scene);
    double after_ten_seconds = 0;
    for (int step = 1; step <= 60 * 1024; ++step) {
      const StepReport report = simulator->step(scene.world.time_step);
      ASSERT_FALSE(report.blow_up) << info.name << ": " << report.blow_up->reason;
      if (step == 10 * 1024) after_ten_seconds = memory();
    }
    EXPECT_TRUE(simulator->state().cloths[0].positions.allFinite());
    // The allocator may round up to a few of its own pages; a leak of one node per step would be 30 MiB.
    EXPECT_LT(memory(), after_ten_seconds + 2.0) << info.name;
  }
}

}  // namespace
}  // namespace weft::scenes
