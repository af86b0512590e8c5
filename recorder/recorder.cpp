#include <weft/recorder/recorder.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/core/error.hpp>
#include <weft/recorder/frame_marks.hpp>
#include <weft/recorder/own_scene.hpp>
#include <weft/recorder/placed_shape.hpp>
#include <weft/recorder/recorded_cloth.hpp>
#include <weft/recorder/temporary_folder.hpp>
#include <weft/recorder/window_process.hpp>
#include <weft/scenes/recording/own_loop.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/recording_output.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using bridge::from_bullet;

/// A frame is taken when this share of an interval is missing: a program's time is a sum of rounded
/// steps.
constexpr double kEarlyShare = 1e-3;

/// A commit delays a step: smaller chunks than those of `weft run`, each within a few milliseconds.
constexpr scenes::ChunkLimits kChunks{.frames = 64, .bytes = std::size_t{256} * 1024};

/// So often a window gets new frames. [s] of the program's time
constexpr double kWindowInterval = 0.1;

scenes::ChunkLimits chunk_limits(const RecorderOptions& options) {
  scenes::ChunkLimits limits = kChunks;
  if (options.back_end != BackEnd::kFile) {
    const double frames = std::round(kWindowInterval / options.frame_interval);
    limits.frames = static_cast<int>(std::clamp(frames, 1.0, static_cast<double>(kChunks.frames)));
  }
  return limits;
}

Eigen::Quaterniond quaternion_of(const btQuaternion& q) {
  return {static_cast<double>(q.w()), static_cast<double>(q.x()), static_cast<double>(q.y()),
          static_cast<double>(q.z())};
}

}  // namespace

struct Recorder::Impl {
  struct Soft {
    const btSoftBody* body;
    std::optional<FollowedFaces> faces;  ///< of one that may tear
  };
  struct Rigid {
    const btCollisionObject* body;
    Vector3<double> position;  ///< of the drawn shape in the body's frame [m]
    Eigen::Quaterniond orientation;
  };

  Impl(std::filesystem::path path, const RecorderOptions& the_options)
      : options(the_options),
        scene(empty_scene(options)),
        num_exceptions(std::uncaught_exceptions()) {
    require_readable(scene, "recorder");
    if (options.back_end == BackEnd::kWindow) {
      folder.emplace();
      path = folder->path() / (options.name + ".weftrec");
    }
    file = path.string();
    if (!is_off()) output.emplace(path, options.may_replace);
  }

  [[nodiscard]] bool is_off() const { return options.back_end == BackEnd::kNone; }
  void show();
  void take_frame();
  void require_frame(const std::string& what) const;

  void require_new(const std::string& name) const;
  void read_state(double time);
  void follow_tear(std::size_t index);
  void read_cloth(std::size_t index);
  void read_rigid(std::size_t index);
  [[nodiscard]] bool is_due(double time) const;
  void write_blow_up(double time);
  void begin();
  /// The message about a recording that is not completed: why, and where its frames are.
  [[nodiscard]] std::string keep_frames(std::string why);

  RecorderOptions options;
  scenes::Scene scene;
  std::optional<TemporaryFolder> folder;  ///< of a recording that is only shown
  std::optional<WindowProcess> window;
  std::string file;
  int num_exceptions;
  std::vector<Soft> cloths;
  std::vector<Rigid> rigids;
  scenes::SceneState state;
  FrameMarks marks;  ///< of the frame that has begun
  bool is_in_frame = false;
  bool is_frame_due = false;
  std::optional<scenes::RecordingOutput> output;  ///< none when all is done
  std::unique_ptr<scenes::RecordingWriter> writer;
  std::string content_hash;
  double last_call = -std::numeric_limits<double>::infinity();  ///< [s]
  double first_time = 0.0;                                      ///< [s] of the first frame
  double last_interval = 0.0;  ///< number of the interval that the last frame stands for
  int num_frames = 0;
  int num_calls = 0;  ///< of begin_frame(): the program's steps
  std::optional<scenes::BlowUp> blow_up;
  bool is_blow_up_written = false;
};

void Recorder::Impl::require_new(const std::string& name) const {
  if (writer || (!output && !is_off())) {
    throw InvalidArgument(fmt::format(
        "recorder: '{}' comes after the first frame, expected all bodies before it", name));
  }
  const auto has_name = [&](const auto& body) { return body.name == name; };
  if (std::any_of(scene.cloths.begin(), scene.cloths.end(), has_name) ||
      std::any_of(scene.colliders.begin(), scene.colliders.end(), has_name)) {
    throw InvalidArgument(
        fmt::format("recorder: '{}' is the name of another body, expected a new one", name));
  }
}

