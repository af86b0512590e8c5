// The negative control: explicit Euler blows up on the classic scene, and the report says where and
// when.
// Tested by tests/apps/CMakeLists.txt.
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>

namespace weft::validation {
namespace explosion {
namespace {

constexpr const char* kScene = "drape_sphere";
constexpr const char* kExplicit = "explosion_explicit_euler";
constexpr const char* kControl = "explosion_modified_euler";

scenes::Scene scene_with(scenes::Integrator integrator) {
  scenes::Scene scene = scenes::load_scene(kScene);
  scene.reference.integrator = integrator;
  return scene;
}

struct Attempt {
  std::string title;
  int exit_code = 0;
  std::optional<scenes::BlowUp> blow_up;
  Series fastest;  ///< largest node speed over time
};

Attempt load(const EngineRuns& runs, const std::string& label, const std::string& title) {
  Attempt attempt{title, runs.outcome(label).exit_code, {}, {title, {}, {}}};
  if (attempt.exit_code > 1) return attempt;
  const scenes::RecordingReader reader(runs.outcome(label).recording);
  attempt.blow_up = reader.blow_up();
  for (int f = 0; f < reader.num_frames(); ++f) {
    const scenes::SceneState frame = reader.frame(f);
    const double speed = frame.cloths[0].velocities.colwise().norm().maxCoeff();
    if (f == 0 || !std::isfinite(speed)) continue;
    attempt.fastest.x.push_back(frame.time);
    attempt.fastest.y.push_back(speed);
  }
  return attempt;
}

/// 0 if the run ended in a blow-up that is reported as data, 1 otherwise.
double measure(const Attempt& attempt) {
  return attempt.exit_code == 1 && attempt.blow_up ? 0 : 1;
}

}  // namespace
}  // namespace explosion

void plan_explosion(const CaseInfo&, const CaseOptions&, EngineRuns& runs) {
  using namespace explosion;
  constexpr auto kDouble = scenes::StoredPrecision::kFloat64;
  runs.add({kExplicit, scene_with(scenes::Integrator::kExplicitEuler), "reference", kDouble});
  runs.add({kControl, scene_with(scenes::Integrator::kModifiedEuler), "reference", kDouble});
}

void evaluate_explosion(const CaseInfo& info, const CaseOptions&, const EngineRuns& runs,
                        Report& report) {
  using namespace explosion;
  const Attempt attempt = load(runs, kExplicit, "explicit Euler");
  const Attempt control = load(runs, kControl, "modified Euler");
  const Tolerance tolerance{0, Basis::kExact, "it is reported as data, or it is not"};
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference";
  check.claim = "explicit Euler explodes on drape_sphere and is reported with step, node and time";
  check.metric = "1 if there is no blow-up in the recording";
  check.unit = "1";
  check.formula = "an undamped mode grows by sqrt(1 + (h w)^2) per step";
  check.source = "de Joya 2011, figure 2: basic Euler explodes within seconds";
  check.measured = measure(attempt);
  check.tolerance = tolerance;
  check.verdict = judge(check.measured, tolerance);
  check.note = "the step guard, the blow-up check, or the recording of it";
  const double sabotaged = measure(control);
  check.sabotages.push_back(
      {"modified Euler instead", sabotaged, judge(sabotaged, tolerance) == Verdict::kFail});
  report.checks.push_back(std::move(check));

  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.plots.push_back({"Fastest node of drape_sphere",
                           "time [s]",
                           "speed [m/s]",
                           false,
                           true,
                           {attempt.fastest, control.fastest}});
  Table table{
      "How the runs ended", {"integrator", "step", "time [s]", "body", "node", "reason"}, {}};
  for (const Attempt* each : {&attempt, &control}) {
    if (each->blow_up) {
      table.rows.push_back({each->title, std::to_string(each->blow_up->step),
                            fmt::format("{:.4g}", each->blow_up->time), each->blow_up->body,
                            std::to_string(each->blow_up->node), each->blow_up->reason});
    } else {
      table.rows.push_back({each->title, "-", "-", "-", "-",
                            each->exit_code == 0 ? "ran to the end" : "did not run"});
    }
  }
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
