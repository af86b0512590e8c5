// One heavy strip in every engine that carries Weft's laws: at rest they must agree with each other,
// for no engine has a say in an equilibrium.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/analytic/bending/elastica.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/engine_cases.hpp>
#include <weft/validation/cases/support/reference_levels.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace engine_cantilever {
namespace {

constexpr double kEngineBound = 0.01;  ///< of H / W between engines [-]
constexpr double kGamma = 5.0;         ///< of the scene [-]
/// The implicit step needs no small one, and each costs a linear solve.
constexpr double kImplicitTimeStep = 2e-3;  // [s]

/// The reference last.
std::vector<EngineChoice> cantilever_engines(bool with_bullet) {
  std::vector<EngineChoice> list;
  if (with_bullet) {
    list = {{"bullet_forces", kFloat32},
            {"bullet_forces", kFloat64},
            {"bullet_deformable", kFloat64},
            {"bullet_deformable_implicit", kFloat64}};
  }
  list.push_back({"reference", kFloat64});
  return list;
}

scenes::Scene scene_for(const EngineChoice& engine) {
  scenes::Scene scene = scenes::load_scene("heavy_strip");
  if (engine.engine == "bullet_deformable_implicit") scene.world.time_step = kImplicitTimeStep;
  return scene;
}

LevelPlan level_plan(const CaseInfo& info) {
  return {std::string(info.id), scene_for({"reference", kFloat64})};
}

/// H / W of the strip's free end.
double drop_over_reach(const scenes::SceneState& state, const scenes::Scene& scene) {
  const ClothGrid& grid = scene.cloths[0].grid();
  double drop = 0;
  double reach = 0;
  for (int row = 0; row < grid.nodes[1]; ++row) {
    const Vector3<double> tip = state.cloths[0].positions.col(grid_node(grid, -1, row));
    drop -= tip.y();
    reach += tip.x();
  }
  return drop / reach;
}

/// The discretization error that H / W of the reference still has, against a tenth of the bound of the engines.
CheckResult discretization_error_check(const CaseInfo& info, const std::array<double, 3>& levels,
                                       double stiffer, double bound) {
  const auto error = [&](double finest) {
    return study_norms(std::abs(levels[1] - finest), std::abs(levels[0] - levels[1]), 2.0,
                       {2.0, 2.0})
               .uncertainty /
           std::abs(finest);
  };
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference float64";
  check.claim = "the reference's discretization error is a tenth of the bound";
  check.metric = "grid convergence index of H / W, finest of three steps";
  check.unit = "1";
  check.formula = "Fs |H/W(2h) - H/W(h)| / (2^p - 1) / (H/W)";
  check.source = "Roache, J. Fluids Eng. 116 (1994) 405; velocity Verlet with steps 4h, 2h, h";
  check.measured = error(levels[2]);
  check.tolerance = Tolerance{kOwnShare * bound, Basis::kTruncation,
                              "a tenth of the bound; at rest the step has no say"};
  check.verdict = judge(check.measured, *check.tolerance);
  check.sabotages.push_back({"rigidity +10 % in the finest level", error(stiffer),
                             judge(error(stiffer), *check.tolerance) == Verdict::kFail});
  check.note = "the strip is not at rest yet";
  return check;
}

}  // namespace
}  // namespace engine_cantilever

void plan_engine_cantilever(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace engine_cantilever;
  for (const EngineChoice& engine : cantilever_engines(options.bullet)) {
    runs.add(
        {engine.label(std::string(info.id)), scene_for(engine), engine.engine, engine.precision});
  }
  plan_levels(level_plan(info), runs);
}

void evaluate_engine_cantilever(const CaseInfo& info, const CaseOptions& options,
                                const EngineRuns& runs, Report& report) {
  using namespace engine_cantilever;
  const scenes::Scene scene = scenes::load_scene("heavy_strip");
  const HeavyElastica elastica = solve_heavy_elastica(kGamma);
  const double exact = elastica.drop / elastica.reach;
  const std::vector<EngineChoice> list = cantilever_engines(options.bullet);
  std::vector<double> values;
  Plot plot{"Tip drop over tip reach", "time [s]", "H / W [1]", false, false, {}};
  Table table{"H / W at rest", {"engine", "H / W", "to the elastica"}, {}};
  for (const EngineChoice& engine : list) {
    const History history = load_history(runs, std::string(info.id), engine);
    values.push_back(history.frames.empty() ? std::nan("")
                                            : drop_over_reach(history.frames.back(), scene));
    Series series{engine.title(), {}, {}};
    for (const scenes::SceneState& frame : history.frames) {
      series.x.push_back(frame.time);
      series.y.push_back(drop_over_reach(frame, scene));
    }
    plot.series.push_back(std::move(series));
    table.rows.push_back({engine.title(), fmt::format("{:.6f}", values.back()),
                          fmt::format("{:+.3f} %", 100 * (values.back() / exact - 1))});
  }
  Sabotage rigidity{"rigidity +10 %"};
  rigidity.edit_scene = [](scenes::Scene& edited) {
    for (forces::LawSpecification& law : edited.cloths[0].laws) {
      if (law.law == "hinge_torsion") law.parameters.at("rigidity").at(0) *= 1.1;
    }
  };
  const double stiffer =
      drop_over_reach(run_sabotaged(scene, rigidity, scene.world.duration).back(), scene);
  const auto add_check = [&](const EngineChoice& engine, const std::string& claim,
                             const std::string& metric, double value, double expected,
                             const Tolerance& tolerance) {
    CheckResult check;
    check.case_id = info.id;
    check.engine = engine.title();
    check.claim = claim;
    check.metric = metric;
    check.unit = "1";
    check.formula = "one equilibrium for all engines";
    check.source = "reference solver at rest; heavy elastica at Gamma = 5";
    check.values = {{"H / W", value, expected, "1"}};
    check.measured = std::abs(value / expected - 1);
    check.tolerance = tolerance;
    check.verdict = judge(check.measured, tolerance);
    const double sabotaged = std::abs(stiffer / expected - 1);
    check.sabotages.push_back(
        {"rigidity +10 %", sabotaged, judge(sabotaged, tolerance) == Verdict::kFail});
    check.note = "the engine is not at rest yet, or it does not carry hinge_torsion as it is";
    report.checks.push_back(std::move(check));
  };
  const ReferenceLevels levels(level_plan(info), runs);
  std::array<double, 3> steps{};
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const Frames& frames = levels.all()[n];
    steps[n] = frames.empty() ? std::nan("") : drop_over_reach(frames.back(), scene);
  }
  report.checks.push_back(discretization_error_check(info, steps, stiffer, kEngineBound));
  for (std::size_t e = 0; e + 1 < list.size(); ++e) {
    add_check(
        list[e], "a heavy strip hangs as in the reference", "relative difference of H / W at rest",
        values[e], steps.back(),
        {kEngineBound, Basis::kTruncation, "what is left of the motion after 2 s, and rounding"});
  }
  add_check(list.back(), "a heavy strip hangs as the elastica", "relative error of H / W at rest",
            values.back(), exact,
            {0.01, Basis::kTruncation, "second order: 0.4 % for 16 cells at Gamma = 5"});
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.plots.push_back(std::move(plot));
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
