// A ball flies into a free cloth, without gravity and without drag: the momentum of both together
// must not change.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/engine_cases.hpp>

namespace weft::validation {
namespace momentum_case {
namespace {

constexpr double kDuration = 0.5;  // [s]: the ball meets the cloth after 0.25 s

struct Judged {
  EngineChoice engine;
  Tolerance tolerance;
  int steps_per_second = 0;  ///< 0: the scene's own

  [[nodiscard]] std::string title() const {
    return steps_per_second > 0 ? fmt::format("{}, 1/{} s", engine.title(), steps_per_second)
                                : engine.title();
  }
  [[nodiscard]] std::string run_id(const CaseInfo& info) const {
    return steps_per_second > 0 ? fmt::format("{}_{}", info.id, steps_per_second)
                                : std::string(info.id);
  }
};

std::vector<Judged> momentum_engines(bool with_bullet) {
  const Tolerance rounding{1e-9, Basis::kRoundoff, "equal and opposite impulses in each contact"};
  const Tolerance single{1e-4, Basis::kRoundoff,
                         "velocities from differences of single-precision positions"};
  const Tolerance solver{1e-3, Basis::kTruncation,
                         "Bullet ends its conjugate gradients at a residual, not at zero"};
  const Tolerance implicit{0.01, Basis::kModelGap,
                           "contact of an implicit step is predicted with an effective mass"};
  const Tolerance tied{
      0.02, Basis::kModelGap,
      "the ball's inertia is shared out over its contacts; impulses are what they have held"};
  std::vector<Judged> list;
  const auto add = [&](const char* engine, scenes::StoredPrecision precision,
                       const Tolerance& tolerance) {
    list.push_back({EngineChoice{engine, precision}, tolerance, 0});
  };
  if (with_bullet) {
    add("bullet_forces", kFloat32, single);
    add("bullet_forces", kFloat64, rounding);
    add("bullet_weft", kFloat32, tied);
    add("bullet_weft", kFloat64, tied);
    for (const int steps : {30, 60, 120, 240}) {
      for (const auto precision : {kFloat32, kFloat64}) {
        list.push_back({EngineChoice{"bullet_weft", precision}, tied, steps});
      }
    }
    add("bullet_deformable", kFloat64, solver);
    add("bullet_deformable_implicit", kFloat64, implicit);
  }
  add("reference", kFloat64, rounding);
  return list;
}

scenes::Scene collision(int steps_per_second) {
  scenes::Scene scene = scenes::load_scene("ball_on_cloth");
  scene.world.gravity.setZero();
  scene.world.duration = kDuration;
  scenes::Cloth& cloth = scene.cloths[0];
  cloth.pins.clear();
  std::erase_if(cloth.laws, [](const forces::LawSpecification& law) {
    return law.law == "gravity" || law.law == "velocity_damping";
  });
  if (steps_per_second > 0) {
    scene.world.time_step = 1.0 / steps_per_second;
    scene.world.frame_interval = 1.0 / 30;
  }
  return scene;
}

Vector3<double> momentum(const scenes::SceneState& state, const scenes::Scene& scene,
                         bool with_ball) {
  const ClothMesh mesh = make_mesh(scene.cloths[0]);
  Vector3<double> sum = state.cloths[0].velocities * mesh.masses;
  if (with_ball) sum += *scene.colliders[0].mass * state.rigids[0].velocity;
  return sum;
}

/// Largest change over the run, over the ball's momentum at the start.
double largest_change(const Frames& frames, const scenes::Scene& scene, bool with_ball) {
  if (frames.empty()) return std::nan("");
  const Vector3<double> start = momentum(frames.front(), scene, with_ball);
  const double scale = *scene.colliders[0].mass * scene.colliders[0].velocity.norm();
  double largest = 0;
  for (const scenes::SceneState& frame : frames) {
    largest = std::max(largest, (momentum(frame, scene, with_ball) - start).norm() / scale);
  }
  return largest;
}

}  // namespace
}  // namespace momentum_case

void plan_momentum(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  using namespace momentum_case;
  for (const Judged& judged : momentum_engines(options.bullet)) {
    runs.add({judged.engine.label(judged.run_id(info)), collision(judged.steps_per_second),
              judged.engine.engine, judged.engine.precision});
  }
}

void evaluate_momentum(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                       Report& report) {
  using namespace momentum_case;
  const scenes::Scene scene = collision(0);
  Plot plot{"Momentum of the ball and the cloth together",
            "time [s]",
            "vertical momentum / the ball's at the start [1]",
            false,
            false,
            {}};
  for (const Judged& judged : momentum_engines(options.bullet)) {
    const History history = load_history(runs, judged.run_id(info), judged.engine);
    CheckResult check;
    check.case_id = info.id;
    check.engine = judged.title();
    check.claim = "a ball and a cloth keep their momentum together";
    check.metric = "largest change of the sum over the ball's momentum, 0 to 0.5 s";
    check.unit = "1";
    check.formula = "sum m v = const";
    check.source = "Newton's third law";
    check.measured = largest_change(history.frames, scene, true);
    check.tolerance = judged.tolerance;
    check.verdict = judge(check.measured, judged.tolerance);
    const double without_ball = largest_change(history.frames, scene, false);
    check.sabotages.push_back({"the ball is not counted", without_ball,
                               judge(without_ball, judged.tolerance) == Verdict::kFail});
    check.note = "the impulse on the rigid body, or a force of a law that does not sum to zero";
    report.checks.push_back(std::move(check));
    Series series{judged.title(), {}, {}};
    for (const scenes::SceneState& frame : history.frames) {
      series.x.push_back(frame.time);
      series.y.push_back(momentum(frame, scene, true).y() / (*scene.colliders[0].mass));
    }
    plot.series.push_back(std::move(series));
  }
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.plots.push_back(std::move(plot));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
