#include <weft/engines/engine_state.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

void serialize(StateArchive& archive, double& number) {
  archive.value(number);
}

void serialize(StateArchive& archive, SolveReport& report) {
  archive.value(report.error);
  archive.value(report.is_within_tolerance);
}

void serialize(StateArchive& archive, BlowUp& blow_up) {
  archive.value(blow_up.step);
  archive.value(blow_up.time);
  archive.value(blow_up.body);
  archive.value(blow_up.node);
  archive.value(blow_up.reason);
}

bool is_same(const forces::LawSpecification& a, const forces::LawSpecification& b) {
  return a.law == b.law && a.sets == b.sets && a.parameters == b.parameters;
}

}  // namespace

void serialize(StateArchive& archive, StepReport& report) {
  const auto each = [&](auto& value) { serialize(archive, value); };
  archive.part("step");
  archive.value(report.step);
  archive.value(report.time);
  archive.value(report.time_step);
  archive.value(report.substeps);
  archive.value(report.num_contacts);
  archive.optional(report.stable_time_step, each);
  archive.optional(report.solve, each);
  archive.optional(report.blow_up, each);
}

void serialize(StateArchive& archive, std::vector<forces::LawSpecification>& laws) {
  archive.part("laws");
  archive.list(laws, [&](forces::LawSpecification& law) {
    archive.value(law.law);
    archive.value(law.sets);
    std::vector<std::pair<std::string, std::vector<double>>> parameters(law.parameters.begin(),
                                                                        law.parameters.end());
    archive.list(parameters, [&](auto& parameter) {
      archive.value(parameter.first);
      archive.value(parameter.second);
    });
    law.parameters = {parameters.begin(), parameters.end()};
  });
}

bool are_same(const std::vector<forces::LawSpecification>& a,
              const std::vector<forces::LawSpecification>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same);
}

const Scene& LoadedScene::scene() const {
  if (!scene_) throw Error("snapshot: no scene is loaded, expected load() first");
  return *scene_;
}

const std::shared_ptr<const std::string>& LoadedScene::text() {
  if (!text_) {
    Scene endless = scene();  // a run may be gone on with for longer, and recorded in other frames
    endless.world.duration = 0;
    endless.world.frame_interval = 0;
    text_ = std::make_shared<const std::string>(write_scene(endless));
  }
  return text_;
}

void LoadedScene::check(const Snapshot& snapshot, std::string_view engine,
                        std::string_view precision) {
  if (snapshot.engine != engine || snapshot.precision != precision) {
    throw Error(fmt::format("snapshot: is of {} in {}, expected one of {} in {}", snapshot.engine,
                            snapshot.precision, engine, precision));
  }
  const bool is_same =
      snapshot.scene && (snapshot.scene == text_ || *snapshot.scene == *this->text());
  if (!is_same) {
    throw Error(
        fmt::format("snapshot: is of another scene, expected one of '{}' as it is loaded, but for "
                    "its duration and frames",
                    scene().name));
  }
}

}  // namespace weft::scenes
