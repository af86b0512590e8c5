// How stiff a rope really is, over steps, iterations and numbers of springs: the law of one of Bullet's links and what
// becomes of it in a chain, beside the engines whose stiffness depends on none of them.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/engine_cases.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace stiffness_map {
namespace {

constexpr double kStiffness = 200.0;  // of every spring [N/m]
constexpr double kNodeMass = 0.05;    // [kg]
constexpr double kSpacing = 0.5;      // [m]: a step's fall of 2.7 mm stretches it by 0.5 %
constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kRate = 8.0;         // of velocity_damping [1/s]

struct StiffnessMapSetting {
  int springs;
  double time_step;  ///< [s]
  int iterations;
  [[nodiscard]] std::string label(const CaseInfo& info) const {
    return fmt::format("{}_{}_{}_{}", info.id, springs, std::lround(1 / time_step), iterations);
  }
};

constexpr int kSprings[] = {1, 2, 10, 30};
constexpr double kSteps[] = {1.0 / 60, 1.0 / 120, 1.0 / 240};
constexpr int kIterations[] = {1, 10, 50};
const EngineChoice kLinks{"bullet_soft", kFloat64};

/// The columns of the matrix.
std::vector<StiffnessMapSetting> settings(int springs) {
  std::vector<StiffnessMapSetting> list;
  for (const double time_step : kSteps) {
    for (const int iterations : kIterations) list.push_back({springs, time_step, iterations});
  }
  return list;
}

/// Those that are to depend on nothing come after Bullet's links.
std::vector<EngineChoice> engines() {
  return {kLinks,
          {"bullet_forces", kFloat64},
          {"bullet_weft", kFloat64},
          {"bullet_deformable", kFloat64}};
}

/// Whether an engine is to hold a rope at all: those with explicit springs have a largest step, 2 / omega.
bool is_stable(const EngineChoice& engine, const StiffnessMapSetting& setting) {
  if (engine.engine == "bullet_soft" || engine.engine == "bullet_weft") return true;
  const double n = setting.springs;
  const double omega = 2 * std::sqrt(kStiffness / kNodeMass) *
                       std::sin((2 * n - 1) / (2 * n + 1) * std::numbers::pi / 2);
  return omega * setting.time_step < 1.9;  // and not on the edge, where it takes for ever to rest
}

/// A rope that hangs from its first node, in its first place unstretched.
scenes::Scene rope_scene(const StiffnessMapSetting& setting) {
  scenes::Scene scene = scenes::load_scene("hang");
  scene.name = "stiffness_map";
  scene.summary = "Shows a rope that hangs from its first node";
  // The slowest mode of 30 springs is damped with 3.2 rad/s or faster: rest to 1e-6.
  scene.world.time_step = setting.time_step;
  scene.world.duration = setting.springs > 10 ? 20.0 : 6.0;
  scene.world.frame_interval = scene.world.duration / 4;
  scene.colliders.clear();
  scenes::Cloth cloth = scene.cloths[0];
  scene.cloths.clear();
  const int nodes = setting.springs + 1;
  Rope rope;
  rope.nodes = nodes;
  rope.start = {0, 0, 0};
  rope.end = {0, -kSpacing * setting.springs, 0};
  rope.total_mass = kNodeMass * nodes;
  rope.lumping = MassLumping::kUniform;
  cloth.source = rope;
  cloth.pins = {scenes::NodePin{{0}}};
  cloth.moving_pins.clear();
  cloth.connections.clear();
  cloth.regions.clear();
  cloth.bulge.reset();
  cloth.velocity.setZero();
  cloth.laws = {{"gravity", {}, {{"acceleration", {0, -kGravity, 0}}}},
                {"tension", {"stretch"}, {{"stiffness", {kStiffness}}}},
                {"velocity_damping", {}, {{"rate", {kRate}}}}};
  scene.cloths.push_back(std::move(cloth));
  scene.bullet.position_iterations = setting.iterations;
  return scenes::with_bullets_time_step(scene);
}

double exact_drop(int springs) {
  return kNodeMass * kGravity * springs * (springs + 1) / (2 * kStiffness);
}

/// Stiffness of a spring over what was asked for, from how far the tip hangs down.
double stiffness_ratio(const Frames& frames, int springs) {
  if (frames.empty()) return std::nan("");
  const auto tip = frames.back().cloths[0].positions.cols() - 1;
  const double drop = -frames.back().cloths[0].positions(1, tip) - kSpacing * springs;
  return exact_drop(springs) / drop;
}

/// One engine's ropes: springs by settings; NaN where the rope is not to be held.
std::vector<std::vector<double>> ratios_of(const CaseInfo& info, const EngineChoice& engine,
                                           const EngineRuns& runs) {
  std::vector<std::vector<double>> ratios;
  for (const int springs : kSprings) {
    ratios.emplace_back();
    for (const StiffnessMapSetting& setting : settings(springs)) {
      const bool is_run = is_stable(engine, setting);
      ratios.back().push_back(
          is_run ? stiffness_ratio(load_history(runs, setting.label(info), engine).frames, springs)
                 : std::nan(""));
    }
  }
  return ratios;
}

void add_rows(const EngineChoice& engine, const std::vector<std::vector<double>>& ratios,
              Table& matrix) {
  for (std::size_t s = 0; s < ratios.size(); ++s) {
    std::vector<std::string> row{engine.title(), std::to_string(kSprings[s])};
    for (const double ratio : ratios[s]) {
      row.push_back(std::isfinite(ratio) ? fmt::format("{:.4f}", ratio) : std::string("unstable"));
    }
    matrix.rows.push_back(std::move(row));
  }
}

CheckResult base_check(const CaseInfo& info, const EngineChoice& engine) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine.title();
  check.unit = "1";
  return check;
}

