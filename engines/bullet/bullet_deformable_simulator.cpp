#include <weft/engines/bullet/bullet_deformable_simulator.hpp>

#include <utility>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/deformable/deformable_world.hpp>
#include <weft/core/error.hpp>
#include <weft/engines/blow_up_check.hpp>
#include <weft/engines/bullet/bullet_bodies.hpp>
#include <weft/engines/bullet/bullet_shapes.hpp>
#include <weft/engines/bullet/bullet_simulator.hpp>
#include <weft/engines/engine_state.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/controllers/controller_manager.hpp>

namespace weft::scenes {
namespace {

class DeformableSimulator final : public Simulator, public Resumable {
 public:
  explicit DeformableSimulator(bridge::DeformableScheme scheme) : scheme_(scheme) {}

  void load(const Scene& scene) override;
  [[nodiscard]] StepReport step(double time_step) override;
  [[nodiscard]] const SceneState& state() const override { return bodies_.state(); }
  [[nodiscard]] Snapshot save() override;
  void restore(const Snapshot& snapshot) override;

 private:
  [[nodiscard]] std::string_view engine_name() const;
  void make_world(const Scene& scene);
  void serialize(StateArchive& archive);
  void add_cloth(const Cloth& cloth);
  [[nodiscard]] std::optional<BlowUp> find_blow_up() const;

  bridge::DeformableScheme scheme_;
  LoadedScene loaded_;
  std::unique_ptr<bridge::DeformableWorld> world_;
  BulletBodies bodies_;
  StepReport report_;
  double reach_ = 0.0;  // [m] from the origin
};

void DeformableSimulator::load(const Scene& scene) {
  loaded_ = LoadedScene(scene);
  make_world(scene);
}

void DeformableSimulator::make_world(const Scene& scene) {
  bodies_ = {};
  report_ = {};
  reach_ = distance_field_reach(scene);
  world_ = std::make_unique<bridge::DeformableWorld>(
      bridge::DeformableWorldSettings{.gravity = scene.world.gravity,
                                      .scheme = scheme_,
                                      .contact_iterations = scene.bullet.position_iterations,
                                      .distance_field_voxel = distance_field_voxel(scene)});
  for (const Cloth& cloth : scene.cloths) add_cloth(cloth);
  for (const Collider& collider : scene.colliders) {
    BulletCollider made = make_bullet_collider(collider, scene.bullet.concave);
    bodies_.add(collider, world_->add(std::move(made.body), std::move(made.shape)));
  }
  bodies_.read_state(0.0);
  if (ControllerManager(scene, controllers()).is_needed()) {
    throw InvalidArgument("bullet_deformable: scene '" + scene.name +
                          "' has paths or controllers, expected none, or another engine");
  }
}

std::string_view DeformableSimulator::engine_name() const {
  return scheme_ == bridge::DeformableScheme::kImplicit ? "bullet_deformable_implicit"
                                                        : "bullet_deformable";
}

void DeformableSimulator::serialize(StateArchive& archive) {
  scenes::serialize(archive, report_);
  world_->serialize(archive);
}

// A world has more than this state, and only new worlds agree in that: this run gets a new one, too.
Snapshot DeformableSimulator::save() {
  StateArchive archive = StateArchive::writer();
  Snapshot snapshot{std::string(engine_name()),
                    std::string(to_string(bullet_precision())),
                    report_.step,
                    report_.time,
                    loaded_.text(),
                    {}};
  serialize(archive);
  snapshot.state = archive.take();
  restore(snapshot);
  return snapshot;
}

void DeformableSimulator::restore(const Snapshot& snapshot) {
  loaded_.check(snapshot, engine_name(), to_string(bullet_precision()));
  make_world(loaded_.scene());
  StateArchive archive = StateArchive::reader(snapshot.state);
  serialize(archive);
  archive.end();
  bodies_.read_state(snapshot.time);
}

void DeformableSimulator::add_cloth(const Cloth& cloth) {
  const ClothMesh mesh = make_mesh(cloth);
  if (cloth.tear) {
    throw InvalidArgument("bullet_deformable: cloth '" + cloth.name +
                          "' tears, expected one that does not, or one of the engines bullet_soft, "
                          "bullet_forces and reference");
  }
  if (mesh.pinned_velocities.cols() > 0 && !mesh.pinned_velocities.isZero()) {
    throw InvalidArgument("bullet_deformable: cloth '" + cloth.name +
                          "': a pin moves, expected pins at rest, or the law drive");
  }
  if (cloth.self_collision || cloth.soft_collision) {
    throw InvalidArgument("bullet_deformable: cloth '" + cloth.name +
                          "': self_collision or soft_collision, expected neither, or one of the "
                          "engines bullet_soft, bullet_forces");
  }
  const bridge::ClothSettings settings{.collision_margin = cloth.collision_margin,
                                       .friction = cloth.friction};
  btSoftBody& body = world_->add(bridge::make_cloth_body(world_->info(), mesh, settings));
  world_->forces().attach(body, mesh, cloth.laws);
  bodies_.add(cloth, mesh, body);
}

std::optional<BlowUp> DeformableSimulator::find_blow_up() const {
  for (std::size_t c = 0; c < bodies_.cloths().size(); ++c) {
    if (const auto found = world_->forces().blow_up(*bodies_.cloths()[c])) {
      return BlowUp{report_.step, report_.time, state().cloths[c].name, found->node, found->reason};
    }
  }
  return first_blow_up(state(), report_.step, report_.time, reach_);
}

StepReport DeformableSimulator::step(double time_step) {
  if (report_.blow_up) return report_;
  report_.time_step = static_cast<double>(static_cast<btScalar>(time_step));
  report_.step += 1;
  if (report_.step == 1) report_.blow_up = first_blow_up(state(), 1, 0.0, reach_);
  if (report_.blow_up) return report_;
  world_->step(time_step);
  report_.time += report_.time_step;
  report_.num_contacts = 0;
  for (const btSoftBody* cloth : bodies_.cloths()) {
    report_.num_contacts += cloth->m_nodeRigidContacts.size() + cloth->m_faceRigidContacts.size();
  }
  bodies_.read_state(report_.time);
  report_.blow_up = find_blow_up();
  return report_;
}

}  // namespace

std::unique_ptr<Simulator> make_bullet_deformable() {
  return std::make_unique<DeformableSimulator>(bridge::DeformableScheme::kExplicit);
}

std::unique_ptr<Simulator> make_bullet_deformable_implicit() {
  return std::make_unique<DeformableSimulator>(bridge::DeformableScheme::kImplicit);
}

}  // namespace weft::scenes
