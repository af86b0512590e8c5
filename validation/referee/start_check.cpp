#include <weft/validation/referee/start_check.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <weft/scenes/characters/start_state.hpp>
#include <weft/scenes/controllers/collider_path.hpp>

namespace weft::validation {
namespace {

/// Largest distance of a node, or of a rigid body's center, from where the scene starts it [m]; NaN if a place is not finite.
double distance_to_start(const scenes::Scene& scene, const scenes::SceneState& state) {
  double largest = 0.0;
  const auto look_at = [&](double distance) {
    largest = std::isnan(distance) ? distance : std::max(largest, distance);
  };
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const scenes::Cloth& cloth = scene.cloths[c];
    const Matrix3X<double> start = scenes::start_state(cloth, scenes::make_mesh(cloth)).positions;
    for (Eigen::Index i = 0; i < start.cols(); ++i) {
      look_at((state.cloths[c].positions.col(i) - start.col(i)).norm());
    }
  }
  for (std::size_t r = 0; r < scene.colliders.size(); ++r) {
    look_at((state.rigids[r].position - scenes::start_pose(scene.colliders[r]).position).norm());
  }
  return largest;
}

}  // namespace

CheckResult start_check(const CaseInfo& info, const scenes::Scene& scene, const History& recorded,
                        const Frames& reference) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = recorded.engine.title();
  check.claim = "starts where the scene starts";
  check.metric = "largest node distance at 0 s";
  check.unit = "m";
  check.source = "the scene";
  check.tolerance = Tolerance{scenes::start_tolerance(scene), Basis::kRoundoff,
                              "1e-5 of the largest cloth's size: text with six digits and single "
                              "precision stay below"};
  check.note = "another order of nodes, unit or axis, or frames that begin too late";
  check.measured = recorded.frames.empty() ? std::numeric_limits<double>::quiet_NaN()
                                           : distance_to_start(scene, recorded.frames.front());
  check.verdict = judge(check.measured, *check.tolerance);
  const double late = reference.size() < 2 ? std::numeric_limits<double>::quiet_NaN()
                                           : distance_to_start(scene, reference[1]);
  check.sabotages.push_back(
      {"one frame too late", late,
       std::isfinite(late) && judge(late, *check.tolerance) == Verdict::kFail});
  return check;
}

}  // namespace weft::validation
