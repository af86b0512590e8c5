// A cloth on ten bodies, in three resolutions, in every engine, beside the reference.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/validation/cases/engines/collision_comparison.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/referee/start_check.hpp>

namespace weft::validation {
namespace collision_sweep {
namespace {

/// The gap that is asked, while the cloth moves, of an engine whose step damps, as a share of the cloth's size [-].
constexpr double kDampedGap = 0.03;
/// [m/s] RMS. The slowest swing has a period of half a second: it goes 0.5 mm to each side, a tenth of 1 % of the size.
constexpr double kRestSpeed = 0.006;

const char* const kFrictionReason =
    "a sliding contact loses a fixed share of its sideways motion at each of Bullet's visits, "
    "which glues it, where Coulomb's law takes mu times the normal impulse";
const char* const kLongStepReason =
    "implicit Euler, which the solver takes while something touches the cloth, damps what changes "
    "within a "
    "step of 1/250 s; where the cloth comes to rest does not depend on the step, and is gated";

bool is_gated(const Comparison& of, const SweepEngine& engine, bool at_rest) {
  if (of.row().slides && !engine.has_coulomb_friction()) return false;
  return at_rest || engine.step_factor == 1;
}

CheckResult base_check(const Comparison& of, const CaseInfo& info, const std::string& engine) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine;
  check.unit = "1";
  check.source = fmt::format("reference solver, velocity Verlet, {:.3g} s, exact surfaces",
                             of.levels().finest_step());
  check.note =
      "the distance field of the shape, contact hardness, friction, or Bullet's link order";
  check.claim = fmt::format("{}, {} x {} nodes", of.row().id, of.nodes(), of.nodes());
  return check;
}

void judge_with(CheckResult& check, Tolerance tolerance) {
  check.tolerance = std::move(tolerance);
  check.verdict = judge(check.measured, *check.tolerance);
}

Tolerance gap_of(const EngineChoice& engine, bool at_rest) {
  if (engine.bounds() == "bullet_soft") {
    return {at_rest ? kSweepGap : kDampedGap, Basis::kModelGap,
            "links are projected one after the other, springs act together; measured up to 1.1 % "
            "in motion, 0.5 % at rest"};
  }
  if (engine.bounds() == "bullet_weft") {
    return {at_rest ? kSweepGap : kDampedGap, Basis::kModelGap,
            "implicit Euler damps a spring by k h / 2 = 5 mN s/m, the scene by 2: measured up to "
            "1.4 % in "
            "motion; at rest, where damping has no say, 0.2 %, and 0.8 % after sliding"};
  }
  return {kSweepGap, Basis::kModelGap,
          "same forces, but planes of contact that are held to the end of a step; "
          "measured up to 0.3 %"};
}

void add_pair(const CaseInfo& info, const Comparison& of, std::size_t e, bool at_rest,
              Report& report) {
  const SweepEngine& engine = of.engines()[e];
  const History& history = of.histories()[e];
  CheckResult check = base_check(of, info, engine.title());
  check.claim += at_rest ? ": rests as the reference does" : ": moves as the reference does";
  check.metric = at_rest
                     ? fmt::format("RMS node distance / cloth size at {:g} s", of.row().duration)
                     : "RMS node distance / cloth size, 0 to 0.5 s";
  check.measured = history.failure.empty() ? of.distance(history.frames, of.reference(), at_rest)
                                           : std::numeric_limits<double>::infinity();
  if (!history.failure.empty()) check.note = history.failure;
  if (is_gated(of, engine, at_rest)) {
    judge_with(check, gap_of(history.engine, at_rest));
    const Frames& wrong = of.wrong(at_rest);
    if (!wrong.empty()) {
      const double measured = of.distance(history.frames, wrong, at_rest);
      const std::string name = (at_rest ? of.row().late : of.row().early)().name;
      const bool noticed =
          std::isfinite(measured) && judge(measured, *check.tolerance) == Verdict::kFail;
      check.sabotages.push_back({name, measured, noticed});
    }
  }
  report.checks.push_back(std::move(check));
}

/// What the reference says of itself: how exact it is, and that it rests.
void add_own(const CaseInfo& info, const Comparison& of, Report& report) {
  CheckResult own = discretization_error_check(
      of.levels(), of.metrics(), {of.window(false), of.window(true)}, kSweepGap, of.is_coarsest());
  own.case_id = info.id;
  own.claim = fmt::format("{}, {} x {} nodes: {}", of.row().id, of.nodes(), of.nodes(), own.claim);
  own.metric += ", 0 to 0.5 s and at rest";
  report.checks.push_back(std::move(own));
  if (of.row().slides) return;
  CheckResult rest = base_check(of, info, "reference float64");
  rest.engine = "reference";
  rest.claim += ": the cloth is at rest";
  rest.metric = fmt::format("RMS speed of the nodes at {:g} s", of.row().duration);
  rest.unit = "m/s";
  rest.measured = of.end_speed();
  judge_with(rest, {kRestSpeed, Basis::kModelGap,
                    "a swing of this speed goes 0.5 mm to each side: a tenth of 1 % of the size"});
  report.checks.push_back(std::move(rest));
}

std::string percent(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.2f}", 100 * ratio) : std::string("-");
}

std::string both(const Comparison& of, const History& history) {
  return percent(of.distance(history.frames, of.reference(), false)) + " / " +
         percent(of.distance(history.frames, of.reference(), true));
}

void add_friction_deviations(const Comparison& of, Report& report) {
  for (std::size_t e = 0; e < of.engines().size(); ++e) {
    if (!of.row().slides || of.engines()[e].has_coulomb_friction()) continue;
    const Frames& frames = of.histories()[e].frames;
    report.deviations.push_back(
        {of.engines()[e].title(), fmt::format("collision_sweep: {}", of.row().id),
         fmt::format("RMS {} % of cloth size within 0.5 s, {} % at {:g} s",
                     percent(of.distance(frames, of.reference(), false)),
                     percent(of.distance(frames, of.reference(), true)), of.row().duration),
         kFrictionReason});
  }
}

/// The largest deviation of each engine that takes long steps, over all rows.
void add_step_deviations(const std::map<std::string, std::pair<double, std::string>>& largest,
                         Report& report) {
  for (const auto& [engine, found] : largest) {
    report.deviations.push_back({engine, "collision_sweep: in motion, with long steps",
                                 fmt::format("RMS up to {} % of cloth size within 0.5 s ({})",
                                             percent(found.first), found.second),
                                 kLongStepReason});
  }
}

Picture picture_of(const Comparison& of, const scenes::SceneState& frame,
                   const std::string& engine) {
  scenes::Renderer renderer(of.metrics().scene());
  scenes::RenderOptions options;
  options.width = 320;
  options.height = 240;
  return {fmt::format("{}: {}", of.row().id, engine), fmt::format("t = {:.2f} s", frame.time),
          scenes::encode_jpeg(renderer.render(frame, options, nullptr))};
}

/// The fast solver with its long step beside the reference.
void add_pictures(const Comparison& of, PictureRow& row) {
  for (std::size_t e = 0; e < of.engines().size(); ++e) {
    const SweepEngine& engine = of.engines()[e];
    const bool is_fast = engine.choice.engine == "bullet_weft" && engine.step_factor > 1 &&
                         engine.choice.precision == scenes::StoredPrecision::kFloat32;
    const bool is_recording = engine.choice.engine == kRecordingEngine;
    if ((!is_fast && !is_recording) || of.histories()[e].frames.empty()) continue;
    row.pictures.push_back(picture_of(of, of.histories()[e].frames.back(), engine.title()));
  }
  if (!of.reference().empty()) {
    row.pictures.push_back(picture_of(of, of.reference().back(), "reference"));
  }
}

/// Rows of the section's two tables.
void add_rows(const Comparison& of, Table& distances, Table& own) {
  const std::vector<std::string> head{of.row().id, fmt::format("{0} x {0}", of.nodes())};
  std::vector<std::string> cells = head;
  for (const History& history : of.histories()) cells.push_back(both(of, history));
  cells.resize(distances.columns.size(), "-");
  distances.rows.push_back(std::move(cells));
  for (const bool at_rest : {false, true}) {
    std::vector<std::string> row = head;
    row.push_back(at_rest ? fmt::format("at {:g} s", of.row().duration) : "0 to 0.5 s");
    for (std::string& cell :
         own_error_cells(of.levels(), of.metrics(), of.window(at_rest), kSweepGap)) {
      row.push_back(std::move(cell));
    }
    own.rows.push_back(std::move(row));
  }
}

/// Whether a row is part of what was asked for: all rows, or that of a recording.
bool is_judged(const CaseOptions& options, const CollisionScene& row, int nodes) {
  return !options.recorded ||
         ask_the_same(options.recorded->scene, written_collision_scene(row, nodes));
}

}  // namespace
}  // namespace collision_sweep

