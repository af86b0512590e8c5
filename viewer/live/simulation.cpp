#include <weft/viewer/live/simulation.hpp>

#include <utility>

#include <weft/scenes/engine_kind.hpp>
#include <weft/viewer/live/simulation_worker.hpp>

namespace weft::viewer {

bool SimulationSettings::takes_forces() const {
  return !scenes::find_engine_kind(engine->name)->is_deformable;
}

Simulation::Simulation(SimulationSettings settings)
    : worker_(std::make_unique<Worker>(std::move(settings))) {}

Simulation::~Simulation() = default;

void Simulation::set_running(bool is_running) {
  worker_->ask([w = worker_.get(), is_running] {
    w->is_running_ = is_running;
    w->forget_steps();
  });
}

void Simulation::set_speed(double speed) {
  worker_->ask([w = worker_.get(), speed] {
    w->speed_ = speed;
    w->begin_pace();
  });
}

void Simulation::step_once() {
  worker_->ask([w = worker_.get()] { ++w->wanted_steps_; });
}

void Simulation::take_back() {
  worker_->ask([w = worker_.get()] { w->take_back(); });
}

void Simulation::set_laws(std::size_t cloth, std::vector<forces::LawSpecification> laws) {
  worker_->ask([w = worker_.get(), cloth, laws = std::move(laws)] { w->set_laws(cloth, laws); });
}

void Simulation::set_gravity(const Vector3<double>& acceleration) {
  worker_->forces_->set_added_gravity(acceleration - worker_->settings_.scene.world.gravity);
}

void Simulation::set_pull(const std::optional<Pull>& pull) {
  worker_->forces_->set_pull(pull);
}

void Simulation::set_carry(const std::optional<Carry>& carry) {
  worker_->forces_->set_carry(carry);
}

SnapshotPtr Simulation::latest() const {
  return worker_->read<SnapshotPtr>([](Worker& w) { return w.latest_; });
}

std::vector<SnapshotPtr> Simulation::frames() const {
  return worker_->read<std::vector<SnapshotPtr>>([](Worker& w) {
    return std::vector<SnapshotPtr>(w.ring_.frames().begin(), w.ring_.frames().end());
  });
}

std::size_t Simulation::num_frames() const {
  return worker_->read<std::size_t>([](Worker& w) { return w.ring_.size(); });
}

SnapshotPtr Simulation::frame(std::size_t index) const {
  return worker_->read<SnapshotPtr>([index](Worker& w) { return w.ring_.at(index); });
}

std::optional<std::string> Simulation::failure() const {
  return worker_->read<std::optional<std::string>>([](Worker& w) { return w.failure_; });
}

std::string Simulation::take_refusal() {
  return worker_->read<std::string>([](Worker& w) { return std::exchange(w.refusal_, {}); });
}

bool Simulation::reached_end() const {
  return worker_->read<bool>([](Worker& w) { return w.reached_end_; });
}

std::string Simulation::unfinished_recording() const {
  return worker_->read<std::string>([](Worker& w) { return w.unfinished_; });
}

double Simulation::largest_pull(std::size_t cloth) const {
  return worker_->forces_->largest_force(cloth);
}

bool Simulation::can_pull() const {
  return worker_->settings_.takes_forces();
}

}  // namespace weft::viewer
