#include <weft/playback/exchange/import/recording_import.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/exchange/exchange_body.hpp>
#include <weft/playback/exchange/import/face_agreement.hpp>
#include <weft/playback/exchange/import/rigid_fit.hpp>
#include <weft/scenes/characters/start_state.hpp>
#include <weft/scenes/controllers/collider_path.hpp>

namespace weft::scenes {
namespace {

/// Largest residual of a rigid body's points, as a part of the size of the box around them [-]: above the rounding of text with six
/// digits, below any change of shape that could be seen.
constexpr double kRigidTolerance = 1e-4;

/// Whether files must say how a collider moves; the scene knows it of all others.
bool needs_file(const Collider& collider) {
  return collider.mass.has_value() || !collider.led_by.empty();
}

const ImportedBody* find_body(const std::vector<ImportedBody>& bodies, const std::string& name) {
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const ImportedBody& body) { return body.name == name; });
  return found == bodies.end() ? nullptr : &*found;
}

void check_names(const Scene& scene, const std::vector<ImportedBody>& bodies) {
  for (auto body = bodies.begin(); body != bodies.end(); ++body) {
    const std::string& name = body->name;
    const auto is_it = [&](const auto& other) { return other.name == name; };
    if (std::any_of(bodies.begin(), body, is_it)) {
      throw InvalidArgument(fmt::format("{}: body '{}' is given twice, expected one file for it",
                                        body->shapes.source, name));
    }
    if (std::any_of(scene.cloths.begin(), scene.cloths.end(), is_it)) continue;
    const auto collider = std::find_if(scene.colliders.begin(), scene.colliders.end(), is_it);
    if (collider == scene.colliders.end()) {
      throw InvalidArgument(
          fmt::format("{}: scene '{}' has no body '{}', expected the name of a "
                      "cloth or of a collider that moves",
                      body->shapes.source, scene.name, name));
    }
    if (!needs_file(*collider)) {
      throw InvalidArgument(
          fmt::format("{}: collider '{}' is {}, as the scene says, expected no "
                      "file for it",
                      body->shapes.source, name, collider->path ? "led along a path" : "fixed"));
    }
  }
}

/// The same for all bodies.
struct Sampling {
  std::size_t num_samples = 0;
  double interval = 0.0;  ///< [s]
};

Sampling sampling_of(const std::vector<ImportedBody>& bodies, const ImportOptions& options) {
  if (!(options.frame_rate > 0) || !std::isfinite(options.frame_rate)) {
    throw InvalidArgument(
        fmt::format("import: frame rate = {} [1/s], expected > 0", options.frame_rate));
  }
  const ShapeSequence& first = bodies.front().shapes;
  for (const ImportedBody& body : bodies) {
    const ShapeSequence& shapes = body.shapes;
    if (shapes.samples.size() < 2) {
      throw Error(
          fmt::format("{}: has {} sample, expected at least 2: velocities are differences "
                      "of positions",
                      shapes.source, shapes.samples.size()));
    }
    if (shapes.samples.size() != first.samples.size() ||
        shapes.frames_per_sample != first.frames_per_sample) {
      throw Error(
          fmt::format("{}: has {} samples {} frames apart, expected {} samples {} frames "
                      "apart as {} has",
                      shapes.source, shapes.samples.size(), shapes.frames_per_sample,
                      first.samples.size(), first.frames_per_sample, first.source));
    }
  }
  return {first.samples.size(), first.frames_per_sample / options.frame_rate};
}

void check_mesh(const ExchangeBody& body, const ShapeSequence& shapes) {
  const Eigen::Index nodes = body.mesh.num_nodes();
  if (shapes.samples.front().cols() != nodes) {
    throw Error(fmt::format("{}: has {} points, expected the {} nodes of body '{}'", shapes.source,
                            shapes.samples.front().cols(), nodes, body.name));
  }
  if (shapes.faces.empty()) return;
  if (const auto fault = face_disagreement(body.mesh, shapes.faces)) {
    throw Error(fmt::format("{}: body '{}': {}, expected the nodes in the scene's order",
                            shapes.faces_source, body.name, *fault));
  }
}

