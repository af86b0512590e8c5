// The same scene, the same program: the same bits, run again and on any number of threads.
// Tested by tests/apps/CMakeLists.txt.
#include <array>
#include <set>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/scenes/scene_cases.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>

namespace weft::validation {
namespace determinism {
namespace {

constexpr double kDuration = 1.2;  // [s]: falls, lies down on the sphere, starts to fold

struct Variant {
  const char* name;
  int threads;
};
constexpr std::array kVariants = {Variant{"1 thread", 1}, Variant{"1 thread, again", 1},
                                  Variant{"2 threads", 2}, Variant{"4 threads", 4}};

std::vector<EngineChoice> determinism_engines(bool with_bullet) {
  using scenes::StoredPrecision;
  std::vector<EngineChoice> list;
  if (with_bullet) {
    list = {{"bullet_soft", StoredPrecision::kFloat32},
            {"bullet_soft", StoredPrecision::kFloat64},
            {"bullet_forces", StoredPrecision::kFloat32},
            {"bullet_forces", StoredPrecision::kFloat64}};
  }
  list.push_back({"reference", StoredPrecision::kFloat64});
  return list;
}

std::string label(const EngineChoice& engine, const std::string& variant) {
  std::string text = engine.label("determinism") + "_" + variant;
  for (char& c : text) c = c == ' ' || c == ',' ? '_' : c;
  return text;
}

std::string hash_of(const EngineRuns& runs, const std::string& run_label) {
  const EngineRuns::Outcome& outcome = runs.outcome(run_label);
  if (outcome.exit_code != 0) return fmt::format("exit code {}", outcome.exit_code);
  try {
    return scenes::RecordingReader(outcome.recording).content_hash();
  } catch (const Error& error) {
    return fmt::format("exit code 0, but {}", error.what());
  }
}

}  // namespace
}  // namespace determinism

void plan_determinism(const CaseInfo&, const CaseOptions& options, EngineRuns& runs) {
  using namespace determinism;
  scenes::Scene scene = scenes::load_scene("drape_sphere");
  scene.world.duration = kDuration;
  scenes::Scene moved = scene;
  moved.cloths[0].grid().center.y() += 1e-6;
  for (const EngineChoice& engine : determinism_engines(options.bullet)) {
    for (const Variant& variant : kVariants) {
      runs.add(
          {label(engine, variant.name), scene, engine.engine, engine.precision, variant.threads});
    }
    runs.add({label(engine, "moved"), moved, engine.engine, engine.precision});
  }
}

void evaluate_determinism(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                          Report& report) {
  using namespace determinism;
  const Tolerance tolerance{0, Basis::kExact, "equal bits give equal hashes"};
  Table table{"Content hashes of drape_sphere, 1.2 s", {"engine"}, {}};
  for (const Variant& variant : kVariants) table.columns.emplace_back(variant.name);
  for (const EngineChoice& engine : determinism_engines(options.bullet)) {
    std::set<std::string> hashes;
    std::vector<std::string> row{engine.title()};
    for (const Variant& variant : kVariants) {
      row.push_back(hash_of(runs, label(engine, variant.name)));
      hashes.insert(row.back());
    }
    table.rows.push_back(row);
    CheckResult check;
    check.case_id = info.id;
    check.engine = engine.title();
    check.claim = "the same bits when run again and with 1, 2 and 4 threads";
    check.metric = "number of different recordings beyond the first";
    check.unit = "1";
    check.source = "XXH3-128 over all frames";
    check.measured = static_cast<double>(hashes.size()) - 1;
    if (row[1].starts_with("exit")) check.measured = static_cast<double>(kVariants.size());
    check.tolerance = tolerance;
    check.verdict = judge(check.measured, tolerance);
    check.note = "an order of summation that depends on threads, or an uninitialised value";
    hashes.insert(hash_of(runs, label(engine, "moved")));
    const double sabotaged = static_cast<double>(hashes.size()) - 1;
    check.sabotages.push_back({"cloth starts 1 micrometre higher", sabotaged,
                               judge(sabotaged, tolerance) == Verdict::kFail});
    report.checks.push_back(std::move(check));
  }
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  section.tables.push_back(std::move(table));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
