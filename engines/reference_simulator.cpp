#include <weft/engines/reference_simulator.hpp>

#include <utility>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/engines/blow_up_check.hpp>
#include <weft/engines/engine_state.hpp>
#include <weft/engines/reference_tears.hpp>
#include <weft/reference/contact/distance/mesh_surface.hpp>
#include <weft/reference/solver.hpp>
#include <weft/scenes/characters/start_state.hpp>
#include <weft/scenes/controllers/controller_manager.hpp>
#include <weft/scenes/engine_kind.hpp>
#include <weft/scenes/format/scene_words.hpp>
#include <weft/scenes/live_laws.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

class ReferenceSimulator final : public Simulator, public LiveLaws, public Resumable {
 public:
  explicit ReferenceSimulator(LawFilter filter) : filter_(std::move(filter)) {}

  void load(const Scene& scene) override;
  [[nodiscard]] StepReport step(double time_step) override;
  [[nodiscard]] const SceneState& state() const override { return state_; }
  void replace_laws(std::size_t cloth, const std::vector<forces::LawSpecification>& laws) override;
  [[nodiscard]] Snapshot save() override;
  void restore(const Snapshot& snapshot) override;

 private:
  void serialize(StateArchive& archive);
  void begin_step(const StepCommands& commands, double time_step);
  void end_step(const StepCommands& commands, double time_step);
  void read_state();

  LawFilter filter_;
  LoadedScene loaded_;
  std::vector<Cloth> cloths_;  ///< as loaded
  std::unique_ptr<reference::SpringSolver> solver_;
  ReferenceTears tears_;
  SceneState state_;
  StepReport report_;
  ControllerManager controller_manager_;
};

forces::LawSet<double> make_laws(const Cloth& cloth, const ClothMesh& mesh,
                                 const LawFilter& filter) {
  forces::LawSet<double> laws;
  for (const forces::LawSpecification& law : cloth.laws) {
    laws.add(filter(forces::make_law<double>(law, mesh)));
  }
  return laws;
}

reference::Body make_body(const Cloth& cloth, bool faces, const LawFilter& filter) {
  reference::Body body;
  body.name = cloth.name;
  body.mesh = make_mesh(cloth);
  body.laws = make_laws(cloth, body.mesh, filter);
  StartState start = start_state(cloth, body.mesh);
  body.positions = std::move(start.positions);
  body.velocities = std::move(start.velocities);
  body.collision_margin = cloth.collision_margin;
  body.friction = cloth.friction;
  body.face_contact = faces;
  body.self_contact = cloth.self_collision;
  body.mutual_contact = cloth.soft_collision;
  body.self_thickness = cloth.self_thickness.value_or(2 * cloth.collision_margin);
  return body;
}

struct ToReferenceShape {
  reference::Shape operator()(const SphereShape& s) const { return reference::Sphere{s.radius}; }
  reference::Shape operator()(const BoxShape& b) const { return reference::Box{b.half_extents}; }
  reference::Shape operator()(const PlaneShape&) const { return reference::Plane{}; }
  reference::Shape operator()(const CapsuleShape& c) const {
    return reference::Capsule{c.radius, c.height};
  }
  reference::Shape operator()(const CylinderShape& c) const {
    return reference::Cylinder{c.radius, c.height};
  }
  reference::Shape operator()(const ConeShape& c) const {
    return reference::Cone{c.radius, c.height};
  }
  reference::Shape operator()(const ConvexHullShape& hull) const {
    return (*this)(hull_surface(hull));
  }
  reference::Shape operator()(const MeshShape& mesh) const {
    try {
      return reference::Mesh{
          std::make_shared<const reference::MeshSurface>(mesh.points, mesh.triangles)};
    } catch (const InvalidArgument& error) {
      throw InvalidArgument("reference: collider '" + name + "': " + error.what());
    }
  }
  template <class Other>
  reference::Shape operator()(const Other&) const {
    const std::string_view word = kShapeWords[Shape(Other{}).index()];
    throw InvalidArgument("reference: collider '" + name + "': shape = \"" + std::string(word) +
                          "\", expected any shape but compound and height_field, or one of the "
                          "engines bullet_soft, bullet_forces, bullet_deformable, "
                          "bullet_deformable_implicit");
  }

  const std::string& name;
};

