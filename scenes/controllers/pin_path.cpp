#include <weft/scenes/controllers/pin_path.hpp>

#include <algorithm>

namespace weft::scenes {

Vector3<double> carried(const Pose& start, const Pose& now, const Vector3<double>& rest_position) {
  const Vector3<double> arm = rest_position - start.position;
  // Not even by rounding: a frame that does not turn must not move its nodes against each other.
  if (now.orientation.coeffs() == start.orientation.coeffs()) return now.position + arm;
  return now.position + now.orientation * (start.orientation.conjugate() * arm);
}

PinPathController::PinPathController(const Cloth& cloth, std::size_t index) : cloth_(index) {
  const ClothMesh mesh = make_mesh(cloth);
  rest_positions_ = mesh.rest_positions(Eigen::all, mesh.pinned);
  velocities_ = Matrix3X<double>::Zero(3, rest_positions_.cols());
  lead_of_.resize(mesh.pinned.size());
  for (std::size_t i = 0; i < mesh.pinned.size(); ++i) {
    velocities_.col(static_cast<Eigen::Index>(i)) = mesh.pinned_velocity(i);
  }
  for (const MovingPin& pin : cloth.moving_pins) {
    if (pin.path) {
      PathMotion motion(*pin.path);
      const Pose start = motion.pose(0.0);
      leads_.push_back({std::move(motion), start});
    }
    for (const int node : nodes_of(pin.nodes, cloth, mesh)) {
      const auto place = std::lower_bound(mesh.pinned.begin(), mesh.pinned.end(), node);
      auto& lead = lead_of_[static_cast<std::size_t>(place - mesh.pinned.begin())];
      lead = pin.path ? std::optional(leads_.size() - 1) : std::nullopt;
    }
  }
}

void PinPathController::steer(const SceneState&, double end_time, Steering& steering) {
  std::vector<Pose> poses;
  for (const Lead& lead : leads_) poses.push_back(lead.motion.pose(end_time));
  Matrix3X<double>& positions = steering.cloths[cloth_].pinned_positions;
  positions.resize(3, rest_positions_.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const auto& lead = lead_of_[static_cast<std::size_t>(i)];
    positions.col(i) =
        lead ? carried(leads_[*lead].start, poses[*lead], rest_positions_.col(i))
             : Vector3<double>(rest_positions_.col(i) + end_time * velocities_.col(i));
  }
}

}  // namespace weft::scenes
