// The largest stable step of three cloths, predicted and tried.
// Tested by tests/apps/CMakeLists.txt.
#include <utility>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/stability/stability_map.hpp>

namespace weft::validation {
namespace stability_maps {
namespace {

/// Threads alone, a stiff strip with hinges, and the lattice of 24 neighbors.
constexpr const char* kScenes[] = {"hang", "heavy_strip", "drape_sphere"};

}  // namespace
}  // namespace stability_maps

void evaluate_stability_maps(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                             Report& report) {
  using namespace stability_maps;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  for (const char* scene : kScenes) {
    for (const StabilityMap& map : map_stability(scenes::load_scene(scene))) {
      CheckResult check = stability_check(map);
      check.case_id = info.id;
      check.claim = fmt::format("{}: {}", scene, check.claim);
      report.checks.push_back(std::move(check));
      Section one = stability_section(map);
      for (Plot& plot : one.plots) {
        plot.title = fmt::format("{}: {}", scene, plot.title);
        section.plots.push_back(std::move(plot));
      }
      for (Table& table : one.tables) {
        table.title = fmt::format("{}: {}", scene, table.title);
        section.tables.push_back(std::move(table));
      }
    }
  }
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
