#include <weft/engines/bullet/bullet_bodies.hpp>

#include <utility>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/classic/nodes/pinned_nodes.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/core/error.hpp>
#include <weft/engines/blow_up_check.hpp>
#include <weft/engines/bullet/bullet_shapes.hpp>
#include <weft/scenes/characters/start_state.hpp>

namespace weft::scenes {
namespace {

using bridge::from_bullet;
using bridge::to_bullet;

void lead_collider(const Pose& pose, const Vector3<double>& offset, btRigidBody& body) {
  if (!body.isStaticOrKinematicObject()) {
    throw InvalidArgument("step commands: a collider that is led has a mass, expected one without");
  }
  // One that stood still so far: led by a hand, and not by the scene.
  body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  const Eigen::Quaternion<btScalar> q = pose.orientation.cast<btScalar>();
  const btVector3 place = to_bullet(pose.position + pose.orientation * offset);
  // Bullet derives the velocity that friction needs from the last two of these.
  body.setWorldTransform(btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), place));
}

void push_collider(const Push& push, const Vector3<double>& offset, btRigidBody& body) {
  if (body.isStaticOrKinematicObject() || (push.force.isZero(0) && push.torque.isZero(0))) return;
  const btVector3 to_mass = quatRotate(body.getWorldTransform().getRotation(), to_bullet(offset));
  const btVector3 force = to_bullet(push.force);
  body.activate();
  body.applyCentralForce(force);
  body.applyTorque(to_bullet(push.torque) - to_mass.cross(force));
}

}  // namespace

void BulletBodies::add(const Cloth& cloth, const ClothMesh& mesh, btSoftBody& body) {
  const StartState start = start_state(cloth, mesh);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    const Vector3<btScalar> place = start.positions.col(i).cast<btScalar>();
    node.m_x.setValue(place[0], place[1], place[2]);
    node.m_q = node.m_x;
    if (node.m_im == 0) continue;
    const Vector3<btScalar> velocity = start.velocities.col(i).cast<btScalar>();
    node.m_v.setValue(velocity[0], velocity[1], velocity[2]);
    node.m_vn = node.m_v;  // an implicit step of the deformable world starts from this one
  }
  cloths_.push_back(&body);
  steered_.emplace_back();
  steered_.back().pinned = mesh.pinned;
  steered_.back().pinned_velocities = mesh.pinned_velocities;
  state_.cloths.push_back({cloth.name, {}, {}});
}

void BulletBodies::add(const Collider& collider, btRigidBody& body) {
  rigids_.push_back(&body);
  rigid_offsets_.push_back(bullet_shape_offset(collider));
  RigidState state;
  state.name = collider.name;
  state_.rigids.push_back(std::move(state));
}

void BulletBodies::set_torn(std::size_t cloth, const ClothMesh& mesh,
                            std::shared_ptr<const ClothTopology> topology) {
  steered_[cloth].pinned = mesh.pinned;
  steered_[cloth].pinned_velocities = mesh.pinned_velocities;
  state_.cloths[cloth].topology = std::move(topology);
}

void BulletBodies::begin_step(const StepCommands* commands, double time_step) {
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    btSoftBody& body = *cloths_[c];
    const ClothCommands* lead = commands ? &commands->cloths[c] : nullptr;
    if (lead && lead->placement) continue;
    if (lead && lead->pinned_positions.cols() > 0) {
      bridge::move_kinematic_nodes(steered_[c].pinned, lead->pinned_positions, time_step, body);
    } else {
      bridge::set_pinned_velocities(steered_[c], body);
    }
    if (!lead || lead->node_forces.cols() == 0) continue;
    bridge::add_node_forces(lead->node_forces.cast<btScalar>(), body);
  }
  if (!commands) return;
  for (std::size_t r = 0; r < rigids_.size(); ++r) {
    if (const auto& pose = commands->colliders[r])
      lead_collider(*pose, rigid_offsets_[r], *rigids_[r]);
    push_collider(commands->pushes[r], rigid_offsets_[r], *rigids_[r]);
  }
}

std::optional<BlowUp> BulletBodies::predicted_blow_up(int step, double time,
                                                      double time_step) const {
  for (std::size_t r = 0; r < rigids_.size(); ++r) {
    const btRigidBody& body = *rigids_[r];
    if (body.isStaticOrKinematicObject()) continue;
    const auto h = static_cast<btScalar>(time_step);
    const btVector3 acceleration = body.getTotalForce() * body.getInvMass() + body.getGravity();
    const btVector3 spin = body.getInvInertiaTensorWorld() * body.getTotalTorque();
    const auto fault = fault_of_motion(from_bullet(body.getLinearVelocity() + h * acceleration),
                                       from_bullet(body.getAngularVelocity() + h * spin));
    if (fault) return BlowUp{step, time, state_.rigids[r].name, 0, *fault};
  }
  return std::nullopt;
}

void BulletBodies::end_step(const StepCommands* commands, double time_step) {
  if (!commands) return;
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    if (const auto& placement = commands->cloths[c].placement) {
      bridge::place_body(placement->positions, placement->velocities, *cloths_[c]);
      continue;
    }
    const Matrix3X<double>& targets = commands->cloths[c].pinned_positions;
    if (targets.cols() == 0) continue;
    bridge::place_nodes(steered_[c].pinned, targets, time_step, *cloths_[c]);
  }
}

void BulletBodies::read_state(double time) {
  state_.time = time;
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    ClothState& cloth = state_.cloths[c];
    const int num_nodes = cloths_[c]->m_nodes.size();
    cloth.positions.resize(3, num_nodes);
    cloth.velocities.resize(3, num_nodes);
    for (int i = 0; i < num_nodes; ++i) {
      cloth.positions.col(i) = from_bullet(cloths_[c]->m_nodes[i].m_x);
      cloth.velocities.col(i) = from_bullet(cloths_[c]->m_nodes[i].m_v);
    }
  }
  for (std::size_t r = 0; r < rigids_.size(); ++r) {
    RigidState& rigid = state_.rigids[r];
    const btTransform& transform = rigids_[r]->getWorldTransform();
    const btQuaternion q = transform.getRotation();
    rigid.orientation = Eigen::Quaterniond(static_cast<double>(q.w()), static_cast<double>(q.x()),
                                           static_cast<double>(q.y()), static_cast<double>(q.z()));
    rigid.position = from_bullet(transform.getOrigin()) - rigid.orientation * rigid_offsets_[r];
    rigid.velocity = from_bullet(rigids_[r]->getLinearVelocity());
    rigid.angular_velocity = from_bullet(rigids_[r]->getAngularVelocity());
  }
}

}  // namespace weft::scenes
