// Every scene of the catalog for much longer than it is made for: nothing explodes, memory stays flat.
#include <malloc.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/allocator_interface.h>
#endif

namespace weft::scenes {
namespace {

/// Memory that this process has asked for and not given back [MiB]: unlike what is resident it does
/// not depend on what an allocator keeps.
double live_memory() {
#ifdef __SANITIZE_ADDRESS__
  const std::size_t bytes = __sanitizer_get_current_allocated_bytes();
#else
  const struct mallinfo2 info = mallinfo2();
  const std::size_t bytes = info.uordblks + info.hblkhd;
#endif
  return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

/// [s] of simulated time: a minute, or what the environment says.
double run_time() {
  const char* given = std::getenv("WEFT_LONG_RUN_SECONDS");
  return given == nullptr ? 60.0 : std::stod(given);
}

class LongRun : public testing::TestWithParam<const CatalogEntry*> {};

TEST_P(LongRun, StaysFiniteAndNeedsNoMoreMemory) {
  Scene scene = load_scene(std::string(GetParam()->name));
  const std::string engine = scene.engines.empty() ? "bullet_forces" : scene.engines.front();
  scene = with_step_of(std::move(scene), engine);
  const EngineInfo* info = find_engine(engine, StoredPrecision::kFloat32);
  ASSERT_NE(info, nullptr) << engine;
  const auto simulator = info->make();
  simulator->load(scene);
  const auto num_steps = static_cast<int>(run_time() / scene.world.time_step);
  double after_a_fifth = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int step = 1; step <= num_steps; ++step) {
    const StepReport report = simulator->step(scene.world.time_step);
    ASSERT_FALSE(report.blow_up) << report.blow_up->body << ", node " << report.blow_up->node
                                 << " at " << report.time << " s: " << report.blow_up->reason;
    if (step == num_steps / 5) after_a_fifth = live_memory();
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  for (const ClothState& cloth : simulator->state().cloths) {
    EXPECT_TRUE(cloth.positions.allFinite() && cloth.velocities.allFinite()) << cloth.name;
  }
  // Lists of contacts grow to the largest number they ever had; a leak of one pointer per step would
  // be more than this after a minute in most scenes.
  EXPECT_LT(live_memory(), after_a_fifth + 0.5);
  std::printf(
      "%-14s %-14s %6.0f s simulated in %7.1f s, %7.2f MiB live at a fifth, %7.2f at the end\n",
      scene.name.c_str(), engine.c_str(), num_steps * scene.world.time_step, taken.count(),
      after_a_fifth, live_memory());
}

std::vector<const CatalogEntry*> all_entries() {
  std::vector<const CatalogEntry*> entries;
  for (const CatalogEntry& entry : scene_catalog()) entries.push_back(&entry);
  return entries;
}

INSTANTIATE_TEST_SUITE_P(Catalog, LongRun, testing::ValuesIn(all_entries()),
                         [](const auto& entry) { return std::string(entry.param->name); });

}  // namespace
}  // namespace weft::scenes
