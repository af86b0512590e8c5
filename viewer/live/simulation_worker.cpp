#include <weft/viewer/live/simulation_worker.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/live_laws.hpp>

namespace weft::viewer {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// A snapshot for the picture at least so often, if steps are shorter.
constexpr Seconds kPublishInterval(0.015);
/// Weight of the newest step in the mean of the step's wall time.
constexpr double kStepTimeWeight = 0.1;
/// A run that was held up does not catch up by more than this.
constexpr Seconds kLargestLag(0.1);

}  // namespace

Simulation::Worker::Worker(SimulationSettings settings)
    : is_running_(settings.is_running),
      speed_(settings.speed),
      settings_(std::move(settings)),
      forces_(std::make_shared<WindowForces>(settings_.scene, settings_.scene.world.time_step)),
      meter_(settings_.scene),
      measured_scene_(settings_.scene),
      parts_(settings_.engine->name) {
  const scenes::World& world = settings_.scene.world;
  steps_per_frame_ = std::max(1L, std::lround(world.frame_interval / world.time_step));
  num_steps_ = std::lround(world.duration / world.time_step);
  if (settings_.has_other_laws) parts_.set_laws(settings_.scene);
  if (!settings_.record.empty()) {
    recorder_ = std::make_unique<RunRecorder>(settings_.record, settings_.scene,
                                              settings_.provenance, settings_.engine->precision);
    unfinished_ = recorder_->partial().string();
  }
  thread_ = std::thread([this] { run(); });
}

Simulation::Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    is_quitting_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Simulation::Worker::ask(std::function<void()> change) {
  {
    const std::lock_guard lock(mutex_);
    changes_.push_back(std::move(change));
  }
  wake_.notify_all();
}

void Simulation::Worker::run() {
  try {
    simulate();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
  }
}

void Simulation::Worker::simulate() {
  simulator_ = settings_.engine->make();
  if (settings_.takes_forces()) simulator_->set_controllers({forces_});
  simulator_->load(settings_.scene);
  report_.time = simulator_->state().time;
  record_frame(false);
  publish(true);
  while (wait()) step();
}

bool Simulation::Worker::wait() {
  std::unique_lock lock(mutex_);
  while (true) {
    const std::vector<std::function<void()>> changes = std::exchange(changes_, {});
    if (!changes.empty()) {
      lock.unlock();
      for (const auto& change : changes) change();
      lock.lock();
      continue;
    }
    if (is_quitting_) return false;
    if (report_.blow_up || (!is_running_ && wanted_steps_ == 0)) {
      pace_start_.reset();
      wake_.wait(lock);
      continue;
    }
    if (wanted_steps_ > 0) return true;
    const Clock::time_point now = Clock::now();
    if (!pace_start_) {
      pace_start_ = now;
      pace_time_ = report_.time;
    }
    const Seconds due((report_.time - pace_time_) / speed_);
    const Seconds late = Seconds(now - *pace_start_) - due;
    if (late >= Seconds(0)) {
      if (late > kLargestLag) pace_start_.reset();
      return true;
    }
    wake_.wait_for(lock, -late);
  }
}

void Simulation::Worker::refuse(const std::string& why) {
  const std::lock_guard lock(mutex_);
  refusal_ = why;
}

void Simulation::Worker::save() {
  auto* const resumable = dynamic_cast<scenes::Resumable*>(simulator_.get());
  if (resumable == nullptr || recorder_) return;  // take_back() says so
  try {
    scenes::Snapshot snapshot = resumable->save();
    snapshot.step = step_;  // whole ones, however many parts they had
    rollback_.add(std::move(snapshot));
  } catch (const Error& error) {
    refuse(error.what());
  }
}