std::vector<scenes::Scene> sweep_scenes(const CaseInfo&) {
  using namespace collision_sweep;
  std::vector<scenes::Scene> scenes;
  for (const CollisionScene& row : collision_scenes()) {
    for (const int nodes : sweep_resolutions(row)) {
      scenes.push_back(written_collision_scene(row, nodes));
    }
  }
  return scenes;
}

void plan_collision_sweep(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace collision_sweep;
  for (const CollisionScene& row : collision_scenes()) {
    for (const int nodes : sweep_resolutions(row)) {
      if (is_judged(options, row, nodes)) Comparison(info, row, nodes).plan(options, runs);
    }
  }
}

void evaluate_collision_sweep(const CaseInfo& info, const CaseOptions& options,
                              const EngineRuns& runs, Report& report) {
  using namespace collision_sweep;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Table distances{"RMS distance to the reference [% of cloth size], 0 to 0.5 s / at rest",
                  {"scene", "nodes"},
                  {}};
  Table own{"The reference's discretization error, RMS over the cloth's size [1]",
            {"scene", "nodes", "time"},
            {}};
  for (const SweepEngine& engine : sweep_engines(collision_scenes()[0], options)) {
    distances.columns.push_back(engine.title());
  }
  for (std::string& column : own_error_columns()) own.columns.push_back(std::move(column));
  PictureRow pictures{"At rest", {}};
  std::map<std::string, std::pair<double, std::string>> long_steps;
  for (const CollisionScene& row : collision_scenes()) {
    for (const int nodes : sweep_resolutions(row)) {
      if (!is_judged(options, row, nodes)) continue;
      Comparison of(info, row, nodes);
      of.load(options, runs);
      add_own(info, of, report);
      if (options.recorded) {
        report.checks.push_back(
            start_check(info, of.metrics().scene(), of.histories().front(), of.reference()));
      }
      for (std::size_t e = 0; e < of.engines().size(); ++e) {
        add_pair(info, of, e, false, report);
        const double moving = report.checks.back().measured;
        add_pair(info, of, e, true, report);
        if (of.engines()[e].step_factor == 1) continue;
        auto& largest = long_steps[of.engines()[e].title()];
        largest = std::max(largest, {moving, row.id});
      }
      add_friction_deviations(of, report);
      add_rows(of, distances, own);
      const bool is_one_of_many = nodes != sweep_resolutions(row).back() || row.slides;
      const bool is_shown = options.pictures && (options.recorded || !is_one_of_many);
      if (is_shown) add_pictures(of, pictures);
    }
  }
  add_step_deviations(long_steps, report);
  section.tables.push_back(std::move(distances));
  section.tables.push_back(std::move(own));
  if (!pictures.pictures.empty()) section.picture_rows.push_back(std::move(pictures));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
