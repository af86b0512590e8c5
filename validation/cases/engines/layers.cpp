// Layers of cloth in the steps of a game: nothing passes through cloth, and nobody gains energy.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/metrics/distance/self_intersection.hpp>
#include <weft/validation/metrics/energy.hpp>

namespace weft::validation {
namespace layers {
namespace {

constexpr double kTimeStep = 1.0 / 50;    // [s] of the frames of both scenes
constexpr double kShortStep = 1.0 / 250;  // [s] for what should come of it
constexpr const char* kEngine = "bullet_weft";
constexpr const char* kScenes[] = {"towel", "stack"};
constexpr scenes::StoredPrecision kPrecisions[] = {scenes::StoredPrecision::kFloat32,
                                                   scenes::StoredPrecision::kFloat64};

scenes::Scene scene_of(const char* name, bool with_contact, double time_step = kTimeStep) {
  scenes::Scene scene = scenes::load_scene(name);
  scene.world.time_step = time_step;
  scene.world.implicit_time_step.reset();
  for (scenes::Cloth& cloth : scene.cloths) {
    cloth.self_collision = cloth.self_collision && with_contact;
    cloth.soft_collision = cloth.soft_collision && with_contact;
    if (!cloth.self_collision) cloth.self_thickness.reset();
  }
  return scene;
}

std::string label_of(const char* name, scenes::StoredPrecision precision, bool with_contact) {
  return fmt::format("layers_{}_{}{}", name,
                     precision == scenes::StoredPrecision::kFloat32 ? "float32" : "float64",
                     with_contact ? "" : "_without_contact");
}

std::string label_of_short(const char* name) {
  return fmt::format("layers_{}_short_steps", name);
}

/// Counts the edges that pass through triangles in one frame.
int piercings(const std::vector<Triangles>& triangles, const scenes::SceneState& state) {
  int count = 0;
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const Matrix3X<double>& x = state.cloths[c].positions;
    count += static_cast<int>(self_piercings(x, triangles[c]).size());
    for (std::size_t other = 0; other < c; ++other)
      count += count_piercings(x, triangles[c], state.cloths[other].positions, triangles[other]);
  }
  return count;
}

struct Result {
  double most_piercings = 0;  ///< of all frames
  double gain = 0;  ///< [1] by which energy rises after it was least, over what gravity gives
  double gain_if_faster = 0;  ///< the same of a run whose velocities are half as large again
  double fall = 0;            ///< [J] of gravity, from the start to the end
  Series over_time;           ///< piercings
};

Result measure(const std::filesystem::path& recording, const std::string& title) {
  const scenes::RecordingReader reader(recording);
  const SceneEnergy energy(reader.scene());
  std::vector<Triangles> triangles;
  for (const scenes::Cloth& cloth : reader.scene().cloths)
    triangles.push_back(scenes::make_mesh(cloth).triangles);
  Result result{.over_time = {title, {}, {}}};
  double least = 0;  // so far
  double given = 0;
  double most = 0;
  double most_if_faster = 0;
  for (int f = 0; f < reader.num_frames(); ++f) {
    const scenes::SceneState frame = reader.frame(f);
    const int count = piercings(triangles, frame);
    result.most_piercings = std::max(result.most_piercings, static_cast<double>(count));
    result.over_time.x.push_back(frame.time);
    result.over_time.y.push_back(count);
    const Energy now = energy.evaluate(frame);
    if (f == 0) {
      least = now.total();
      given = -now.gravitational;
      continue;
    }
    most = std::max(most, now.total() - least);
    most_if_faster = std::max(most_if_faster, now.total() + 1.25 * now.kinetic() - least);
    least = std::min(least, now.total());
    if (f + 1 == reader.num_frames()) given = -given - now.gravitational;
  }
  result.fall = given;
  result.gain = most / given;
  result.gain_if_faster = most_if_faster / given;
  return result;
}

CheckResult check_of(const CaseInfo& info, const char* scene, scenes::StoredPrecision precision) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = fmt::format(
      "{} {}", kEngine, precision == scenes::StoredPrecision::kFloat32 ? "float32" : "float64");
  check.claim = fmt::format("{} in steps of 1/50 s", scene);
  return check;
}

}  // namespace
}  // namespace layers