void Simulation::Worker::take_back() {
  auto* const resumable = dynamic_cast<scenes::Resumable*>(simulator_.get());
  if (resumable == nullptr) {
    return refuse(std::string(settings_.engine->name) +
                  ": has no snapshots, expected another engine");
  }
  if (recorder_) return refuse("take back: the run is recorded, expected one that is not");
  const scenes::Snapshot* const before = rollback_.before(step_ - 1);
  if (before == nullptr) {
    return refuse("take back: no step was taken by hand since the run was paused, expected one");
  }
  try {
    resumable->restore(*before);
  } catch (const Error& error) {
    return refuse(error.what());
  }
  step_ = before->step;
  report_ = {};
  report_.step = step_;
  report_.time = simulator_->state().time;
  {
    const std::lock_guard lock(mutex_);
    ring_.drop_after(step_);
  }
  publish(ring_.size() == 0 || ring_.at(ring_.size() - 1)->step < step_);
}

void Simulation::Worker::step() {
  if (wanted_steps_ > 0 && !is_running_) save();
  const Clock::time_point start = Clock::now();
  const double time_step = settings_.scene.world.time_step;
  num_parts_ = parts_.count(simulator_->state(), time_step);
  for (int part = 0; part < num_parts_ && !report_.blow_up; ++part) {
    report_ = simulator_->step(time_step / num_parts_);
  }
  ++step_;
  const double seconds = Seconds(Clock::now() - start).count();
  // The first step sets up what later ones use.
  if (step_ > 1) step_time_ += (step_time_ > 0.0 ? kStepTimeWeight : 1.0) * (seconds - step_time_);
  const bool is_single = wanted_steps_ > 0;
  if (is_single) --wanted_steps_;
  const bool is_last = step_ == num_steps_ || report_.blow_up.has_value();
  const bool is_frame = step_ % steps_per_frame_ == 0;
  if (is_frame || is_last) record_frame(is_last);
  if (is_frame || is_last || is_single || Clock::now() - published_ > kPublishInterval) {
    publish(is_frame || is_last || is_single);
  }
}

void Simulation::Worker::record_frame(bool is_last) {
  if (recorder_ && step_ <= num_steps_) {
    scenes::SceneState state = simulator_->state();
    state.time = report_.time;
    recorder_->add_frame(state);
    if (report_.blow_up) recorder_->set_blow_up(*report_.blow_up);
    if (is_last) {
      recorder_->finish();
      recorder_.reset();
      const std::lock_guard lock(mutex_);
      unfinished_.clear();
    }
  }
  if (!is_last) return;
  const std::lock_guard lock(mutex_);
  reached_end_ = true;
}

void Simulation::Worker::publish(bool is_frame) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->state = simulator_->state();
  snapshot->state.time = report_.time;
  snapshot->measures = meter_.measure(snapshot->state);
  snapshot->step = step_;
  snapshot->num_parts = num_parts_;
  snapshot->step_time = step_time_;
  snapshot->pull_force = forces_->pull_force();
  snapshot->blow_up = report_.blow_up;
  if (const auto* view = dynamic_cast<const scenes::ContactView*>(simulator_.get())) {
    snapshot->touches = view->touches();
  }
  published_ = Clock::now();
  const std::lock_guard lock(mutex_);
  latest_ = snapshot;
  if (is_frame) ring_.add(snapshot);
}

void Simulation::Worker::set_laws(std::size_t cloth,
                                  const std::vector<forces::LawSpecification>& laws) {
  auto* const live = dynamic_cast<scenes::LiveLaws*>(simulator_.get());
  try {
    if (live == nullptr) {
      throw InvalidArgument(std::string(settings_.engine->name) +
                            ": takes other laws at the start of a run only");
    }
    live->replace_laws(cloth, laws);
    measured_scene_.cloths.at(cloth).laws = laws;
    forget_steps();  // states that the meter would read with the new laws
    meter_ = Meter(measured_scene_);
    parts_.set_laws(measured_scene_);
  } catch (const InvalidArgument& error) {
    const std::lock_guard lock(mutex_);
    refusal_ = error.what();
  }
}

}  // namespace weft::viewer
