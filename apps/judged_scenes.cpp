#include "apps/judged_scenes.hpp"

#include <map>
#include <vector>

#include <fmt/format.h>

#include <weft/playback/exchange/exchange_body.hpp>
#include <weft/playback/exchange/obj_file.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/validation/cases.hpp>

namespace weft::app {
namespace {

constexpr std::string_view kNoOldFile = "weft.toml";  // folders without Weft's mark are never ours

bool is_own(std::string_view) {
  return false;
}

}  // namespace

output::OutputFolder judged_scenes_folder(const std::string& path) {
  return {path, kNoOldFile, {"a folder of scenes of Weft", is_own}};
}

int write_judged_scenes(const output::OutputFolder& folder) {
  std::vector<scenes::Scene> all;
  std::map<std::string, int> num_with_name;
  for (const validation::CaseInfo& info : validation::all_cases()) {
    if (info.recordable == nullptr) continue;
    for (scenes::Scene& scene : info.recordable(info)) {
      ++num_with_name[scene.name];
      all.push_back(std::move(scene));
    }
  }
  for (const scenes::Scene& scene : all) {
    std::string name = scene.name;
    if (num_with_name[name] > 1) {
      name += fmt::format("_{}", scenes::num_nodes(scene.cloths.front().source));
    }
    folder.write(name + ".toml", scenes::write_scene(scene));
    for (const scenes::ExchangeBody& body : scenes::exchange_bodies(scene)) {
      folder.write(fmt::format("{}_{}.obj", name, body.file_name),
                   scenes::obj_text(body.name, body.mesh));
    }
  }
  return static_cast<int>(all.size());
}

}  // namespace weft::app
