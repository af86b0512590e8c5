// Cloths on a slope: which stick and which slide over a grid of frictions and angles, how fast those slide, and
// whether those that stick stay.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/engine_cases.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {
namespace incline {
namespace {

constexpr int kFrictions = 20;
constexpr int kAngles = 20;
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kDuration = 0.5;  // [s]
constexpr double kSlid = 2e-3;     // [m]: a sixth of the way of the slowest cloth that slides
constexpr double kSpacing = 0.22;  // [m] between the middles of cloths of 0.2 m
constexpr double kMargin = 0.01;   // part of the threshold at which creep is measured

double friction_at(int i) {
  return 0.05 * (i + 1);
}
/// [deg]. No cell of the grid is closer to tan(angle) = mu than 1 %.
double angle_at(int j) {
  return 2.7 + 2.42 * j;
}
double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

/// One cloth per friction, side by side on a plane; gravity is turned instead of the plane, downhill along x.
scenes::Scene slope(double angle, const std::vector<double>& frictions) {
  scenes::Scene scene = scenes::load_scene("drop_ground");
  scene.name = "incline";
  scene.summary = "Shows flat cloths of different friction on a slope";
  scene.world.duration = kDuration;
  scene.world.gravity = kGravity * Vector3<double>(std::sin(angle), -std::cos(angle), 0);
  scene.colliders[0].friction = 1.0;
  scenes::Cloth cloth = scene.cloths[0];
  ClothGrid& grid = cloth.grid();
  grid.nodes = {3, 3};
  grid.size = {0.2, 0.2};
  grid.u_axis = {1, 0, 0};
  grid.total_mass = 0.01;
  cloth.velocity.setZero();
  std::erase_if(cloth.laws, [](const forces::LawSpecification& law) {
    return law.law == "velocity_damping" || law.law == "spring_damping";
  });
  const Vector3<double>& g = scene.world.gravity;
  for (forces::LawSpecification& law : cloth.laws) {
    if (law.law == "gravity") law.parameters["acceleration"] = {g.x(), g.y(), g.z()};
  }
  scene.cloths.clear();
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    cloth.name = fmt::format("cloth_{}", i);
    cloth.friction = frictions[i];
    // Around the origin: single precision resolves 5e-7 m at 5 m, which is worth a fortieth of a node's weight here.
    const double place = static_cast<double>(i) - 0.5 * static_cast<double>(frictions.size() - 1);
    cloth.grid().center = {0, cloth.collision_margin, kSpacing * place};
    scene.cloths.push_back(cloth);
  }
  return scenes::with_bullets_time_step(scene);
}

scenes::Scene row_scene(int j) {
  std::vector<double> frictions;
  for (int i = 0; i < kFrictions; ++i) frictions.push_back(friction_at(i));
  return slope(radians(angle_at(j)), frictions);
}

/// Cloths a hundredth below their threshold, at every other angle's friction.
scenes::Scene creep_scene() {
  std::vector<double> frictions;
  const double angle = radians(20.0);
  for (int i = 0; i < kFrictions; ++i) {
    frictions.push_back(std::tan(angle) / (1 - kMargin) * (1 + 0.05 * i));
  }
  return slope(angle, frictions);
}

std::vector<EngineChoice> incline_engines(bool with_bullet) {
  std::vector<EngineChoice> list;
  if (with_bullet) {
    list = {{"bullet_soft", kFloat32},   {"bullet_forces", kFloat32},
            {"bullet_forces", kFloat64}, {"bullet_weft", kFloat32},
            {"bullet_weft", kFloat64},   {"bullet_deformable", kFloat64}};
  }
  list.push_back({"reference", kFloat64});
  return list;
}

std::string label_of(const CaseInfo& info, const EngineChoice& engine, int j) {
  return engine.label(fmt::format("{}_{}", info.id, j));
}

/// Way of the middle of each cloth down the slope [m]; NaN where a run has no end.
using Ways = std::vector<double>;

Ways ways_of(const Frames& frames) {
  Ways ways(kFrictions, std::nan(""));
  if (frames.empty() || frames.back().time < 0.99 * kDuration) return ways;
  for (std::size_t i = 0; i < ways.size() && i < frames.back().cloths.size(); ++i) {
    ways[i] = frames.back().cloths[i].positions.row(0).mean() -
              frames.front().cloths[i].positions.row(0).mean();
  }
  return ways;
}

struct Grid {
  std::vector<Ways> ways;  ///< by angle
  int wrong = 0;           ///< cells in the wrong class
  double sliding_error =
      0.0;                  ///< largest relative error of the acceleration of a cloth that slides
  double mean_error = 0.0;  ///< and its mean
};

/// The way of modified Euler under a constant acceleration is a h^2 n (n + 1) / 2.
Grid judge_grid(std::vector<Ways> ways, double time_step) {
  Grid grid{std::move(ways), 0, 0.0, 0.0};
  const double n = std::round(kDuration / time_step);
  int sliding = 0;
  for (int j = 0; j < kAngles; ++j) {
    for (int i = 0; i < kFrictions; ++i) {
      const double way = grid.ways[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
      const double angle = radians(angle_at(j));
      const double exact = kGravity * (std::sin(angle) - friction_at(i) * std::cos(angle));
      const bool must_slide = exact > 0;
      if ((way > kSlid) != must_slide || std::isnan(way)) ++grid.wrong;
      if (!must_slide) continue;
      const double error = std::abs(way / (time_step * time_step * n * (n + 1) / 2) / exact - 1);
      if (!(error <= grid.sliding_error)) grid.sliding_error = error;
      grid.mean_error += error;
      ++sliding;
    }
  }
  grid.mean_error /= sliding;
  return grid;
}

Table table_of(const EngineChoice& engine, const Grid& grid) {
  Table table{engine.title() + " by angle and mu: s slides, . sticks, ! in the wrong class",
              {"angle [deg]"},
              {}};
  // Twenty columns fit a page of 1200 pixels without the leading zero.
  for (int i = 0; i < kFrictions; ++i) {
    const std::string text = fmt::format("{:.2f}", friction_at(i));
    table.columns.push_back(text.starts_with("0") ? text.substr(1) : text.substr(0, 3));
  }
  for (int j = 0; j < kAngles; ++j) {
    std::vector<std::string> row{fmt::format("{:.1f}", angle_at(j))};
    for (int i = 0; i < kFrictions; ++i) {
      const double way = grid.ways[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
      const bool slides = way > kSlid;
      const bool must_slide = std::tan(radians(angle_at(j))) > friction_at(i);
      row.push_back(std::string(slides ? "s" : ".") + (slides == must_slide ? "" : "!"));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Sabotage frictions_scaled(double factor) {
  Sabotage sabotage{fmt::format("friction {:+.0f} %", 100 * (factor - 1))};
  sabotage.edit_scene = [factor](scenes::Scene& scene) {
    for (scenes::Cloth& cloth : scene.cloths) cloth.friction *= factor;
  };
  return sabotage;
}

Grid sabotaged_grid(const Sabotage& sabotage) {
  std::vector<Ways> ways;
  for (int j = 0; j < kAngles; ++j) {
    ways.push_back(ways_of(run_sabotaged(row_scene(j), sabotage, kDuration)));
  }
  return judge_grid(std::move(ways), row_scene(0).world.time_step);
}

/// Largest speed of a node from half time on [m/s].
double creep_of(const Frames& frames) {
  double largest = frames.empty() ? std::nan("") : 0.0;
  for (const scenes::SceneState& frame : frames) {
    if (frame.time < kDuration / 2) continue;
    for (const auto& cloth : frame.cloths) {
      const double speed = cloth.velocities.colwise().norm().maxCoeff();
      if (!(speed <= largest)) largest = speed;
    }
  }
  return largest;
}

CheckResult check_of(const CaseInfo& info, const EngineChoice& engine, const std::string& claim,
                     const std::string& metric, const std::string& formula) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine.title();
  check.claim = claim;
  check.metric = metric;
  check.unit = "1";
  check.formula = formula;
  check.source = "Coulomb friction of a body that moves as a whole";
  check.note = "tangential impulses, the friction product, or a contact that is lost";
  return check;
}

/// Bullet's own contact in the classic world has no Coulomb friction: it is shown. That of the other engines is Weft's.
bool is_gated(const EngineChoice& engine) {
  return engine.engine != "bullet_soft";
}

Tolerance sliding_tolerance(const EngineChoice& engine) {
  if (engine.precision == kFloat32) {
    return {0.05, Basis::kRoundoff,
            "places in single precision over h^2 are a hundredth of the little force that is left "
            "1 % above the threshold"};
  }
  if (engine.engine == "bullet_weft") {
    return {1e-4, Basis::kModelGap,
            "a cloth that begins to slide has up to mu g h / 300 too much speed"};
  }
  return {engine.engine == "reference" ? 1e-12 : 1e-10, Basis::kRoundoff,
          "the scheme's own sum of steps; at 1 % above the threshold a hundred roundings are left"};
}

Tolerance creep_tolerance(const EngineChoice& engine) {
  if (engine.engine == "bullet_weft" || engine.precision == kFloat32) {
    return {1e-3, Basis::kRoundoff,
            "a node that sticks is held where it was, to single precision over a time step"};
  }
  return {engine.engine == "reference" ? 5e-14 : 1e-11, Basis::kRoundoff,
          "a friction that is exact has none but rounding"};
}

void add(CheckResult check, const EngineChoice& engine, double measured, const Tolerance& tolerance,
         const std::vector<std::pair<std::string, double>>& sabotages, Report& report) {
  check.measured = measured;
  if (is_gated(engine)) {
    check.tolerance = tolerance;
    check.verdict = judge(measured, tolerance);
    for (const auto& [name, value] : sabotages) {
      check.sabotages.push_back({name, value, judge(value, tolerance) == Verdict::kFail});
    }
  }
  report.checks.push_back(std::move(check));
}

}  // namespace
}  // namespace incline

void plan_incline(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace incline;
  for (const EngineChoice& engine : incline_engines(options.bullet)) {
    for (int j = 0; j < kAngles; ++j) {
      runs.add({label_of(info, engine, j), row_scene(j), engine.engine, engine.precision});
    }
    runs.add({label_of(info, engine, kAngles), creep_scene(), engine.engine, engine.precision});
  }
}

void evaluate_incline(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                      Report& report) {
  using namespace incline;
  const double time_step = row_scene(0).world.time_step;
  const Grid rougher = sabotaged_grid(frictions_scaled(1.03));
  const double slower = creep_of(run_sabotaged(creep_scene(), frictions_scaled(0.97), kDuration));
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  const auto load = [&](const EngineChoice& engine, int j) {
    return load_history(runs, fmt::format("{}_{}", info.id, j), engine).frames;
  };
  for (const EngineChoice& engine : incline_engines(options.bullet)) {
    std::vector<Ways> ways;
    for (int j = 0; j < kAngles; ++j) ways.push_back(ways_of(load(engine, j)));
    const Grid grid = judge_grid(std::move(ways), time_step);
    add(check_of(info, engine, "cloths on a slope stick and slide as Coulomb's law says",
                 "cells of 20 x 20 (mu, angle) in the wrong class", "sticks iff tan(angle) <= mu"),
        engine, grid.wrong, Tolerance{0, Basis::kExact, "a count"},
        {{"friction +3 %", static_cast<double>(rougher.wrong)}}, report);
    add(check_of(info, engine, "a cloth slides with Coulomb's acceleration",
                 "largest relative error of the way in 0.5 s, over all cells that slide",
                 "a = g (sin(angle) - mu cos(angle))"),
        engine, grid.sliding_error, sliding_tolerance(engine),
        {{"friction +3 %", rougher.sliding_error}}, report);
    CheckResult creep = check_of(info, engine, "a cloth 1 % below its threshold does not creep",
                                 "largest speed of a node from 0.25 s to 0.5 s", "0");
    creep.unit = "m/s";
    const double crept = creep_of(load(engine, kAngles));
    add(std::move(creep), engine, crept, creep_tolerance(engine), {{"friction -3 %", slower}},
        report);
    section.tables.push_back(table_of(engine, grid));
    if (is_gated(engine)) continue;
    report.deviations.push_back(
        {engine.title(), "incline: sticking, sliding and creep over 20 x 20 (mu, angle)",
         fmt::format(
             "{} of 400 cells in the wrong class; way of a sliding cloth off by {:.0f} % in the "
             "mean; creep {:.2g} m/s at 1 % below the threshold",
             grid.wrong, 100 * grid.mean_error, crept),
         "each visit of a sliding contact takes away a fixed share of the sideways motion, not mu "
         "times the "
         "normal force: a cloth beyond its threshold creeps instead of gaining speed"});
  }
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
