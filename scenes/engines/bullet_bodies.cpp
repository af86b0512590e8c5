#include <weft/scenes/engines/bullet_bodies.hpp>

#include <utility>

#include <weft/bridge/cloth_body.hpp>
#include <weft/scenes/engines/bullet_shapes.hpp>

namespace weft::scenes {
namespace {

Vector3<double> from_bullet(const btVector3& v) {
  return Vector3<btScalar>(v.x(), v.y(), v.z()).cast<double>();
}

}  // namespace

void BulletBodies::add(const Cloth& cloth, const ClothMesh& mesh, btSoftBody& body) {
  const Vector3<btScalar> velocity = cloth.velocity.cast<btScalar>();
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im == 0) continue;
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

void BulletBodies::steer_pins() {
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    bridge::set_pinned_velocities(steered_[c], *cloths_[c]);
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