/// Change per second of a quantity that is known at equal intervals. value(i): of sample i; difference(a, b): b - a.
template <class Value, class Difference>
auto rate(std::size_t i, const Sampling& sampling, const Value& value,
          const Difference& difference) {
  const std::size_t last = sampling.num_samples - 1;
  const double twice = 2 * sampling.interval;
  using Rate = std::decay_t<decltype(difference(value(0), value(1)))>;
  if (i > 0 && i < last) return Rate(difference(value(i - 1), value(i + 1)) / twice);
  if (last == 1) return Rate(difference(value(0), value(1)) / sampling.interval);
  const std::size_t middle = i == 0 ? 1 : last - 1;
  const std::size_t far = i == 0 ? 2 : last - 2;
  const double sign = i == 0 ? 1.0 : -1.0;
  return Rate(sign * (4 * difference(value(i), value(middle)) - difference(value(i), value(far))) /
              twice);
}

std::vector<ClothState> cloth_states(const ExchangeBody& body, const ShapeSequence& shapes,
                                     const Sampling& sampling) {
  std::vector<ClothState> states;
  const auto value = [&](std::size_t i) -> const Matrix3X<double>& { return shapes.samples[i]; };
  const auto difference = [](const Matrix3X<double>& a, const Matrix3X<double>& b) {
    return Matrix3X<double>(b - a);
  };
  for (std::size_t i = 0; i < sampling.num_samples; ++i) {
    states.push_back({body.name, value(i), rate(i, sampling, value, difference)});
  }
  return states;
}

std::vector<RigidState> rigid_states(const std::string& name, const std::vector<Pose>& poses,
                                     const Sampling& sampling) {
  const auto place = [&](std::size_t i) { return poses[i].position; };
  const auto shift = [](const Vector3<double>& a, const Vector3<double>& b) {
    return Vector3<double>(b - a);
  };
  const auto orientation = [&](std::size_t i) { return poses[i].orientation; };
  const auto turn = [](const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
    const Eigen::AngleAxisd rotation(b * a.conjugate());
    return Vector3<double>(rotation.angle() * rotation.axis());
  };
  std::vector<RigidState> states;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    states.push_back({name, poses[i].position, poses[i].orientation,
                      rate(i, sampling, place, shift), rate(i, sampling, orientation, turn)});
  }
  return states;
}

std::vector<Pose> fitted_poses(const ExchangeBody& body, const ShapeSequence& shapes) {
  const Matrix3X<double>& own = body.mesh.rest_positions;
  const double size = (own.rowwise().maxCoeff() - own.rowwise().minCoeff()).norm();
  std::vector<Pose> poses;
  for (const Matrix3X<double>& sample : shapes.samples) {
    const RigidFit fit = fit_rigid(own, sample);
    if (!(fit.largest_residual <= kRigidTolerance * size)) {
      throw Error(fmt::format(
          "{}: sample {}: a point is {:.3g} m from where a rigid body '{}' has "
          "it, expected at most {:.3g} m",
          shapes.source, poses.size(), fit.largest_residual, body.name, kRigidTolerance * size));
    }
    poses.push_back(fit.pose);
  }
  return poses;
}

double largest_distance(const Matrix3X<double>& a, const Matrix3X<double>& b) {
  return (a - b).colwise().norm().maxCoeff();
}

/// How far the first sample of a body is from the scene's start [m].
double start_distance(const Scene& scene, const ExchangeBody& body, const ShapeSequence& shapes) {
  Matrix3X<double> start;
  if (body.is_rigid) {
    const Pose pose = start_pose(scene.colliders[body.index]);
    start =
        (pose.orientation.toRotationMatrix() * body.mesh.rest_positions).colwise() + pose.position;
  } else {
    start = start_state(scene.cloths[body.index], body.mesh).positions;
  }
  return largest_distance(start, shapes.samples.front());
}

void check_start(const Scene& scene, const ExchangeBody& body, const ShapeSequence& shapes,
                 const ImportOptions& options, Import& result) {
  const double distance = start_distance(scene, body, shapes);
  result.start_distance = std::max(result.start_distance, distance);
  const double tolerance = start_tolerance(scene);
  if (distance <= tolerance || !options.other_start.empty()) return;
  throw Error(
      fmt::format("{}: the first sample of body '{}' is up to {:.3g} m from where the scene "
                  "starts it, expected at most {:.3g} m: another order of nodes, unit, axis, "
                  "or a later time",
                  shapes.source, body.name, distance, tolerance));
}

