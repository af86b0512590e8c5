#include <weft/validation/cases/engines/collision_comparison.hpp>

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace weft::validation {
namespace collision_comparison {
namespace {

constexpr std::array kNodes = {12, 18, 26};  ///< along each side: every 55, 35 and 24 mm
constexpr int kLongStep = 8;                 ///< 1/250 s, for an engine that needs no short ones

scenes::Scene edited(scenes::Scene scene, const Sabotage& sabotage) {
  sabotage.edit_scene(scene);
  return scene;
}

}  // namespace
}  // namespace collision_comparison

std::string SweepEngine::title() const {
  using namespace collision_comparison;
  return step_factor == 1 ? choice.title()
                          : fmt::format("{}, {} x step", choice.title(), step_factor);
}

std::string SweepEngine::id(const std::string& run) const {
  using namespace collision_comparison;
  return step_factor == 1 ? run : fmt::format("{}_x{}", run, step_factor);
}

bool SweepEngine::has_coulomb_friction() const {
  using namespace collision_comparison;
  return choice.bounds() != "bullet_soft";
}

std::vector<SweepEngine> sweep_engines(const CollisionScene& scene, const CaseOptions& options) {
  using namespace collision_comparison;
  if (options.recorded) return {{recording_choice(options)}};
  if (!options.bullet) return {};
  std::vector<SweepEngine> list{{{"bullet_weft", kFloat32}},
                                {{"bullet_weft", kFloat32}, kLongStep},
                                {{"bullet_weft", kFloat64}, kLongStep},
                                {{"bullet_forces", kFloat32}},
                                {{"bullet_forces", kFloat64}},
                                {{"bullet_soft", kFloat32}}};
  if (!scene.is_kinematic) list.push_back({{"bullet_deformable", kFloat64}});
  return list;
}

std::vector<int> sweep_resolutions(const CollisionScene& scene) {
  using namespace collision_comparison;
  if (scene.slides) return {kNodes[1]};  // there to show a size, which one resolution does
  return {kNodes.begin(), kNodes.end()};
}

Comparison::Comparison(const CaseInfo& info, const CollisionScene& row, int nodes)
    : row_(row),
      nodes_(nodes),
      id_(fmt::format("{}_{}_{}", info.id, row.id, nodes)),
      metrics_(make_collision_scene(row, nodes)) {}

bool Comparison::is_coarsest() const {
  using namespace collision_comparison;
  return nodes_ == sweep_resolutions(row_).front();
}

LevelPlan Comparison::level_plan() const {
  using namespace collision_comparison;
  return {id_, metrics_.scene(), row_.finest_division};
}

void Comparison::plan(const CaseOptions& options, EngineRuns& runs) const {
  using namespace collision_comparison;
  const scenes::Scene& scene = metrics_.scene();
  for (const SweepEngine& engine : sweep_engines(row_, options)) {
    scenes::Scene own = scene;
    own.world.time_step *= engine.step_factor;
    plan_run(options, engine.id(id_), engine.choice, own, runs);
  }
  plan_levels(level_plan(), runs);
  if (!has_wrong_runs(options)) return;
  const auto add_wrong = [&](const char* name, const Sabotage& sabotage) {
    runs.add({kReference.label(id_ + name), edited(scene, sabotage), kReference.engine,
              kReference.precision});
  };
  add_wrong("_wrong_early", row_.early());
  add_wrong("_wrong_late", row_.late());
}

void Comparison::load(const CaseOptions& options, const EngineRuns& runs) {
  using namespace collision_comparison;
  levels_ = {ReferenceLevels(level_plan(), runs)};
  engines_ = sweep_engines(row_, options);
  for (const SweepEngine& engine : engines_) {
    histories_.push_back(load_history(runs, engine.id(id_), engine.choice));
  }
  if (!has_wrong_runs(options)) return;
  wrong_early_ = load_history(runs, id_ + "_wrong_early", kReference).frames;
  wrong_late_ = load_history(runs, id_ + "_wrong_late", kReference).frames;
}

Window Comparison::window(bool at_rest) const {
  using namespace collision_comparison;
  if (at_rest) return {Quantity::kRmsDistance, row_.duration, row_.duration};
  return {Quantity::kRmsDistance, 0.0, kEarlyEnd};
}

double Comparison::distance(const Frames& a, const Frames& b, bool at_rest) const {
  using namespace collision_comparison;
  const Window of = window(at_rest);
  return metrics_.largest(of.quantity, a, b, of.begin, of.end);
}

double Comparison::end_speed() const {
  using namespace collision_comparison;
  if (reference().empty()) return std::numeric_limits<double>::infinity();
  return std::sqrt(reference().back().cloths[0].velocities.colwise().squaredNorm().mean());
}

}  // namespace weft::validation
