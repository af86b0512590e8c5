#include <weft/scenes/controllers/pin_path.hpp>

#include <algorithm>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/controllers/collider_path.hpp>

namespace weft::scenes {

bool is_lead(const MovingPin& pin) {
  return pin.path || !pin.to.empty();
}

Vector3<double> carried(const Pose& start, const Pose& now, const Vector3<double>& rest_position) {
  const Vector3<double> arm = rest_position - start.position;
  // Not even by rounding: a frame that does not turn must not move its nodes against each other.
  if (now.orientation.coeffs() == start.orientation.coeffs()) return now.position + arm;
  return now.position + now.orientation * (start.orientation.conjugate() * arm);
}

PinPathController::Lead PinPathController::lead_of(const MovingPin& pin, const Scene& scene) const {
  if (pin.path) {
    PathMotion motion(*pin.path);
    const Pose start = motion.pose(0.0);
    return {std::move(motion), std::nullopt, start};
  }
  for (std::size_t k = 0; k < scene.colliders.size(); ++k) {
    const Collider& collider = scene.colliders[k];
    if (collider.name != pin.to || collider.mass) continue;
    return {std::nullopt, k, start_pose(collider)};
  }
  throw InvalidArgument("cloth '" + scene.cloths[cloth_].name + "': pin to '" + pin.to +
                        "', expected a collider of the scene without a mass");
}

PinPathController::PinPathController(const Scene& scene, std::size_t index) : cloth_(index) {
  const Cloth& cloth = scene.cloths[index];
  const ClothMesh mesh = make_mesh(cloth);
  rest_positions_ = mesh.rest_positions(Eigen::all, mesh.pinned);
  velocities_ = Matrix3X<double>::Zero(3, rest_positions_.cols());
  leads_of_nodes_.resize(mesh.pinned.size());
  for (std::size_t i = 0; i < mesh.pinned.size(); ++i) {
    velocities_.col(static_cast<Eigen::Index>(i)) = mesh.pinned_velocity(i);
  }
  for (const MovingPin& pin : cloth.moving_pins) {
    const bool is_kinematic = is_lead(pin);
    if (is_kinematic) leads_.push_back(lead_of(pin, scene));
    for (const int node : nodes_of(pin.nodes, cloth, mesh)) {
      const auto place = std::lower_bound(mesh.pinned.begin(), mesh.pinned.end(), node);
      auto& lead = leads_of_nodes_[static_cast<std::size_t>(place - mesh.pinned.begin())];
      lead = is_kinematic ? std::optional(leads_.size() - 1) : std::nullopt;
    }
  }
}

void PinPathController::steer(const SceneState&, double end_time, StepCommands& commands) {
  std::vector<Pose> poses;
  for (const Lead& lead : leads_) {
    // A collider that nothing leads stands where it stood.
    poses.push_back(lead.motion ? lead.motion->pose(end_time)
                                : commands.colliders[*lead.collider].value_or(lead.start));
  }
  Matrix3X<double>& positions = commands.cloths[cloth_].pinned_positions;
  positions.resize(3, rest_positions_.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const auto& lead = leads_of_nodes_[static_cast<std::size_t>(i)];
    positions.col(i) =
        lead ? carried(leads_[*lead].start, poses[*lead], rest_positions_.col(i))
             : Vector3<double>(rest_positions_.col(i) + end_time * velocities_.col(i));
  }
}

}  // namespace weft::scenes