void add_provenance(const std::vector<ImportedBody>& bodies, const ImportOptions& options,
                    Import& result) {
  Provenance& provenance = result.provenance;
  provenance["engine"] = kImported;
  for (const ImportedBody& body : bodies) {
    const std::string name = "imported_" + body.name;
    provenance[name] = fmt::format(
        "{}, {} samples, XXH3 {}{}", body.shapes.source, body.shapes.samples.size(),
        body.shapes.content_hash,
        body.shapes.faces.empty() ? "; its faces are not known" : "; faces as in the scene");
  }
  provenance["imported_frame_rate"] = fmt::format("{} Hz", options.frame_rate);
  provenance["imported_velocities"] = "central differences of positions";
  if (!options.other_start.empty()) {
    provenance["imported_start"] = fmt::format("up to {:.3g} m from the scene's: {}",
                                               result.start_distance, options.other_start);
  }
}

void add_rigid(std::size_t index, const std::vector<RigidState>& states, Import& result) {
  for (std::size_t i = 0; i < states.size(); ++i) result.frames[i].rigids[index] = states[i];
}

/// Colliders that stand still or are led along a path of the scene.
void add_prescribed(const Scene& scene, const Sampling& sampling, Import& result) {
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    const Collider& collider = scene.colliders[c];
    if (needs_file(collider)) {
      if (!std::holds_alternative<PlaneShape>(collider.shape)) continue;
      throw InvalidArgument(
          fmt::format("import: collider '{}' is a plane that moves, expected a "
                      "shape that files can have",
                      collider.name));
    }
    std::vector<Pose> poses;
    for (const SceneState& frame : result.frames) {
      poses.push_back(prescribed_pose(collider, frame.time));
    }
    add_rigid(c, rigid_states(collider.name, poses, sampling), result);
  }
}

void add_body(const Scene& scene, const ExchangeBody& body, const ShapeSequence& shapes,
              const Sampling& sampling, const ImportOptions& options, Import& result) {
  check_mesh(body, shapes);
  check_start(scene, body, shapes, options, result);
  if (!shapes.faces.empty()) ++result.num_checked_faces;
  if (shapes.precision == StoredPrecision::kFloat32) result.precision = shapes.precision;
  if (body.is_rigid) {
    add_rigid(body.index, rigid_states(body.name, fitted_poses(body, shapes), sampling), result);
    return;
  }
  std::vector<ClothState> states = cloth_states(body, shapes, sampling);
  for (std::size_t i = 0; i < states.size(); ++i) {
    result.frames[i].cloths[body.index] = std::move(states[i]);
  }
}

Import empty_frames(const Scene& scene, const Sampling& sampling) {
  Import result;
  result.frames.resize(sampling.num_samples);
  for (std::size_t i = 0; i < sampling.num_samples; ++i) {
    result.frames[i].time = static_cast<double>(i) * sampling.interval;
    result.frames[i].cloths.resize(scene.cloths.size());
    result.frames[i].rigids.resize(scene.colliders.size());
  }
  return result;
}

}  // namespace

Import import_states(const Scene& scene, const std::vector<ImportedBody>& bodies,
                     const ImportOptions& options) {
  if (bodies.empty()) throw InvalidArgument("import: no file, expected one for each cloth");
  check_names(scene, bodies);
  const Sampling sampling = sampling_of(bodies, options);
  Import result = empty_frames(scene, sampling);
  add_prescribed(scene, sampling, result);
  for (const ExchangeBody& body : exchange_bodies(scene)) {
    if (body.is_rigid && !needs_file(scene.colliders[body.index])) continue;
    const ImportedBody* const given = find_body(bodies, body.name);
    if (given == nullptr) {
      throw InvalidArgument(
          fmt::format("import: {} '{}' of scene '{}' has no file, expected one: "
                      "its motion is not in the scene",
                      body.is_rigid ? "collider" : "cloth", body.name, scene.name));
    }
    add_body(scene, body, given->shapes, sampling, options, result);
  }
  add_provenance(bodies, options, result);
  return result;
}

}  // namespace weft::scenes
