#include <weft/validation/referee/judged_cases.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <weft/core/error.hpp>
#include <weft/validation/cases.hpp>

namespace weft::validation {
namespace {

/// Engines that the bounds of cases are stated for.
constexpr std::array<std::string_view, 3> kBoundEngines = {"bullet_weft", "bullet_forces",
                                                           "bullet_soft"};

const std::array kNotJudged = {
    NotJudged{
        "they hold theory against many runs, each with a step, a stiffness or a load of its own",
        {"oscillator",
         "observed_orders",
         "hanging_chain",
         "spring_pendulum",
         "catenary",
         "frequencies",
         "invariances",
         "lattice_moduli",
         "plate_rigidity",
         "cantilever",
         "fabrics",
         "tip_load",
         "peirce",
         "buckling",
         "torsion_beam",
         "helix",
         "nonlocal_torsion",
         "acceleration_damping",
         "rotation_damping",
         "spinning_dumbbell",
         "hover",
         "balloon",
         "contact_balance",
         "capstan",
         "overhang",
         "stick_slip",
         "incline",
         "sliding_cloth",
         "stability_map",
         "stiffness_map",
         "cusick"}},
    NotJudged{
        "they need forces, energies or velocities of the engine's own step, and velocities of an "
        "import are differences of positions",
        {"energy_ledger", "momentum", "swing", "impacts", "rest"}},
    NotJudged{"they compare several runs of one engine or of Weft's engines with each other",
              {"engine_cantilever", "damped_hang", "materials", "explosion", "layers",
               "solved_steps", "work_precision", "third_opinion", "determinism"}},
};

std::string judged_names() {
  std::vector<std::string_view> names;
  for (const CaseInfo& info : all_cases()) {
    if (info.recordable != nullptr) names.push_back(info.id);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

const CaseInfo& named_case(const std::string& name, const RecordedResult& recorded) {
  for (const CaseInfo& info : all_cases()) {
    if (info.id == name && info.recordable != nullptr) return info;
  }
  throw InvalidArgument(
      fmt::format("{}: case '{}' cannot be judged from a recording, expected one of: {}",
                  recorded.path.string(), name, judged_names()));
}

/// Sets the recording's scene to the one of the case's that asks the same; false if there is none.
bool take_scene_of(const CaseInfo& info, RecordedResult& recorded) {
  for (const scenes::Scene& scene : info.recordable(info)) {
    if (!ask_the_same(scene, recorded.scene)) continue;
    recorded.scene = scene;
    return true;
  }
  return false;
}

const CaseInfo& find_case(const std::vector<std::string>& names, RecordedResult& recorded) {
  if (names.size() > 1) {
    throw InvalidArgument(fmt::format("{}: {} cases for one recording, expected one at most",
                                      recorded.path.string(), names.size()));
  }
  if (!names.empty()) {
    const CaseInfo& info = named_case(names.front(), recorded);
    if (take_scene_of(info, recorded)) return info;
    const std::vector<scenes::Scene> scenes = info.recordable(info);
    if (scenes.size() == 1) {
      recorded.scene = scenes.front();
      return info;
    }
    throw InvalidArgument(
        fmt::format("{}: scene '{}' is none of the {} of case '{}', expected one of "
                    "them (weft validate --write-scenes FOLDER)",
                    recorded.path.string(), recorded.scene.name, scenes.size(), info.id));
  }
  for (const CaseInfo& info : all_cases()) {
    if (info.recordable != nullptr && take_scene_of(info, recorded)) return info;
  }
  throw InvalidArgument(
      fmt::format("{}: scene '{}' is not that of a case, expected a scene of one of "
                  "these, or the case's name: {}",
                  recorded.path.string(), recorded.scene.name, judged_names()));
}

}  // namespace

const CaseInfo& case_of_recording(const std::vector<std::string>& names, RecordedResult& recorded) {
  if (std::find(kBoundEngines.begin(), kBoundEngines.end(), recorded.judged_as) ==
      kBoundEngines.end()) {
    throw InvalidArgument(
        fmt::format("--engine {}: has no bounds for a recording, expected one of: {}",
                    recorded.judged_as, fmt::join(kBoundEngines, ", ")));
  }
  const CaseInfo& info = find_case(names, recorded);
  check_frames(scenes::RecordingReader(recorded.path), recorded.path.string(), recorded.scene);
  return info;
}

std::span<const NotJudged> not_judged() {
  return kNotJudged;
}

std::vector<std::string> not_judged_texts() {
  std::vector<std::string> texts;
  for (const NotJudged& group : not_judged()) {
    texts.push_back(fmt::format("Not judged from a recording, because {}: {}.", group.reason,
                                fmt::join(group.cases, ", ")));
  }
  return texts;
}

}  // namespace weft::validation