void Recorder::Impl::follow_tear(std::size_t index) {
  const Soft& soft = cloths[index];
  scenes::ClothState& cloth = state.cloths[index];
  const int num_nodes = soft.body->m_nodes.size();
  if (!soft.faces || num_nodes < cloth.positions.cols()) {
    throw InvalidArgument(fmt::format("recorder: '{}' has {} nodes, expected {} as before{}",
                                      cloth.name, num_nodes, cloth.positions.cols(),
                                      soft.faces ? " or more" : ", or Wholeness::kMayTear"));
  }
  try {
    cloth.topology = soft.faces->now(*soft.body);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("recorder: '{}' {}", cloth.name, error.what()));
  }
  cloth.positions.resize(3, num_nodes);
  cloth.velocities.resize(3, num_nodes);
}

void Recorder::Impl::read_cloth(std::size_t index) {
  const btSoftBody& body = *cloths[index].body;
  scenes::ClothState& cloth = state.cloths[index];
  const int num_nodes = body.m_nodes.size();
  if (num_nodes != cloth.positions.cols()) follow_tear(index);
  for (int i = 0; i < num_nodes; ++i) {
    cloth.positions.col(i) = from_bullet(body.m_nodes[i].m_x);
    cloth.velocities.col(i) = from_bullet(body.m_nodes[i].m_v);
  }
}

void Recorder::Impl::read_rigid(std::size_t index) {
  const Rigid& place = rigids[index];
  scenes::RigidState& rigid = state.rigids[index];
  const btTransform& transform = place.body->getWorldTransform();
  const Eigen::Quaterniond orientation = quaternion_of(transform.getRotation());
  rigid.position = from_bullet(transform.getOrigin()) + orientation * place.position;
  rigid.orientation = orientation * place.orientation;
  if (const btRigidBody* body = btRigidBody::upcast(place.body)) {
    rigid.velocity = from_bullet(body->getLinearVelocity());
    rigid.angular_velocity = from_bullet(body->getAngularVelocity());
  }
}

void Recorder::Impl::read_state(double time) {
  state.time = time;
  for (std::size_t c = 0; c < cloths.size(); ++c) read_cloth(c);
  for (std::size_t r = 0; r < rigids.size(); ++r) read_rigid(r);
}

bool Recorder::Impl::is_due(double time) const {
  if (num_frames == 0) return true;
  if (blow_up && !is_blow_up_written && time > state.time) return true;
  return (time - first_time) / options.frame_interval + kEarlyShare >= last_interval + 1;
}

void Recorder::Impl::write_blow_up(double time) {
  if (!blow_up || is_blow_up_written) return;
  blow_up->step = num_calls;
  blow_up->time = time;
  writer->set_blow_up(*blow_up);
  is_blow_up_written = true;
}

void Recorder::Impl::begin() {
  if (cloths.empty()) {
    throw InvalidArgument("recorder: no soft body, expected at least one before the first frame");
  }
  const btSoftBodyWorldInfo* const info = cloths[0].body->m_worldInfo;
  if (!options.gravity && info != nullptr) {
    scene.world.gravity = from_bullet(info->m_gravity);
  }
  for (std::size_t r = 0; r < rigids.size(); ++r) {
    scenes::Collider& collider = scene.colliders[r];
    collider.position = state.rigids[r].position;
    collider.orientation = state.rigids[r].orientation.normalized();
  }
  if (!options.view) scene.camera = view_of(scene, state);
  const auto precision =
      sizeof(btScalar) == sizeof(double) && options.precision != Precision::kSingle
          ? scenes::StoredPrecision::kFloat64
          : scenes::StoredPrecision::kFloat32;
  const scenes::Provenance provenance{
      {"engine", std::string(scenes::kOwnLoop)},
      {"weft", WEFT_VERSION},
      {"bullet", fmt::format("{}.{}, {}", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100,
                             bridge::precision_name())}};
  writer = std::make_unique<scenes::RecordingWriter>(output->partial(), scene, provenance,
                                                     precision, chunk_limits(options));
}