/// What a rope of one spring that is 10 % stiffer would measure.
void add_sabotage(CheckResult& check) {
  const scenes::Scene scene = rope_scene({1, 1.0 / 240, 10});
  const double sabotaged = std::abs(
      stiffness_ratio(run_sabotaged(scene, stiffness_scaled(1.1), scene.world.duration), 1) - 1);
  check.sabotages.push_back({"spring constant +10 % (in the reference)", sabotaged,
                             judge(sabotaged, *check.tolerance) == Verdict::kFail});
}

CheckResult single_link_check(const CaseInfo& info, const std::vector<double>& ratios) {
  CheckResult check = base_check(info, kLinks);
  check.claim = "one link is as stiff as was asked for, at every step and number of iterations";
  check.metric = "largest relative error of its stiffness, 3 steps x 3 numbers of iterations";
  check.formula = "k = (mu / h^2) ((1 - kLST)^-n - 1)";
  check.source = "n projections of one link per step; statics of a hanging mass";
  check.measured = 0.0;
  for (const double ratio : ratios) {
    const double error = std::abs(ratio - 1);
    if (!(error <= check.measured)) check.measured = error;
  }
  check.tolerance = {
      0.025, Basis::kTruncation,
      "Bullet's link linearises the square of its length: half the strain before it acts, "
      "1 % at 1/60 s"};
  check.verdict = judge(check.measured, *check.tolerance);
  add_sabotage(check);
  check.note = "the mapping from N/m to kLST";
  return check;
}

CheckResult independence_check(const CaseInfo& info, const EngineChoice& engine,
                               const std::vector<std::vector<double>>& ratios) {
  CheckResult check = base_check(info, engine);
  check.claim =
      "springs are as stiff as was asked for, at every step, number of iterations and of springs";
  check.metric = "largest relative error of a spring's stiffness, over the whole matrix";
  check.formula = "m g n (n + 1) / (2 k) of drop";
  check.source = "statics of a hanging chain; explicit engines where h w < 1.9";
  check.measured = 0.0;
  for (std::size_t s = 0; s < ratios.size(); ++s) {
    const std::vector<StiffnessMapSetting> columns = settings(kSprings[s]);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double error = std::abs(ratios[s][c] - 1);
      if (is_stable(engine, columns[c]) && !(error <= check.measured)) check.measured = error;
    }
  }
  check.tolerance = {
      1e-3, Basis::kTruncation,
      "what is left of the swing when the run ends, and corrections in single precision"};
  check.verdict = judge(check.measured, *check.tolerance);
  add_sabotage(check);
  check.note = "the engine is not at rest yet, or its springs are not those that were asked for";
  return check;
}

void add_deviation(const std::vector<std::vector<double>>& ratios, Report& report) {
  double softest = 1e300;
  double stiffest = 0.0;
  for (std::size_t s = 1; s < ratios.size(); ++s) {
    for (const double ratio : ratios[s]) {
      softest = std::min(softest, ratio);
      stiffest = std::max(stiffest, ratio);
    }
  }
  report.deviations.push_back(
      {kLinks.title(), "stiffness_map: a spring in a rope of 2, 10 and 30",
       fmt::format("{:.3g} to {:.3g} of the stiffness that was asked for", softest, stiffest),
       "links are projected one after the other: what a chain of them gives depends on iterations "
       "and step"});
}

}  // namespace
}  // namespace stiffness_map

void plan_stiffness_map(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace stiffness_map;
  if (!options.bullet) return;
  for (const EngineChoice& engine : engines()) {
    for (const int springs : kSprings) {
      for (const StiffnessMapSetting& setting : settings(springs)) {
        if (!is_stable(engine, setting)) continue;
        runs.add({engine.label(setting.label(info)), rope_scene(setting), engine.engine,
                  engine.precision});
      }
    }
  }
}

void evaluate_stiffness_map(const CaseInfo& info, const CaseOptions& options,
                            const EngineRuns& runs, Report& report) {
  using namespace stiffness_map;
  if (!options.bullet) return;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Table matrix{
      "Stiffness of a spring in a hanging rope over what was asked for, by time step and "
      "iterations (unstable: its step is too near 2 / omega, not run)",
      {"engine", "springs"},
      {}};
  for (const StiffnessMapSetting& setting : settings(1)) {
    matrix.columns.push_back(
        fmt::format("1/{} s, {}", std::lround(1 / setting.time_step), setting.iterations));
  }
  for (const EngineChoice& engine : engines()) {
    const std::vector<std::vector<double>> ratios = ratios_of(info, engine, runs);
    add_rows(engine, ratios, matrix);
    const bool is_links = engine.engine == kLinks.engine;
    report.checks.push_back(is_links ? single_link_check(info, ratios.front())
                                     : independence_check(info, engine, ratios));
    if (is_links) add_deviation(ratios, report);
  }
  section.tables.push_back(std::move(matrix));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