reference::Collider make_collider(const Collider& collider) {
  reference::Collider result;
  result.name = collider.name;
  result.shape = std::visit(ToReferenceShape{collider.name}, collider.shape);
  result.position = collider.position;
  result.orientation = collider.orientation;
  result.friction = collider.friction;
  result.mass = collider.mass;
  if (collider.mass) {
    result.velocity = collider.velocity;
    result.angular_velocity = collider.angular_velocity;
  }
  return result;
}

reference::IntegratorKind to_reference(Integrator integrator) {
  using Kind = reference::IntegratorKind;
  switch (integrator) {
    case Integrator::kExplicitEuler:
      return Kind::kExplicitEuler;
    case Integrator::kModifiedEuler:
      return Kind::kModifiedEuler;
    case Integrator::kVelocityVerlet:
      return Kind::kVelocityVerlet;
    case Integrator::kRungeKutta4:
      return Kind::kRungeKutta4;
    case Integrator::kYoshida4:
      return Kind::kYoshida4;
    case Integrator::kDormandPrince5:
      return Kind::kDormandPrince5;
    case Integrator::kImplicitEuler:
      return Kind::kImplicitEuler;
    case Integrator::kTrBdf2:
      return Kind::kTrBdf2;
    case Integrator::kImplicitMidpoint:
      return Kind::kImplicitMidpoint;
    case Integrator::kGeneralizedAlpha:
      break;
  }
  return Kind::kGeneralizedAlpha;
}

reference::GuardPolicy to_reference(StepGuard guard) {
  switch (guard) {
    case StepGuard::kReport:
      return reference::GuardPolicy::kReport;
    case StepGuard::kRefuse:
      return reference::GuardPolicy::kRefuse;
    case StepGuard::kSubstep:
      break;
  }
  return reference::GuardPolicy::kSubstep;
}

void ReferenceSimulator::load(const Scene& scene) {
  loaded_ = LoadedScene(scene);
  reference::System system;
  system.gravity = scene.world.gravity;
  const bool faces = scene.reference.contact_points == ContactPoints::kNodesAndFaces;
  for (const Cloth& cloth : scene.cloths) {
    system.bodies.push_back(make_body(cloth, faces, filter_));
  }
  for (const Collider& collider : scene.colliders) {
    system.colliders.push_back(make_collider(collider));
  }
  reference::SolverOptions options;
  options.integrator = to_reference(scene.reference.integrator);
  options.settings.relative_tolerance = scene.reference.tolerance;
  options.settings.spectral_radius = scene.reference.spectral_radius;
  options.contact = scene.reference.contact == ContactModel::kProjection
                        ? reference::ContactKind::kProjection
                        : reference::ContactKind::kImpulse;
  options.guard = to_reference(scene.reference.step_guard);
  solver_ = std::make_unique<reference::SpringSolver>(std::move(system), options);
  tears_ = ReferenceTears(scene, *solver_, [this](const Cloth& cloth, const ClothMesh& mesh) {
    return make_laws(cloth, mesh, this->filter_);
  });
  tears_.make_first_cuts(*solver_);
  cloths_ = scene.cloths;
  state_ = {};
  report_ = {};
  read_state();
  controller_manager_ = ControllerManager(scene, controllers());
}

void ReferenceSimulator::replace_laws(std::size_t cloth,
                                      const std::vector<forces::LawSpecification>& laws) {
  const Cloth& loaded = cloths_.at(cloth);
  if (loaded.tear) {
    throw InvalidArgument("reference: cloth '" + loaded.name +
                          "' tears, expected other laws for it at the start of a run only");
  }
  Cloth changed = loaded;
  changed.laws = laws;
  const reference::Body& now = solver_->system().bodies[cloth];
  reference::Body body = make_body(changed, now.face_contact, filter_);
  body.positions = now.positions;
  body.velocities = now.velocities;
  solver_->replace_body(cloth, std::move(body));
  cloths_[cloth] = std::move(changed);
}

void ReferenceSimulator::serialize(StateArchive& archive) {
  scenes::serialize(archive, report_);
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    std::vector<forces::LawSpecification> laws = cloths_[c].laws;
    scenes::serialize(archive, laws);
    if (archive.is_reading() && !are_same(laws, cloths_[c].laws)) replace_laws(c, laws);
  }
  tears_.serialize(archive, *solver_);
  solver_->serialize(archive);
  controller_manager_.serialize(archive);
}