void Recorder::Impl::show() {
  const bool has_window =
      options.back_end == BackEnd::kWindow || options.back_end == BackEnd::kBoth;
  if (!has_window || window) return;
  writer->commit();  // a window opens no recording without a frame
  window.emplace(options.window_program, output->partial());
}

void Recorder::Impl::take_frame() {
  read_state(last_call);
  writer->add_frame(state, marks.marks());
  if (num_frames++ == 0) first_time = last_call;
  last_interval = std::floor((last_call - first_time) / options.frame_interval + kEarlyShare);
  write_blow_up(last_call);
  show();
}

void Recorder::Impl::require_frame(const std::string& what) const {
  if (!is_in_frame) {
    throw InvalidArgument(
        fmt::format("recorder: {}, expected it between begin_frame() and end_frame()", what));
  }
}

std::string Recorder::Impl::keep_frames(std::string why) {
  scenes::RecordingWriter::Committed kept;
  if (writer) {
    try {
      write_blow_up(last_call);
      writer->commit();
    } catch (const Error&) {
      why += "; what came after the last commit cannot be stored";
    }
    kept = writer->committed();
    writer.reset();
    if (kept.frames == 0) output->discard();
  }
  if (kept.frames > 0) {
    why += fmt::format("; {} frames up to t = {:.6g} s are kept in {}", kept.frames, kept.time,
                       output->partial().string());
  }
  output.reset();
  return why;
}

Recorder::Recorder(const std::filesystem::path& path, const RecorderOptions& options)
    : impl_(std::make_unique<Impl>(path, options)) {}

Recorder::~Recorder() {
  try {
    if (impl_->output) {
      if (impl_->num_frames == 0 || std::uncaught_exceptions() > impl_->num_exceptions) {
        (void)impl_->keep_frames({});
      } else {
        finish();
      }
    }
    if (impl_->folder && impl_->window) impl_->window->wait();
  } catch (...) {  // NOLINT(bugprone-empty-catch): the frames stay in the partial recording, and
                   // nobody can be told
  }
}

void Recorder::add(const btSoftBody& body, const std::string& name, Wholeness wholeness) {
  impl_->require_new(name);
  scenes::Cloth cloth;
  try {
    cloth = recorded_cloth(body, name);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("recorder: '{}': {}", name, error.what()));
  }
  std::optional<FollowedFaces> faces;
  if (wholeness == Wholeness::kMayTear) {
    faces.emplace(body, scenes::make_mesh(cloth).triangles);
    cloth.tear.emplace();  // a recording has place for torn cloth only where the scene's may tear
  }
  scenes::Scene alone = empty_scene(impl_->options);
  alone.cloths.push_back(cloth);
  require_readable(std::move(alone), fmt::format("recorder: '{}'", name));
  const int num_nodes = body.m_nodes.size();
  impl_->state.cloths.push_back(
      {name, Matrix3X<double>(3, num_nodes), Matrix3X<double>(3, num_nodes)});
  impl_->scene.cloths.push_back(std::move(cloth));
  impl_->cloths.push_back({&body, std::move(faces)});
}

void Recorder::add(const btCollisionObject& body, const std::string& name) {
  if (const btSoftBody* soft = btSoftBody::upcast(&body)) return add(*soft, name);
  impl_->require_new(name);
  if (body.getCollisionShape() == nullptr) {
    throw InvalidArgument(fmt::format("recorder: '{}' has no shape, expected one", name));
  }
  const PlacedShape placed =
      placed_shape(*body.getCollisionShape(), fmt::format("recorder: '{}'", name));
  scenes::Collider collider;
  collider.name = name;
  collider.shape = placed.shape;
  collider.friction = static_cast<double>(body.getFriction());
  const btRigidBody* rigid = btRigidBody::upcast(&body);
  if (rigid != nullptr && rigid->getInvMass() > 0) {
    collider.mass = 1 / static_cast<double>(rigid->getInvMass());
  }
  scenes::Scene alone = empty_scene(impl_->options);
  alone.colliders.push_back(collider);
  require_readable(std::move(alone), fmt::format("recorder: '{}'", name));
  scenes::RigidState state;
  state.name = name;
  impl_->state.rigids.push_back(std::move(state));
  impl_->scene.colliders.push_back(std::move(collider));
  impl_->rigids.push_back({&body, placed.position, placed.orientation});
}

bool Recorder::record(double time) {
  begin_frame(time);
  return end_frame();
}

