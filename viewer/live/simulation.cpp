#include <weft/viewer/live/simulation.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/scenes/live_laws.hpp>
#include <weft/viewer/live/run_recorder.hpp>
#include <weft/viewer/model/frame_ring.hpp>

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

bool takes_forces(const scenes::EngineInfo& engine) {
  return !engine.name.starts_with("bullet_deformable");
}

}  // namespace

class Simulation::Worker {
 public:
  explicit Worker(SimulationSettings settings);
  ~Worker();

  /// For the thread of the window: a change before the next step.
  void ask(std::function<void()> change);
  template <class Result>
  Result read(const std::function<Result(Worker&)>& get) {
    const std::lock_guard lock(mutex_);
    return get(*this);
  }

  // Shared, under mutex_.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::function<void()>> changes_;
  bool is_quitting_ = false;
  FrameRing ring_;
  SnapshotPtr latest_;
  std::optional<std::string> failure_;
  std::string unfinished_;  ///< path of a recording that is under way
  std::string refusal_;
  bool reached_end_ = false;

  // Of the simulation's thread, changed by what is asked.
  bool is_running_;
  double speed_;
  int wanted_steps_ = 0;
  void set_laws(std::size_t cloth, const std::vector<forces::LawSpecification>& laws);
  void begin_pace() { pace_start_.reset(); }

  const SimulationSettings settings_;
  const std::shared_ptr<WindowForces> forces_;

 private:
  void run();
  void simulate();
  /// Waits for leave to step; false to quit.
  bool wait();
  void step();
  void publish(bool is_frame);
  void record_frame(bool is_last);

  std::unique_ptr<scenes::Simulator> simulator_;
  std::unique_ptr<RunRecorder> recorder_;
  Meter meter_;
  scenes::Scene measured_scene_;
  scenes::StepReport report_;
  double step_time_ = 0.0;  ///< [s]
  long steps_per_frame_ = 1;
  long num_steps_ = 0;  ///< of the scene's duration
  Clock::time_point published_{};
  std::optional<Clock::time_point> pace_start_;
  double pace_time_ = 0.0;  ///< [s] simulated at pace_start_
  std::thread thread_;      // last: it uses all of the above
};

Simulation::Worker::Worker(SimulationSettings settings)
    : is_running_(settings.is_running),
      speed_(settings.speed),
      settings_(std::move(settings)),
      forces_(std::make_shared<WindowForces>(settings_.scene, settings_.scene.world.time_step)),
      meter_(settings_.scene),
      measured_scene_(settings_.scene) {
  const scenes::World& world = settings_.scene.world;
  steps_per_frame_ = std::max(1L, std::lround(world.frame_interval / world.time_step));
  num_steps_ = std::lround(world.duration / world.time_step);
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
  if (takes_forces(*settings_.engine)) simulator_->set_controllers({forces_});
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

void Simulation::Worker::step() {
  const Clock::time_point start = Clock::now();
  report_ = simulator_->step(settings_.scene.world.time_step);
  const double seconds = Seconds(Clock::now() - start).count();
  // The first step sets up what later ones use.
  if (report_.step > 1)
    step_time_ += (step_time_ > 0.0 ? kStepTimeWeight : 1.0) * (seconds - step_time_);
  const bool is_single = wanted_steps_ > 0;
  if (is_single) --wanted_steps_;
  const bool is_last = report_.step == num_steps_ || report_.blow_up.has_value();
  const bool is_frame = report_.step % steps_per_frame_ == 0;
  if (is_frame || is_last) record_frame(is_last);
  if (is_frame || is_last || is_single || Clock::now() - published_ > kPublishInterval) {
    publish(is_frame || is_last || is_single);
  }
}

void Simulation::Worker::record_frame(bool is_last) {
  if (recorder_ && report_.step <= num_steps_) {
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
  snapshot->step = report_.step;
  snapshot->step_time = step_time_;
  snapshot->pull_force = forces_->pull_force();
  snapshot->blow_up = report_.blow_up;
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
    meter_ = Meter(measured_scene_);
  } catch (const InvalidArgument& error) {
    const std::lock_guard lock(mutex_);
    refusal_ = error.what();
  }
}

Simulation::Simulation(SimulationSettings settings)
    : worker_(std::make_unique<Worker>(std::move(settings))) {}

Simulation::~Simulation() = default;

void Simulation::set_running(bool is_running) {
  worker_->ask([w = worker_.get(), is_running] { w->is_running_ = is_running; });
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

void Simulation::set_laws(std::size_t cloth, std::vector<forces::LawSpecification> laws) {
  worker_->ask([w = worker_.get(), cloth, laws = std::move(laws)] { w->set_laws(cloth, laws); });
}

void Simulation::set_gravity(const Vector3<double>& acceleration) {
  worker_->forces_->set_added_gravity(acceleration - worker_->settings_.scene.world.gravity);
}

void Simulation::set_pull(const std::optional<Pull>& pull) {
  worker_->forces_->set_pull(pull);
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
  return takes_forces(*worker_->settings_.engine);
}

}  // namespace weft::viewer
