// What a program that shares no line with Weft and Bullet says about the same cloth.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/scenes/scene_metrics.hpp>
#include <weft/validation/cases/support/sabotage.hpp>
#include <weft/validation/peers/peer_result.hpp>

namespace weft::validation {
namespace third_opinion {
namespace {

std::vector<PeerResult> peer_results() {
  std::vector<PeerResult> results;
  for (const std::string_view text : peer_texts()) results.push_back(read_peer_result(text));
  return results;
}

std::string label_of(const PeerResult& peer) {
  return "peer_" + peer.scene.name;
}

std::vector<EngineChoice> engines_of(bool with_bullet) {
  std::vector<EngineChoice> engines = cross_validated_engines(with_bullet);
  std::erase_if(engines, [](const EngineChoice& engine) {
    return engine.engine != "reference" && engine.precision == scenes::StoredPrecision::kFloat64;
  });
  return engines;
}

/// RMS distance to the peer over the cloth's size at each of the peer's times [-].
Series distances(const SceneMetrics& metrics, const PeerResult& peer, const History& history) {
  Series series{history.engine.title(), {}, {}};
  for (std::size_t i = 0; i < peer.times.size(); ++i) {
    const auto frame =
        static_cast<std::size_t>(std::lround(peer.times[i] / metrics.scene().world.frame_interval));
    if (frame >= history.frames.size()) break;
    scenes::SceneState state = history.frames[frame];
    state.cloths.front().positions = peer.positions[i];
    series.x.push_back(history.frames[frame].time);
    series.y.push_back(metrics.at(Quantity::kRmsDistance, history.frames[frame], state));
  }
  return series;
}

CheckResult shown(const CaseInfo& info, const PeerResult& peer, const History& history,
                  const Series& series) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = history.engine.title();
  check.claim = fmt::format("{}: distance to {}", peer.scene.name, peer.peer);
  check.unit = "1";
  check.source = "validation/peers/run.sh; mapping and settings in the tables of the case";
  check.note = history.failure;
  check.metric = fmt::format("RMS node distance / cloth size at {:g} s", peer.times.back());
  const bool whole = series.y.size() == peer.times.size();
  check.measured = whole ? series.y.back() : std::nan("");
  return check;
}

/// Largest of the series up to a time [s]; infinite if it ends before.
double largest_until(const Series& series, double end) {
  double value = 0.0;
  double covered = -1.0;
  for (std::size_t i = 0; i < series.x.size() && series.x[i] < end + 0.01; ++i) {
    value = std::max(value, series.y[i]);
    covered = series.x[i];
  }
  return covered > end - 0.01 ? value : std::numeric_limits<double>::infinity();
}

/// Where nothing is chaotic yet two programs that know nothing of each other must say the same.
CheckResult check_early(const CaseInfo& info, const PeerResult& peer, const SceneMetrics& metrics,
                        const History& reference) {
  constexpr double kEnd = 0.5;  // [s]
  CheckResult check;
  check.case_id = info.id;
  check.engine = reference.engine.title();
  check.claim = fmt::format("{} moves as in {}", peer.scene.name, peer.peer);
  check.metric = fmt::format("RMS node distance / cloth size, 0 to {:g} s", kEnd);
  check.unit = "1";
  check.source = "validation/peers/run.sh";
  check.tolerance = Tolerance{
      0.015, Basis::kModelGap,
      "Blender steps implicitly, to first order, with 1/4000 s, and Weft's reference with "
      "1/2000 s; measured 0.005"};
  check.measured = largest_until(distances(metrics, peer, reference), kEnd);
  check.verdict = judge(check.measured, *check.tolerance);
  check.note = reference.failure.empty() ? "the mapping of units, in the tables of the case"
                                         : reference.failure;
  History wrong;
  wrong.engine = reference.engine;
  wrong.frames = run_sabotaged(peer.scene, damping_sign(), kEnd);
  const double off = largest_until(distances(metrics, peer, wrong), kEnd);
  check.sabotages.push_back({damping_sign().name, off,
                             std::isfinite(off) && judge(off, *check.tolerance) == Verdict::kFail});
  return check;
}

void add_tables(Section& section, const PeerResult& peer) {
  Table mapping{fmt::format("{}: how {} was given the material", peer.scene.name, peer.peer),
                {"mapping"},
                {}};
  for (const std::string& line : peer.mapping) mapping.rows.push_back({line});
  Table settings{
      fmt::format("{}: settings of {}", peer.scene.name, peer.peer), {"setting", "value"}, {}};
  for (const auto& [name, value] : peer.settings) settings.rows.push_back({name, value});
  Table calibration{fmt::format("{}: is the mapping right", peer.scene.name),
                    {"motion with a closed form", "measured in the peer", "expected"},
                    {}};
  for (const PeerResult::Calibration& check : peer.calibration) {
    calibration.rows.push_back(
        {check.what, fmt::format("{:.6g}", check.measured), fmt::format("{:.6g}", check.expected)});
  }
  section.tables.push_back(std::move(calibration));
  section.tables.push_back(std::move(mapping));
  section.tables.push_back(std::move(settings));
}

}  // namespace
}  // namespace third_opinion

void plan_third_opinion(const CaseInfo&, const CaseOptions& options, EngineRuns& runs) {
  using namespace third_opinion;
  for (const PeerResult& peer : peer_results()) {
    for (const EngineChoice& engine : engines_of(options.bullet)) {
      runs.add({engine.label(label_of(peer)), peer.scene, engine.engine, engine.precision});
    }
  }
}

void evaluate_third_opinion(const CaseInfo& info, const CaseOptions& options,
                            const EngineRuns& runs, Report& report) {
  using namespace third_opinion;
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  for (const PeerResult& peer : peer_results()) {
    const SceneMetrics metrics(peer.scene);
    Plot plot{fmt::format("{}: RMS distance to {}", peer.scene.name, peer.peer),
              "time [s]",
              "distance / cloth size [1]",
              false,
              true,
              {}};
    for (const EngineChoice& engine : engines_of(options.bullet)) {
      const History history = load_history(runs, label_of(peer), engine);
      Series series = distances(metrics, peer, history);
      report.checks.push_back(shown(info, peer, history, series));
      if (engine.engine == "reference" && peer.scene.name == "hang") {
        report.checks.push_back(check_early(info, peer, metrics, history));
      }
      if (!series.x.empty()) plot.series.push_back(std::move(series));
    }
    section.plots.push_back(std::move(plot));
    add_tables(section, peer);
  }
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
