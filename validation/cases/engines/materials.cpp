// The four materials of de Joya 2011 on their spheres, and what weak damping leaves of their rest.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/engine_cases.hpp>

namespace weft::validation {
namespace materials {
namespace {

constexpr std::size_t kMaterials = 4;
using Numbers = std::array<double, kMaterials>;
constexpr Numbers kFactors = {0.55, 0.6, 0.7, 0.9};  ///< share of the velocity lost per step [-]
constexpr Numbers kReported = {12, 16, 22, 34};      ///< time to rest, de Joya 2011 [s]
constexpr double kFactorStep = 0.01;                 ///< [s] that the factors are for
constexpr Numbers kWeakFactors = {0.05, 0.1, 0.2, 0.4};
constexpr double kWeakDuration = 40.0;  ///< [s]: the strongest of them rests after 30 s
constexpr double kRestWindow = 5.0;     ///< [s] at the end, over which residual motion is taken

/// A cloth has come down when its mean height is this share of its whole way above its last one
/// [-]. Kinetic energy would not do: a slow cloth has little of it all the time.
constexpr double kDownShare = 0.02;

constexpr double kRestSpeed = 2e-5;  ///< [m/s] RMS: measured 6e-7

std::vector<EngineChoice> material_engines(bool with_bullet) {
  std::vector<EngineChoice> list;
  if (with_bullet) list = {{"bullet_soft", kFloat32}, {"bullet_forces", kFloat32}};
  list.push_back({"reference", kFloat64});
  return list;
}

/// Integrators of the reference that are stable here; explicit Euler is not (case explosion).
struct IntegratorChoice {
  const char* name;
  scenes::Integrator integrator;
};
constexpr std::array kIntegrators = {
    IntegratorChoice{"velocity_verlet", scenes::Integrator::kVelocityVerlet},
    IntegratorChoice{"runge_kutta_4", scenes::Integrator::kRungeKutta4}};

double rate_of(double factor) {
  return -std::log1p(-factor) / kFactorStep;
}

scenes::Scene damped(const Numbers& factors) {
  scenes::Scene scene = scenes::load_scene("materials");
  for (std::size_t m = 0; m < kMaterials; ++m) {
    for (forces::LawSpecification& law : scene.cloths.at(m).laws) {
      if (law.law == "velocity_damping") law.parameters.at("rate").at(0) = rate_of(factors[m]);
    }
  }
  return scene;
}

scenes::Scene weakly_damped() {
  scenes::Scene scene = damped(kWeakFactors);
  scene.world.duration = kWeakDuration;
  return scene;
}

std::string weak_id(const IntegratorChoice& choice) {
  return std::string("materials_weak_") + choice.name;
}

double mean_height(const scenes::SceneState& state, std::size_t cloth) {
  return state.cloths[cloth].positions.row(1).mean();
}

double rms_speed(const scenes::SceneState& state, std::size_t cloth) {
  return std::sqrt(state.cloths[cloth].velocities.colwise().squaredNorm().mean());
}

/// When a cloth has come down for good [s]; NaN without frames.
double time_down(const Frames& frames, std::size_t cloth) {
  if (frames.empty()) return std::nan("");
  const double last = mean_height(frames.back(), cloth);
  const double allowed = kDownShare * (mean_height(frames.front(), cloth) - last);
  double time = frames.front().time;
  for (const scenes::SceneState& frame : frames) {
    if (!(mean_height(frame, cloth) - last <= allowed)) time = frame.time;
  }
  return time;
}

Numbers times_down(const Frames& frames) {
  Numbers times{};
  for (std::size_t m = 0; m < kMaterials; ++m) times[m] = time_down(frames, m);
  return times;
}

/// RMS speed over nodes and the last seconds [m/s]; NaN without frames.
double residual_speed(const History& history, std::size_t cloth) {
  if (history.frames.empty() || history.blow_up) return std::nan("");
  const double begin = history.frames.back().time - kRestWindow;
  double sum = 0;
  int count = 0;
  for (const scenes::SceneState& frame : history.frames) {
    if (frame.time < begin) continue;
    sum += std::pow(rms_speed(frame, cloth), 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

/// The smallest of the times from one material to the next [s]: > 0 if they are in order.
double smallest_delay(const Numbers& times) {
  double smallest = times[1] - times[0];
  for (std::size_t m = 2; m < kMaterials; ++m) {
    const double delay = times[m] - times[m - 1];
    if (!(delay >= smallest)) smallest = delay;
  }
  return smallest;
}

CheckResult order_check(const CaseInfo& info, const EngineChoice& engine, const Numbers& times) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine.title();
  check.claim = "the more damped a material, the later it has come down";
  check.metric = "frames by which the order of two neighbors is missed";
  check.unit = "1";
  check.formula = "t(0.55) < t(0.6) < t(0.7) < t(0.9)";
  check.source = "de Joya 2011";
  const double frame = scenes::load_scene("materials").world.frame_interval;
  const auto missed = [&](const Numbers& t) {
    return std::max(0.0, 1 - smallest_delay(t) / frame);
  };
  check.measured = missed(times);
  check.tolerance = {0, Basis::kExact, "an order holds or it does not; a frame apart can be told"};
  check.verdict = judge(check.measured, *check.tolerance);
  Numbers wrong = times;
  std::swap(wrong[1], wrong[2]);
  const double sabotaged = missed(wrong);
  check.sabotages.push_back(
      {"two materials exchanged", sabotaged, judge(sabotaged, *check.tolerance) == Verdict::kFail});
  check.note = "velocity_damping, or cloths that differ in more than that";
  return check;
}

/// Without forces other than gravity and the loss, x grows by g dt^2 / f per step.
double sinking_ratio(std::size_t m) {
  return kFactors[m] / kFactors[0];
}

Table times_table(const std::vector<std::pair<std::string, Numbers>>& rows) {
  Table table{
      "Time until a cloth has come down [s], and its ratio to that of 0.55", {"engine"}, {}};
  for (const double factor : kFactors) table.columns.push_back(fmt::format("f = {}", factor));
  const auto cell = [](double time, double first) {
    return fmt::format("{:.1f} ({:.2f})", time, time / first);
  };
  std::vector<std::string> reported{"de Joya 2011 (of his own scene and rule)"};
  std::vector<std::string> predicted{"sinking at g dt / f"};
  for (std::size_t m = 0; m < kMaterials; ++m) {
    reported.push_back(cell(kReported[m], kReported[0]));
    predicted.push_back(fmt::format("({:.2f})", sinking_ratio(m)));
  }
  table.rows = {std::move(reported), std::move(predicted)};
  for (const auto& [name, times] : rows) {
    std::vector<std::string> row{name};
    for (std::size_t m = 0; m < kMaterials; ++m) row.push_back(cell(times[m], times[0]));
    table.rows.push_back(std::move(row));
  }
  return table;
}

CheckResult rest_check(const CaseInfo& info, const History& history) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = history.engine.title();
  check.claim = "weak damping still lets the reference come to rest";
  check.metric = fmt::format("RMS speed over the last 5 s, f = {}", kWeakFactors[2]);
  check.unit = "m/s";
  check.source = "de Joya 2011: at 0.2 particles near the edge keep jumping";
  check.measured = residual_speed(history, 2);
  check.tolerance = {kRestSpeed, Basis::kTruncation, "what exp(-t / tau) leaves after 40 s"};
  check.verdict = judge(check.measured, *check.tolerance);
  History early = history;  // before it can be at rest
  while (!early.frames.empty() && early.frames.back().time > 0.25 * kWeakDuration) {
    early.frames.pop_back();
  }
  const double sabotaged = residual_speed(early, 2);
  check.sabotages.push_back({"taken after a quarter of the time", sabotaged,
                             judge(sabotaged, *check.tolerance) == Verdict::kFail});
  check.note = "contact that pumps energy in";
  return check;
}

}  // namespace
}  // namespace materials

void plan_materials(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace materials;
  const std::string id(info.id);
  for (const EngineChoice& engine : material_engines(options.bullet)) {
    runs.add({engine.label(id), damped(kFactors), engine.engine, engine.precision});
    runs.add({engine.label(id + "_weak"), weakly_damped(), engine.engine, engine.precision});
  }
  for (const IntegratorChoice& choice : kIntegrators) {
    scenes::Scene scene = weakly_damped();
    scene.reference.integrator = choice.integrator;
    const EngineChoice reference{"reference", kFloat64};
    runs.add({reference.label(weak_id(choice)), scene, reference.engine, reference.precision});
  }
}

void evaluate_materials(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                        Report& report) {
  using namespace materials;
  const std::string id(info.id);
  Section section{id, std::string(info.summary), {}, {}, {}, ""};
  Plot heights{
      "Mean height of each material, reference", "time [s]", "height [m]", false, false, {}};
  std::vector<std::pair<std::string, Numbers>> rows;
  for (const EngineChoice& engine : material_engines(options.bullet)) {
    const History history = load_history(runs, id, engine);
    const Numbers times = times_down(history.frames);
    report.checks.push_back(order_check(info, engine, times));
    rows.emplace_back(engine.title(), times);
    if (engine.engine != "reference") continue;
    for (std::size_t m = 0; m < kMaterials; ++m) {
      Series series{fmt::format("f = {}", kFactors[m]), {}, {}};
      for (const scenes::SceneState& frame : history.frames) {
        series.x.push_back(frame.time);
        series.y.push_back(mean_height(frame, m));
      }
      heights.series.push_back(std::move(series));
    }
  }
  section.tables.push_back(times_table(rows));

  Table jitter{"Residual motion under weak damping: RMS speed over the last 5 of 40 s [m/s]",
               {"engine"},
               {}};
  for (const double factor : kWeakFactors) jitter.columns.push_back(fmt::format("f = {}", factor));
  Plot sweep{"Residual motion at rest against damping",
             "share of the velocity lost per 1/100 s [1]",
             "RMS speed [m/s]",
             false,
             true,
             {}};
  const auto add = [&](const std::string& name, const History& history) {
    Series series{name, {}, {}};
    std::vector<std::string> row{name};
    for (std::size_t m = 0; m < kMaterials; ++m) {
      const double speed = residual_speed(history, m);
      row.push_back(std::isfinite(speed) ? fmt::format("{:.2g}", speed) : "blew up");
      series.x.push_back(kWeakFactors[m]);
      series.y.push_back(speed);
    }
    jitter.rows.push_back(std::move(row));
    sweep.series.push_back(std::move(series));
  };
  for (const EngineChoice& engine : material_engines(options.bullet)) {
    const History history = load_history(runs, id + "_weak", engine);
    add(engine.title(), history);
    if (engine.engine == "reference") report.checks.push_back(rest_check(info, history));
  }
  for (const IntegratorChoice& choice : kIntegrators) {
    add(std::string("reference, ") + choice.name,
        load_history(runs, weak_id(choice), {"reference", kFloat64}));
  }
  section.tables.push_back(std::move(jitter));
  section.plots = {std::move(heights), std::move(sweep)};
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
