#include <weft/scenes/engines/bullet_simulator.hpp>

#include <utility>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/scenes/engines/blow_up_check.hpp>
#include <weft/scenes/engines/bullet_shapes.hpp>

namespace weft::scenes {
namespace {

enum class Tension { kLinks, kLaws };

class BulletSimulator final : public Simulator {
 public:
  explicit BulletSimulator(Tension tension) : tension_(tension) {}

  void load(const Scene& scene) override;
  [[nodiscard]] StepReport step(double time_step) override;
  [[nodiscard]] const SceneState& state() const override { return state_; }

 private:
  void add_cloth(const Cloth& cloth, const Scene& scene);
  void add_collider(const Collider& collider);
  void read_state();
  [[nodiscard]] bridge::LinkSet link_set(const Cloth& cloth,
                                         const forces::LawSpecification& law) const;
  [[nodiscard]] std::optional<BlowUp> find_blow_up() const;

  Tension tension_;
  double links_time_step_ = 0.0;
  std::unique_ptr<bridge::SoftWorld> world_;
  std::vector<btSoftBody*> cloths_;
  std::vector<ClothMesh> steered_;  ///< as cloths_: pins and their velocities, nothing else
  std::vector<btRigidBody*> rigids_;
  std::vector<double> rigid_offsets_;  ///< [m] see bullet_shape_offset()
  SceneState state_;
  StepReport report_;
};

Vector3<double> from_bullet(const btVector3& v) {
  return Vector3<btScalar>(v.x(), v.y(), v.z()).cast<double>();
}

void BulletSimulator::load(const Scene& scene) {
  cloths_.clear();
  steered_.clear();
  rigids_.clear();
  rigid_offsets_.clear();
  state_ = {};
  report_ = {};
  links_time_step_ = scene.world.time_step;
  world_ = std::make_unique<bridge::SoftWorld>(
      bridge::SoftWorldSettings{scene.world.gravity, distance_field_voxel(scene)});
  for (const Cloth& cloth : scene.cloths) add_cloth(cloth, scene);
  for (const Collider& collider : scene.colliders) add_collider(collider);
  read_state();
}

bridge::LinkSet BulletSimulator::link_set(const Cloth& cloth,
                                          const forces::LawSpecification& law) const {
  if (law.parameters.at("compression_ratio").at(0) != 1.0) {
    throw InvalidArgument("bullet_soft: cloth '" + cloth.name +
                          "': tension.compression_ratio is not 1, but Bullet's links push as they "
                          "pull; expected 1, or the engine bullet_forces");
  }
  return {law.sets, law.parameters.at("stiffness").at(0)};
}

void BulletSimulator::add_cloth(const Cloth& cloth, const Scene& scene) {
  const ClothMesh mesh = make_mesh(cloth);
  bridge::ClothSettings settings{.collision_margin = cloth.collision_margin,
                                 .friction = cloth.friction,
                                 .position_iterations = scene.bullet.position_iterations,
                                 .time_step = links_time_step_};
  forces::LawSet<btScalar> laws;
  for (const forces::LawSpecification& given : cloth.laws) {
    const forces::LawSpecification law = forces::checked(given);
    if (law.law == "tension" && tension_ == Tension::kLinks) {
      settings.links.push_back(link_set(cloth, law));
    } else {
      laws.add(forces::make_law<btScalar>(law, mesh));
    }
  }
  btSoftBody& body = world_->add(bridge::make_cloth_body(world_->info(), mesh, settings));
  const Vector3<btScalar> velocity = cloth.velocity.cast<btScalar>();
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    if (body.m_nodes[i].m_im > 0) {
      body.m_nodes[i].m_v.setValue(velocity[0], velocity[1], velocity[2]);
    }
  }
  world_->solver().attach(body, std::move(laws), mesh.masses.cast<btScalar>());
  cloths_.push_back(&body);
  steered_.emplace_back();
  steered_.back().pinned = mesh.pinned;
  steered_.back().pinned_velocities = mesh.pinned_velocities;
  state_.cloths.push_back({cloth.name, {}, {}});
}

void BulletSimulator::add_collider(const Collider& collider) {
  BulletCollider made = make_bullet_collider(collider);
  rigids_.push_back(&world_->add(std::move(made.body), std::move(made.shape)));
  rigid_offsets_.push_back(bullet_shape_offset(collider.shape));
  RigidState state;
  state.name = collider.name;
  state_.rigids.push_back(std::move(state));
}

void BulletSimulator::read_state() {
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
    rigid.position = from_bullet(transform.getOrigin()) +
                     rigid.orientation * Vector3<double>(0, rigid_offsets_[r], 0);
    rigid.velocity = from_bullet(rigids_[r]->getLinearVelocity());
    rigid.angular_velocity = from_bullet(rigids_[r]->getAngularVelocity());
  }
}

std::optional<BlowUp> BulletSimulator::find_blow_up() const {
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    if (const auto found = world_->solver().blow_up(*cloths_[c])) {
      return BlowUp{report_.step, report_.time, state_.cloths[c].name, found->node, found->reason};
    }
  }
  return first_blow_up(state_, report_.step, report_.time);
}

StepReport BulletSimulator::step(double time_step) {
  if (report_.blow_up) return report_;
  if (tension_ == Tension::kLinks && time_step != links_time_step_) {
    throw InvalidArgument(
        "bullet_soft: the time step differs from the scene's, for which the links' stiffness was "
        "mapped; expected the same time step");
  }
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    bridge::set_pinned_velocities(steered_[c], *cloths_[c]);
  }
  world_->step(time_step);
  // Bullet hands its soft bodies a single-precision step in both builds.
  report_.time_step = static_cast<double>(static_cast<float>(time_step));
  report_.step += 1;
  report_.time += report_.time_step;
  report_.num_contacts = 0;
  for (const btSoftBody* cloth : cloths_) report_.num_contacts += cloth->m_rcontacts.size();
  read_state();
  state_.time = report_.time;
  report_.blow_up = find_blow_up();
  return report_;
}

}  // namespace

std::unique_ptr<Simulator> make_bullet_soft() {
  return std::make_unique<BulletSimulator>(Tension::kLinks);
}

std::unique_ptr<Simulator> make_bullet_forces() {
  return std::make_unique<BulletSimulator>(Tension::kLaws);
}

StoredPrecision bullet_precision() {
  return sizeof(btScalar) == sizeof(double) ? StoredPrecision::kFloat64 : StoredPrecision::kFloat32;
}

std::string bullet_version_text() {
  return "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." +
         std::to_string(BT_BULLET_VERSION % 100) + ", " +
         (sizeof(btScalar) == sizeof(double) ? "double" : "single") + " precision";
}

}  // namespace weft::scenes
