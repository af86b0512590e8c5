// A sheet swings from two corners. How fast it does so hardly depends on its stiffness: a solver that stops stiff cloth is seen here.
// Tested by tests/apps/CMakeLists.txt.
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <weft/validation/cases/motion/motion_cases.hpp>
#include <weft/validation/cases/motion/motion_deviations.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/motion/motion_scenes.hpp>
#include <weft/validation/motion/swing.hpp>

namespace weft::validation {
namespace {

constexpr int kSwingNodes = 25;
constexpr double kSwingMass = 0.25;      // [kg]
constexpr double kSwingStep = 1.0 / 60;  // [s]
constexpr int kSwingNumSteps = 180;      // 3 s
constexpr double kMiddle = 1.0;          // [s]
/// Kinetic energy may be 0.9 to 1.05 times what is right: so far from the middle of both.
constexpr double kEnergyMiddle = 0.975;
constexpr double kEnergyBound = 0.075;
constexpr double kTurnBound = 0.1;  // right ones are as far apart, for the cloth waves

/// What is right: up to 1e5 N/m BDF2 in steps of 1/60 s, solved until its equations lack 0.03 m g (RMS) or less, above that velocity Verlet in steps of
/// half the longest stable one (`weft-bench-float64 swing_truth`). Exact motion has 2 to 18 % more energy from 1 to 3 s than the converged step.
struct Right {
  double stiffness;     ///< [N/m]
  double first_energy;  ///< mean kinetic energy to 1 s [J]
  double later_energy;  ///< from 1 to 3 s [J]
  double turning_time;  ///< [s]
};
constexpr std::array kRight = {
    Right{1e2, 0.5410, 0.4456, 0.914}, Right{1e3, 0.5278, 0.4494, 0.906},
    Right{1e4, 0.5300, 0.4708, 0.876}, Right{1e5, 0.5358, 0.4964, 0.948},
    Right{1e6, 0.5518, 0.5428, 0.834}, Right{1e7, 0.5489, 0.5452, 0.907},
};

const EngineChoice kSwingJudged[] = {{"bullet_weft", scenes::StoredPrecision::kFloat32}};

std::string label_of(const CaseInfo& info, const Right& right) {
  return fmt::format("{}_1e{:.0f}", info.id, std::log10(right.stiffness));
}

struct Figure {
  const char* name;
  double right;
  double bound;
  double middle;
  double (*of)(const SwingTrack&);
};

std::array<Figure, 3> figures_of(const Right& right) {
  return {{{"mean kinetic energy, 0 to 1 s", right.first_energy, kEnergyBound, kEnergyMiddle,
            [](const SwingTrack& track) { return track.kinetic_energy(0, kMiddle); }},
           {"mean kinetic energy, 1 to 3 s", right.later_energy, kEnergyBound, kEnergyMiddle,
            [](const SwingTrack& track) { return track.kinetic_energy(kMiddle, 3.0); }},
           {"time of the first turn", right.turning_time, kTurnBound, 1.0,
            [](const SwingTrack& track) { return track.turning_time(); }}}};
}

CheckResult check_of(const CaseInfo& info, const Right& right, const Figure& figure,
                     const EngineChoice& engine, const SwingTrack* track, const SwingTrack& still) {
  const auto deviation = [&](double value) {
    return std::abs(value / figure.right - figure.middle);
  };
  CheckResult check;
  check.case_id = info.id;
  check.engine = engine.title();
  check.claim = "stiff cloth swings as soft cloth does";
  check.metric = fmt::format("{:.0e} N/m: {}, share of what is right from {}", right.stiffness,
                             figure.name, figure.middle);
  check.unit = "1";
  check.formula = fmt::format("{:.4g}", figure.right);
  check.source = right.stiffness <= 1e5 ? "the same step with its equations solved"
                                        : "velocity Verlet in short steps";
  check.measured = track != nullptr ? deviation(figure.of(*track)) : std::nan("");
  check.tolerance = Tolerance{figure.bound, Basis::kModelGap,
                              "energy 0.9 to 1.05 of a converged step, time within 10 %"};
  const double frozen_value = deviation(figure.of(still));
  check.sabotages.push_back({"all stays where it starts", frozen_value,
                             judge(frozen_value, *check.tolerance) == Verdict::kFail});
  check.note = "steps that end before their equations hold";
  return check;
}

}  // namespace

void plan_swing(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs) {
  if (!options.bullet) return;
  for (const Right& right : kRight) {
    const scenes::Scene scene = swinging_sheet(kSwingNodes, kSwingMass, right.stiffness);
    for (const EngineChoice& engine : kSwingJudged) {
      runs.add({engine.label(label_of(info, right)), scene, engine.engine, engine.precision});
    }
  }
}

void evaluate_swing(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                    Report& report) {
  if (!options.bullet) return;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Table table{"Share of what is right",
              {"stiffness [N/m]", "figure", "a rigid plate", "bullet_weft float32"},
              {}};
  for (const Right& right : kRight) {
    const ClothMesh mesh =
        make_mesh(swinging_sheet(kSwingNodes, kSwingMass, right.stiffness).cloths[0]);
    const SwingTrack still(mesh, kSwingStep, frozen(mesh, kSwingNumSteps));
    const SwingTrack plate(mesh, kSwingStep, rigid_plate(mesh, kSwingStep, kSwingNumSteps));
    std::vector<std::optional<SwingTrack>> tracks;
    for (const EngineChoice& engine : kSwingJudged) {
      const History history = load_history(runs, label_of(info, right), engine);
      Places places;
      for (const scenes::SceneState& frame : history.frames) {
        places.push_back(frame.cloths[0].positions);
      }
      tracks.emplace_back();
      if (places.size() > kSwingNumSteps)
        tracks.back().emplace(mesh, kSwingStep, std::move(places));
    }
    for (const Figure& figure : figures_of(right)) {
      std::vector<std::string> row = {fmt::format("{:.0e}", right.stiffness), figure.name,
                                      fmt::format("{:.3f}", figure.of(plate) / figure.right)};
      for (std::size_t e = 0; e < std::size(kSwingJudged); ++e) {
        const SwingTrack* track = tracks[e] ? &*tracks[e] : nullptr;
        CheckResult check = check_of(info, right, figure, kSwingJudged[e], track, still);
        judge_deviating(check, motion_deviations(), kMotionReason, report);
        report.checks.push_back(std::move(check));
        row.push_back(track != nullptr ? fmt::format("{:.3f}", figure.of(*track) / figure.right)
                                       : "blew up");
      }
      table.rows.push_back(std::move(row));
    }
  }
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
