#include <weft/engines/bullet/bullet_simulator.hpp>

#include <algorithm>
#include <utility>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/snapshot.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/engines/blow_up_check.hpp>
#include <weft/engines/bullet/bullet_bodies.hpp>
#include <weft/engines/bullet/bullet_shapes.hpp>
#include <weft/engines/bullet/bullet_tears.hpp>
#include <weft/engines/engine_state.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/contact_view.hpp>
#include <weft/scenes/controllers/controller_manager.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/live_laws.hpp>

namespace weft::scenes {
namespace {

enum class Tension { kLinks, kLaws, kImplicit };

class BulletSimulator final : public Simulator,
                              public LiveLaws,
                              public Resumable,
                              public ContactView {
 public:
  explicit BulletSimulator(Tension tension) : tension_(tension) {}

  void load(const Scene& scene) override;
  [[nodiscard]] StepReport step(double time_step) override;
  [[nodiscard]] const SceneState& state() const override { return bodies_.state(); }
  void replace_laws(std::size_t cloth, const std::vector<forces::LawSpecification>& laws) override;
  [[nodiscard]] Snapshot save() override;
  void restore(const Snapshot& snapshot) override;
  [[nodiscard]] std::vector<NodeTouch> touches() const override;

 private:
  [[nodiscard]] std::string_view engine_name() const;
  void serialize(StateArchive& archive);
  void save_world(StateArchive& archive);
  void restore_world(StateArchive& archive);
  void add_cloth(const Cloth& cloth, const Scene& scene);
  [[nodiscard]] bridge::LinkSet link_set(const Cloth& cloth,
                                         const forces::LawSpecification& law) const;
  void set_freedom(const StepCommands& commands);
  [[nodiscard]] std::optional<BlowUp> find_blow_up() const;
  [[nodiscard]] SolveReport solve_report() const;
  /// Whether the law becomes Bullet's links, in place of forces.
  [[nodiscard]] bool is_link(const forces::LawSpecification& law) const {
    return tension_ == Tension::kLinks && forces::role_of(law.law) == forces::LawRole::kSpring;
  }

  Tension tension_;
  LoadedScene loaded_;
  std::vector<Cloth> cloths_;  ///< as loaded
  double links_time_step_ = 0.0;
  std::unique_ptr<bridge::SoftWorld> world_;
  BulletBodies bodies_;
  BulletTears tears_;
  ControllerManager controller_manager_;
  StepReport report_;
  double reach_ = 0.0;  // [m] from the origin
};

void BulletSimulator::load(const Scene& scene) {
  loaded_ = LoadedScene(scene);
  bodies_ = {};
  tears_ = {};
  report_ = {};
  cloths_ = scene.cloths;
  reach_ = distance_field_reach(scene);
  links_time_step_ = scene.world.time_step;
  world_ = std::make_unique<bridge::SoftWorld>(
      bridge::SoftWorldSettings{scene.world.gravity, distance_field_voxel(scene)});
  for (const Cloth& cloth : scene.cloths) add_cloth(cloth, scene);
  for (const Collider& collider : scene.colliders) {
    BulletCollider made = make_bullet_collider(collider, scene.bullet.concave);
    bodies_.add(collider, world_->add(std::move(made.body), std::move(made.shape)));
  }
  tears_.make_first_cuts(world_->solver(), bodies_);
  bodies_.read_state(0.0);
  controller_manager_ = ControllerManager(scene, controllers());
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
  std::vector<forces::LawSpecification> laws;
  for (const forces::LawSpecification& given : cloth.laws) {
    const forces::LawSpecification law = forces::checked(given);
    if (is_link(law)) {
      settings.links.push_back(link_set(cloth, law));
    } else {
      laws.push_back(law);
    }
  }
  btSoftBody& body = world_->add(bridge::make_cloth_body(world_->info(), mesh, settings));
  if (cloth.self_collision || cloth.soft_collision) {
    const double margin = cloth.collision_margin;
    world_->solver().set_cloth_contact(
        body, {.with_itself = cloth.self_collision,
               .with_others = cloth.soft_collision,
               .self_thickness = cloth.self_thickness.value_or(2.0 * margin),
               .margin = margin > 0 ? margin : 0.5 * *cloth.self_thickness,
               .friction = cloth.friction});
  }
  // A skin is drawn only. Bullet would look each of its nodes up in the colliders' distance fields.
  const auto* skin = std::get_if<SkinSource>(&cloth.source);
  if (skin != nullptr && !skin->is_cloth) body.m_cfg.collisions = 0;
  if (tension_ == Tension::kImplicit) {
    // A scene's numbers are those of the solver, so that nothing sleeps.
    if (const auto reason = world_->solver().attach_fast(body, mesh, laws, {.may_sleep = false})) {
      throw Error("bullet_weft: cloth '" + cloth.name + "' cannot be stepped: " + *reason);
    }
  } else {
    world_->solver().attach(body, mesh, laws);
  }
  bodies_.add(cloth, mesh, body);
  if (cloth.tear) {
    tears_.add(bodies_.cloths().size() - 1, *cloth.tear, mesh, std::move(settings),
               std::move(laws));
  }
}

void BulletSimulator::replace_laws(std::size_t cloth,
                                   const std::vector<forces::LawSpecification>& laws) {
  const Cloth& loaded = cloths_.at(cloth);
  if (loaded.tear) {
    throw InvalidArgument("cloth '" + loaded.name +
                          "' tears, expected other laws for it at the start of a run only");
  }
  std::vector<forces::LawSpecification> attached;
  std::vector<forces::LawSpecification> links;
  for (const forces::LawSpecification& given : laws) {
    const forces::LawSpecification law = forces::checked(given);
    (is_link(law) ? links : attached).push_back(law);
  }
  std::vector<forces::LawSpecification> loaded_links;
  for (const forces::LawSpecification& given : loaded.laws) {
    if (is_link(given)) loaded_links.push_back(forces::checked(given));
  }
  const auto is_same = [](const forces::LawSpecification& a, const forces::LawSpecification& b) {
    return a.sets == b.sets && a.parameters == b.parameters;
  };
  if (!std::equal(links.begin(), links.end(), loaded_links.begin(), loaded_links.end(), is_same)) {
    throw InvalidArgument("bullet_soft: cloth '" + loaded.name +
                          "': tension belongs to Bullet's links, expected another one at the start "
                          "of a run only");
  }
  btSoftBody& body = *bodies_.cloths()[cloth];
  world_->solver().replace_laws(body, make_mesh(loaded), attached);
  cloths_[cloth].laws = laws;
}

std::string_view BulletSimulator::engine_name() const {
  switch (tension_) {
    case Tension::kLinks:
      return kBulletSoft.name;
    case Tension::kLaws:
      return kBulletForces.name;
    case Tension::kImplicit:
      break;
  }
  return kBulletWeft.name;
}

void BulletSimulator::serialize(StateArchive& archive) {
  scenes::serialize(archive, report_);
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    std::vector<forces::LawSpecification> laws = cloths_[c].laws;
    scenes::serialize(archive, laws);
    if (archive.is_reading() && !are_same(laws, cloths_[c].laws)) replace_laws(c, laws);
  }
  tears_.serialize(archive, world_->solver(), bodies_);
  controller_manager_.serialize(archive);
  if (archive.is_reading()) {
    restore_world(archive);
  } else {
    save_world(archive);
  }
}

// A solver whose cloth has torn has a coarse space that no new one would have: this run gets a new one too.
void BulletSimulator::save_world(StateArchive& archive) {
  bridge::SoftBodySolver& solver = world_->solver();
  bool is_fresh = true;
  for (const btSoftBody* cloth : bodies_.cloths()) {
    is_fresh = is_fresh && bridge::Snapshot::is_fresh(solver, *cloth);
  }
  bridge::Snapshot world;
  world.write(world_->world(), solver);
  if (!is_fresh) {
    tears_.renew_laws(solver, bodies_);
    world.restore(world_->world(), solver);
  }
  std::vector<std::byte> bytes = world.bytes();
  archive.value(bytes);
}

void BulletSimulator::restore_world(StateArchive& archive) {
  std::vector<std::byte> bytes;
  archive.value(bytes);
  bridge::Snapshot(std::move(bytes)).restore(world_->world(), world_->solver());
}

Snapshot BulletSimulator::save() {
  StateArchive archive = StateArchive::writer();
  Snapshot snapshot{std::string(engine_name()),
                    std::string(to_string(bullet_precision())),
                    report_.step,
                    report_.time,
                    loaded_.text(),
                    {}};
  serialize(archive);
  snapshot.state = archive.take();
  return snapshot;
}

void BulletSimulator::restore(const Snapshot& snapshot) {
  loaded_.check(snapshot, engine_name(), to_string(bullet_precision()));
  const LoadedScene loaded = loaded_;
  load(loaded.scene());
  loaded_ = loaded;
  StateArchive archive = StateArchive::reader(snapshot.state);
  serialize(archive);
  archive.end();
  bodies_.read_state(snapshot.time);
}

std::vector<NodeTouch> BulletSimulator::touches() const {
  std::vector<NodeTouch> touches;
  if (!(report_.time_step > 0)) return touches;
  for (std::size_t c = 0; c < bodies_.cloths().size(); ++c) {
    for (const bridge::NodeContact& contact :
         world_->solver().rigid_contacts(*bodies_.cloths()[c])) {
      if (contact.impulse.isZero()) continue;
      touches.push_back({c, contact.node, bridge::from_bullet(contact.normal),
                         bridge::from_bullet(contact.impulse) / report_.time_step,
                         contact.is_sticking});
    }
  }
  return touches;
}

void BulletSimulator::set_freedom(const StepCommands& commands) {
  for (std::size_t c = 0; c < bodies_.cloths().size(); ++c) {
    btSoftBody& body = *bodies_.cloths()[c];
    const ClothCommands& lead = commands.cloths[c];
    world_->solver().set_suspended(body, lead.placement.has_value());
    if (!lead.placement) world_->solver().set_position_limits(body, lead.limits);
  }
}

std::optional<BlowUp> BulletSimulator::find_blow_up() const {
  for (std::size_t c = 0; c < bodies_.cloths().size(); ++c) {
    if (const auto found = world_->solver().blow_up(*bodies_.cloths()[c])) {
      return BlowUp{report_.step, report_.time, state().cloths[c].name, found->node, found->reason};
    }
  }
  return first_blow_up(state(), report_.step, report_.time, reach_);
}

SolveReport BulletSimulator::solve_report() const {
  SolveReport report;
  for (const btSoftBody* cloth : bodies_.cloths()) {
    const bridge::StepError error = world_->solver().step_error(*cloth);
    report.error = std::max(report.error, error.distance);
    report.is_within_tolerance = report.is_within_tolerance && error.is_within_tolerance;
  }
  return report;
}

StepReport BulletSimulator::step(double time_step) {
  if (report_.blow_up) return report_;
  if (tension_ == Tension::kLinks && time_step != links_time_step_) {
    throw InvalidArgument(
        "bullet_soft: the time step differs from the scene's, for which the links' stiffness was "
        "mapped; expected the same time step");
  }
  // Bullet hands its soft bodies a single-precision step in both builds.
  report_.time_step = static_cast<double>(static_cast<float>(time_step));
  report_.step += 1;
  if (report_.step == 1) report_.blow_up = first_blow_up(state(), 1, 0.0, reach_);
  if (report_.blow_up) return report_;
  report_.time += report_.time_step;
  const StepCommands* commands =
      controller_manager_.is_needed() ? &controller_manager_.steer(state(), report_.time) : nullptr;
  bodies_.begin_step(commands, report_.time_step);
  report_.blow_up = bodies_.predicted_blow_up(report_.step, report_.time, report_.time_step);
  if (report_.blow_up) return report_;
  if (commands) set_freedom(*commands);
  world_->step(time_step);
  bodies_.end_step(commands, report_.time_step);
  report_.num_contacts = 0;
  for (const btSoftBody* cloth : bodies_.cloths())
    report_.num_contacts += world_->solver().num_contacts(*cloth);
  if (tension_ == Tension::kImplicit) report_.solve = solve_report();
  bodies_.read_state(report_.time);
  report_.blow_up = find_blow_up();
  if (!report_.blow_up && tears_.tear(world_->solver(), bodies_)) bodies_.read_state(report_.time);
  return report_;
}

}  // namespace

std::unique_ptr<Simulator> make_bullet_soft() {
  return std::make_unique<BulletSimulator>(Tension::kLinks);
}

std::unique_ptr<Simulator> make_bullet_forces() {
  return std::make_unique<BulletSimulator>(Tension::kLaws);
}

std::unique_ptr<Simulator> make_bullet_weft() {
  return std::make_unique<BulletSimulator>(Tension::kImplicit);
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