void plan_layers(const CaseInfo&, const CaseOptions& options, EngineRuns& runs) {
  using namespace layers;
  if (!options.bullet) return;
  for (const char* name : kScenes) {
    for (const scenes::StoredPrecision precision : kPrecisions)
      runs.add({label_of(name, precision, true), scene_of(name, true), kEngine, precision});
    runs.add({label_of_short(name), scene_of(name, true, kShortStep), kEngine, kPrecisions[1]});
    runs.add(
        {label_of(name, kPrecisions[0], false), scene_of(name, false), kEngine, kPrecisions[0]});
  }
}

void evaluate_layers(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                     Report& report) {
  using namespace layers;
  if (!options.bullet) return;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  for (const char* name : kScenes) {
    const Result without =
        measure(runs.outcome(label_of(name, kPrecisions[0], false)).recording, "without contact");
    const Result right = measure(runs.outcome(label_of_short(name)).recording, "short steps");
    Plot plot{fmt::format("What passes through cloth in {}", name),
              "time [s]",
              "edges in triangles [1]",
              false,
              false,
              {without.over_time}};
    for (const scenes::StoredPrecision precision : kPrecisions) {
      const std::string label = label_of(name, precision, true);
      const Result result = measure(runs.outcome(label).recording, label);
      plot.series.push_back(result.over_time);
      CheckResult passed = check_of(info, name, precision);
      passed.claim += ": nothing passes through cloth";
      passed.metric = "most edges inside of triangles that share no node with them, of all frames";
      passed.unit = "1";
      passed.formula = "0";
      passed.source = "an independent count";
      passed.measured = result.most_piercings;
      passed.tolerance = {0, Basis::kExact, "an edge is in a triangle, or it is not"};
      passed.verdict = judge(passed.measured, *passed.tolerance);
      passed.sabotages.push_back(
          {"without contact", without.most_piercings,
           judge(without.most_piercings, *passed.tolerance) == Verdict::kFail});
      report.checks.push_back(std::move(passed));
      CheckResult gained = check_of(info, name, precision);
      gained.claim += ": no energy is gained";
      gained.metric = "rise of energy after it was least, over what gravity gives";
      gained.unit = "1";
      gained.formula = "kinetic, elastic and gravitational energy together never rise";
      gained.source = "conservation of energy";
      gained.measured = result.gain;
      gained.tolerance = {0.05, Basis::kTruncation,
                          "implicit Euler damps; contacts that are projected stretch springs"};
      gained.verdict = judge(gained.measured, *gained.tolerance);
      gained.sabotages.push_back(
          {"velocities half as large again", result.gain_if_faster,
           judge(result.gain_if_faster, *gained.tolerance) == Verdict::kFail});
      report.checks.push_back(std::move(gained));
      // A cloth that stands still passes through nothing and gains no energy.
      CheckResult fallen = check_of(info, name, precision);
      fallen.claim += ": it comes down as far as in steps of 1/250 s";
      fallen.metric = "energy that gravity gives, over that in short steps, less 1";
      fallen.unit = "1";
      fallen.formula = "0";
      fallen.source = "the same engine in steps of 1/250 s";
      fallen.measured = std::abs(result.fall / right.fall - 1);
      fallen.tolerance = {0.05, Basis::kTruncation, "layers come to rest in other folds"};
      fallen.verdict = judge(fallen.measured, *fallen.tolerance);
      fallen.sabotages.push_back(
          {"it stays at its start", 1.0, judge(1.0, *fallen.tolerance) == Verdict::kFail});
      report.checks.push_back(std::move(fallen));
    }
    section.plots.push_back(std::move(plot));
  }
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
