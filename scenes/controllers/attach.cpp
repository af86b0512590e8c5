#include <weft/scenes/controllers/attach.hpp>

#include <algorithm>

#include <weft/core/error.hpp>
#include <weft/scenes/characters/start_state.hpp>
#include <weft/scenes/controllers/collider_path.hpp>

namespace weft::scenes {
namespace {

void check(const Attach& attach, const Cloth& cloth) {
  if (!(attach.stiffness > 0 && attach.damping >= 0)) {
    throw InvalidArgument("attach: stiffness, expected > 0 N/m; damping, expected >= 0 N s/m");
  }
  if (cloth.tear) {
    throw InvalidArgument("attach: cloth '" + cloth.name + "' tears, expected one that does not");
  }
}

const NodeSet& region_of(const Attach& attach, const ClothMesh& mesh) {
  for (const NodeSet& set : mesh.node_sets) {
    if (set.name == attach.region) return set;
  }
  throw InvalidArgument("attach: region = '" + attach.region + "', expected one of cloth '" +
                        attach.cloth + "'");
}

}  // namespace

AttachController::AttachController(const Attach& attach, std::size_t cloth, const Scene& scene)
    : attach_(attach), cloth_(cloth) {
  const Cloth& described = scene.cloths.at(cloth);
  check(attach, described);
  const auto found = std::find_if(scene.colliders.begin(), scene.colliders.end(),
                                  [&](const Collider& c) { return c.name == attach.to; });
  if (found == scene.colliders.end()) {
    throw InvalidArgument("attach: to = '" + attach.to + "', expected a collider of the scene");
  }
  collider_ = static_cast<std::size_t>(found - scene.colliders.begin());
  is_free_ = found->mass.has_value();
  const ClothMesh mesh = make_mesh(described);
  const Matrix3X<double> places = start_state(described, mesh).positions;
  const Pose start = start_pose(*found);
  for (const int node : region_of(attach, mesh).nodes) {
    if (std::binary_search(mesh.pinned.begin(), mesh.pinned.end(), node)) continue;
    nodes_.push_back(node);
    arms_.push_back(start.orientation.conjugate() * (places.col(node) - start.position));
  }
}

void AttachController::steer(const SceneState& state, double end_time, StepCommands& commands) {
  const ClothState& cloth = state.cloths[cloth_];
  const RigidState& body = state.rigids[collider_];
  const std::optional<Pose>& led = commands.colliders[collider_];
  const double time_step = end_time - state.time;
  Matrix3X<double>& forces = commands.cloths[cloth_].node_forces;
  if (forces.cols() == 0) forces.setZero(3, cloth.positions.cols());
  Push& push = commands.pushes[collider_];
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int node = nodes_[i];
    const Vector3<double> arm = body.orientation * arms_[i];
    const Vector3<double> place = body.position + arm;
    Vector3<double> velocity(0, 0, 0);
    if (led) velocity = (led->position + led->orientation * arms_[i] - place) / time_step;
    if (is_free_) velocity = body.velocity + body.angular_velocity.cross(arm);
    const Vector3<double> position = cloth.positions.col(node);
    const Vector3<double> force = attach_.stiffness * (place - position) +
                                  attach_.damping * (velocity - cloth.velocities.col(node));
    forces.col(node) += force;
    if (!is_free_) continue;
    push.force -= force;
    push.torque -= (position - body.position).cross(force);
  }
}

}  // namespace weft::scenes