Snapshot ReferenceSimulator::save() {
  StateArchive archive = StateArchive::writer();
  Snapshot snapshot{
      std::string(kReferenceEngine.name), "float64", report_.step, state_.time, loaded_.text(), {}};
  serialize(archive);
  snapshot.state = archive.take();
  return snapshot;
}

void ReferenceSimulator::restore(const Snapshot& snapshot) {
  loaded_.check(snapshot, kReferenceEngine.name, "float64");
  const LoadedScene loaded = loaded_;
  load(loaded.scene());
  loaded_ = loaded;
  StateArchive archive = StateArchive::reader(snapshot.state);
  serialize(archive);
  archive.end();
  read_state();
}

void ReferenceSimulator::begin_step(const StepCommands& commands, double time_step) {
  for (std::size_t c = 0; c < commands.cloths.size(); ++c) {
    const ClothCommands& cloth = commands.cloths[c];
    if (cloth.placement) {
      throw InvalidArgument(
          "reference: cloth '" + solver_->system().bodies[c].name +
          "' shall be placed and not simulated, expected the level of detail full, "
          "or an engine of Bullet's classic world");
    }
    if (cloth.pinned_positions.cols() > 0) {
      solver_->lead_pins(c, cloth.pinned_positions, time_step);
    }
    solver_->set_external_forces(c, cloth.node_forces);
  }
  for (std::size_t k = 0; k < commands.colliders.size(); ++k) {
    const auto& pose = commands.colliders[k];
    if (pose) solver_->lead_collider(k, pose->position, pose->orientation, time_step);
    solver_->push_collider(k, commands.pushes[k].force, commands.pushes[k].torque, time_step);
  }
}

void ReferenceSimulator::end_step(const StepCommands& commands, double time_step) {
  for (std::size_t c = 0; c < commands.cloths.size(); ++c) {
    const Matrix3X<double>& targets = commands.cloths[c].pinned_positions;
    if (targets.cols() > 0) solver_->place_pins(c, targets);
    solver_->limit_positions(c, commands.cloths[c].limits, time_step);
  }
  for (std::size_t k = 0; k < commands.colliders.size(); ++k) {
    const auto& pose = commands.colliders[k];
    if (pose) solver_->place_collider(k, pose->position, pose->orientation);
  }
}

void ReferenceSimulator::read_state() {
  const reference::System& system = solver_->system();
  state_.time = solver_->time();
  state_.cloths.resize(system.bodies.size());
  for (std::size_t b = 0; b < system.bodies.size(); ++b) {
    state_.cloths[b].name = system.bodies[b].name;
    state_.cloths[b].positions = system.bodies[b].positions;
    state_.cloths[b].velocities = system.bodies[b].velocities;
    state_.cloths[b].topology = tears_.topology(b);
  }
  state_.rigids.resize(system.colliders.size());
  for (std::size_t c = 0; c < system.colliders.size(); ++c) {
    const reference::Collider& collider = system.colliders[c];
    state_.rigids[c] = {collider.name, collider.position, collider.orientation, collider.velocity,
                        collider.angular_velocity};
  }
}

StepReport ReferenceSimulator::step(double time_step) {
  if (report_.blow_up) return report_;
  const StepCommands* commands =
      controller_manager_.is_needed()
          ? &controller_manager_.steer(state_, solver_->time() + time_step)
          : nullptr;
  if (commands) begin_step(*commands, time_step);
  const reference::StepOutcome outcome = solver_->step(time_step);
  if (commands) end_step(*commands, time_step);
  report_.step += 1;
  report_.time = solver_->time();
  report_.time_step = time_step;
  report_.substeps = outcome.substeps;
  report_.num_contacts = outcome.contact.num_contacts;
  report_.stable_time_step = outcome.stable_step;
  if (!outcome.blow_up) tears_.tear(*solver_);
  read_state();
  if (outcome.blow_up) {
    report_.blow_up = BlowUp{report_.step, report_.time, outcome.blow_up->body,
                             outcome.blow_up->node, outcome.blow_up->reason};
  } else {
    report_.blow_up = first_blow_up(state_, report_.step, report_.time);
  }
  return report_;
}

}  // namespace

std::unique_ptr<Simulator> make_reference() {
  return make_reference([](std::unique_ptr<forces::ForceLaw<double>> law) { return law; });
}

std::unique_ptr<Simulator> make_reference(LawFilter filter) {
  return std::make_unique<ReferenceSimulator>(std::move(filter));
}

}  // namespace weft::scenes
