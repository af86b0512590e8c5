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
#include <weft/recorder/placed_shape.hpp>
#include <weft/recorder/recorded_cloth.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/own_loop.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/recording_output.hpp>
#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

using bridge::from_bullet;

/// The duration of a loop is not known when its scene is written: so many frame intervals.
constexpr double kNominalFrames = 1e6;

/// A frame is taken when this share of an interval is missing: a program's time is a sum of rounded
/// steps.
constexpr double kEarlyShare = 1e-3;

/// A commit delays a step: smaller chunks than those of `weft run`, each within a few milliseconds.
constexpr scenes::ChunkLimits kChunks{.frames = 64, .bytes = std::size_t{256} * 1024};

/// Space around the bodies of the first frame, as a factor on the distance that just shows them.
constexpr double kViewSpace = 1.5;

Vector3<double> vector_of(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

Eigen::Quaterniond quaternion_of(const btQuaternion& q) {
  return {static_cast<double>(q.w()), static_cast<double>(q.x()), static_cast<double>(q.y()),
          static_cast<double>(q.z())};
}

scenes::Scene empty_scene(const RecorderOptions& options) {
  if (!(options.frame_interval > 0) || !std::isfinite(options.frame_interval)) {
    throw InvalidArgument(fmt::format("recorder: frame_interval = {} [s], expected > 0 and finite",
                                      options.frame_interval));
  }
  scenes::Scene scene;
  scene.name = options.name;
  scene.summary = options.summary;
  scene.world.time_step = options.frame_interval;
  scene.world.frame_interval = options.frame_interval;
  scene.world.duration = kNominalFrames * options.frame_interval;
  if (options.gravity) scene.world.gravity = vector_of(*options.gravity);
  if (options.view) {
    scene.camera.position = vector_of(options.view->position);
    scene.camera.target = vector_of(options.view->target);
  }
  return scene;
}

/// Throws InvalidArgument, which begins with `what`, if no reader would take this scene.
void require_readable(scenes::Scene scene, const std::string& what) {
  if (scene.cloths.empty()) {  // a scene needs one, which must not have the name of a collider
    scenes::Cloth& cloth = scene.cloths.emplace_back();
    cloth.name = scene.colliders.empty() || scene.colliders[0].name != "cloth" ? "cloth" : "other";
  }
  try {
    (void)scenes::read_scene_text(scenes::write_scene(scene), "scene");
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("{}: {}", what, error.what()));
  }
}

/// A view from the front, the right and above of everything but planes.
scenes::Camera view_of(const scenes::Scene& scene, const scenes::SceneState& state) {
  Eigen::AlignedBox3d box;
  for (const scenes::ClothState& cloth : state.cloths) {
    for (const auto& position : cloth.positions.colwise()) {
      if (position.allFinite()) box.extend(position);
    }
  }
  for (std::size_t r = 0; r < state.rigids.size(); ++r) {
    if (!scene.colliders[r].mass) continue;
    const scenes::RigidState& rigid = state.rigids[r];
    const scenes::MeshShape surface = scenes::shape_surface(scene.colliders[r].shape, 8);
    for (const auto& point : surface.points.colwise()) {
      const Vector3<double> position = rigid.position + rigid.orientation * point;
      if (position.allFinite()) box.extend(position);
    }
  }
  scenes::Camera camera;
  if (box.isEmpty() || !(box.diagonal().norm() > 0)) return camera;
  const double distance =
      kViewSpace * 0.5 * box.diagonal().norm() / std::sin(0.5 * camera.field_of_view);
  camera.target = box.center();
  camera.position = camera.target + distance * Vector3<double>(0.6, 0.4, 0.7).normalized();
  return camera;
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

  Impl(const std::filesystem::path& path, const RecorderOptions& the_options)
      : options(the_options),
        scene(empty_scene(options)),
        file(path.string()),
        num_exceptions(std::uncaught_exceptions()) {
    require_readable(scene, "recorder");
    output.emplace(path, options.may_replace);
  }

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
  std::string file;
  int num_exceptions;
  std::vector<Soft> cloths;
  std::vector<Rigid> rigids;
  scenes::SceneState state;
  std::optional<scenes::RecordingOutput> output;  ///< none when all is done
  std::unique_ptr<scenes::RecordingWriter> writer;
  std::string content_hash;
  double last_call = -std::numeric_limits<double>::infinity();  ///< [s]
  double first_time = 0.0;                                      ///< [s] of the first frame
  double last_interval = 0.0;  ///< number of the interval that the last frame stands for
  int num_frames = 0;
  int num_calls = 0;  ///< of record(): the program's steps
  std::optional<scenes::BlowUp> blow_up;
  bool is_blow_up_written = false;
};

void Recorder::Impl::require_new(const std::string& name) const {
  if (num_frames > 0 || !output) {
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
                                                     precision, kChunks);
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
  if (!impl_->output) return;
  try {
    if (impl_->num_frames == 0 || std::uncaught_exceptions() > impl_->num_exceptions) {
      (void)impl_->keep_frames({});
    } else {
      finish();
    }
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
  Impl& impl = *impl_;
  if (!impl.output) {
    throw InvalidArgument(fmt::format("{}: is finished, expected no further frame", impl.file));
  }
  if (!std::isfinite(time) || time < impl.last_call) {
    throw InvalidArgument(fmt::format("recorder: time = {} [s], expected at least {} and finite",
                                      time, impl.last_call));
  }
  if (!impl.is_due(time)) {
    impl.last_call = time;
    ++impl.num_calls;
    return false;
  }
  impl.read_state(time);
  if (!impl.writer) impl.begin();
  impl.writer->add_frame(impl.state);
  impl.last_call = time;
  ++impl.num_calls;
  if (impl.num_frames++ == 0) impl.first_time = time;
  impl.last_interval =
      std::floor((time - impl.first_time) / impl.options.frame_interval + kEarlyShare);
  impl.write_blow_up(time);
  return true;
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
  if (!impl_->writer) {
    throw InvalidArgument(fmt::format(
        "recorder: metric '{}' comes before the first frame or after the end, expected it between",
        name));
  }
  impl_->writer->add_metric(name, impl_->last_call, value);
}

std::string Recorder::finish() {
  Impl& impl = *impl_;
  if (!impl.content_hash.empty()) return impl.content_hash;
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