bool Recorder::begin_frame(double time) {
  Impl& impl = *impl_;
  if (impl.is_in_frame) {
    throw InvalidArgument(
        "recorder: a frame in a frame, expected end_frame() before begin_frame()");
  }
  if (!impl.output && !impl.is_off()) {
    throw InvalidArgument(fmt::format("{}: is finished, expected no further frame", impl.file));
  }
  if (!std::isfinite(time) || time < impl.last_call) {
    throw InvalidArgument(fmt::format("recorder: time = {} [s], expected at least {} and finite",
                                      time, impl.last_call));
  }
  impl.is_frame_due = !impl.is_off() && impl.is_due(time);
  if (impl.is_frame_due && !impl.writer) {
    impl.read_state(time);
    impl.begin();
  }
  impl.last_call = time;
  ++impl.num_calls;
  impl.is_in_frame = true;
  return impl.is_frame_due;
}

bool Recorder::end_frame() {
  Impl& impl = *impl_;
  impl.require_frame("end_frame()");
  impl.is_in_frame = false;
  // A blow-up since the beginning asks for a frame.
  const bool is_due = !impl.is_off() && (impl.is_frame_due || impl.is_due(impl.last_call));
  if (is_due) impl.take_frame();
  impl.marks.clear();
  return is_due;
}

void Recorder::log_points(const std::string& name, std::span<const btVector3> points) {
  impl_->require_frame(fmt::format("points '{}'", name));
  if (impl_->is_frame_due) impl_->marks.add(scenes::MarkKind::kPoints, name, points, {});
}

void Recorder::log_lines(const std::string& name, std::span<const btVector3> begins,
                         std::span<const btVector3> ends) {
  impl_->require_frame(fmt::format("lines '{}'", name));
  if (impl_->is_frame_due) impl_->marks.add(scenes::MarkKind::kLines, name, begins, ends);
}

void Recorder::log_arrows(const std::string& name, std::span<const btVector3> origins,
                          std::span<const btVector3> vectors) {
  impl_->require_frame(fmt::format("arrows '{}'", name));
  if (!impl_->is_frame_due) return;
  std::vector<btVector3> ends(vectors.begin(), vectors.end());
  for (std::size_t i = 0; i < std::min(ends.size(), origins.size()); ++i) ends[i] += origins[i];
  impl_->marks.add(scenes::MarkKind::kArrows, name, origins, ends);
}

void Recorder::event(const std::string& text) {
  if (impl_->is_off()) return;
  if (!impl_->writer) {
    throw InvalidArgument(fmt::format(
        "recorder: event '{}' comes before the first frame or after the end, expected it between",
        text));
  }
  impl_->writer->add_note({impl_->last_call, text});
}

void Recorder::blow_up(const btSoftBody& body, int node, const std::string& reason) {
  Impl& impl = *impl_;
  const auto soft = std::find_if(impl.cloths.begin(), impl.cloths.end(),
                                 [&](const Impl::Soft& one) { return one.body == &body; });
  if (soft == impl.cloths.end() || impl.blow_up) return;
  scenes::BlowUp& blow_up = impl.blow_up.emplace();
  blow_up.body = impl.state.cloths[static_cast<std::size_t>(soft - impl.cloths.begin())].name;
  blow_up.node = node;
  blow_up.reason = reason;
}

void Recorder::metric(const std::string& name, double value) {
  if (impl_->is_off()) return;
  if (!impl_->writer) {
    throw InvalidArgument(fmt::format(
        "recorder: metric '{}' comes before the first frame or after the end, expected it between",
        name));
  }
  impl_->writer->add_metric(name, impl_->last_call, value);
}

std::string Recorder::finish() {
  Impl& impl = *impl_;
  if (!impl.content_hash.empty() || impl.is_off()) return impl.content_hash;
  if (!impl.output || impl.num_frames == 0) {
    throw Error(fmt::format("{}: has no frame, expected record() before finish()", impl.file));
  }
  std::string hash;
  try {
    impl.write_blow_up(impl.last_call);
    hash = impl.writer->finish();
  } catch (const Error& error) {
    throw Error(impl.keep_frames(error.what()));
  }
  impl.writer.reset();
  impl.content_hash = std::move(hash);
  try {
    impl.output->publish();
  } catch (...) {
    impl.output.reset();  // the message says where the recording is
    throw;
  }
  impl.output.reset();
  return impl.content_hash;
}

int Recorder::num_frames() const {
  return impl_->num_frames;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
