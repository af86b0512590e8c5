#include <weft/playback/exchange/gltf/gltf_export.hpp>

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/playback/exchange/gltf/glb_writer.hpp>
#include <weft/playback/exchange/gltf/gltf_animation.hpp>
#include <weft/playback/exchange/gltf/gltf_body.hpp>
#include <weft/playback/exchange/gltf/gltf_cloth.hpp>
#include <weft/playback/exchange/gltf/gltf_material.hpp>
#include <weft/playback/exchange/unfit_recording.hpp>
#include <weft/playback/rendering/view.hpp>

namespace weft::scenes {
namespace {

/// The near plane of the camera, as a part of its distance from what it looks at.
constexpr double kNearPart = 0.01;

Eigen::RowVectorXf times_of(const RecordingReader& reader) {
  Eigen::RowVectorXf times(reader.num_frames());
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    times[frame] = static_cast<float>(reader.frame_time(frame));
    const bool is_first = frame == 0;
    if (times[frame] >= 0.0f && (is_first || times[frame] > times[frame - 1])) continue;
    throw UnfitRecording(fmt::format(
        "frame {} is at t = {:.9g} s, expected {} in single precision, which glTF has", frame,
        reader.frame_time(frame), is_first ? "at least 0 s" : "a later time than that before"));
  }
  return times;
}

/// A turn by quarters that takes the axis that points upwards most to y; none for a scene without gravity.
Eigen::Quaterniond upright(const Vector3<double>& gravity) {
  Eigen::Index axis = 0;
  if (gravity.cwiseAbs().maxCoeff(&axis) == 0.0) return Eigen::Quaterniond::Identity();
  const Vector3<double> up = -std::copysign(1.0, gravity[axis]) * Vector3<double>::Unit(axis);
  if (axis == 1) {
    return up.y() > 0.0 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  }
  Eigen::Quaterniond quarter;
  quarter.vec() = up.cross(Vector3<double>::UnitY()) * std::sqrt(0.5);
  quarter.w() = std::sqrt(0.5);
  return quarter;
}

bool has_surface(const ClothMesh& mesh) {
  return mesh.triangles.cols() > 0 ||
         (mesh.has_edge_set("stretch") && mesh.edges_of({"stretch"}).cols() > 0);
}

bool is_shown(const Cloth& cloth) {
  return cloth.appearance.visible && has_surface(make_mesh(cloth));
}

bool is_shown(const Collider& collider) {
  return collider.appearance.visible && !std::holds_alternative<PlaneShape>(collider.shape);
}

/// The poses of everything that keeps its shape.
struct Poses {
  std::vector<PoseTrack> rigids;
  PoseTrack camera;
};

Poses read_poses(const RecordingReader& reader, const std::function<void()>& on_frame) {
  const Scene& scene = reader.scene();
  std::vector<ClothMesh> meshes;
  for (const Cloth& cloth : scene.cloths) meshes.push_back(make_mesh(cloth));
  const Eigen::Quaterniond camera_turn(camera_axes(scene.camera));
  Poses poses{std::vector<PoseTrack>(scene.colliders.size(), PoseTrack(reader.num_frames())),
              PoseTrack(reader.num_frames())};
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const SceneState state = reader.frame(frame);
    check_finite(state, frame);
    for (std::size_t i = 0; i < state.rigids.size(); ++i) {
      poses.rigids[i].set(frame, state.rigids[i].position, state.rigids[i].orientation);
    }
    poses.camera.set(frame, scene.camera.position + camera_shift(scene, meshes, state),
                     camera_turn);
    on_frame();
  }
  return poses;
}

int add_camera(GlbWriter& writer, GltfAnimation& animation, const Camera& camera,
               const PoseTrack& track) {
  const double distance = (camera.position - camera.target).norm();
  const GltfJson lens = {{"yfov", camera.field_of_view}, {"znear", kNearPart * distance}};
  const int index =
      writer.add("cameras", {{"name", "camera"}, {"type", "perspective"}, {"perspective", lens}});
  return add_posed_node(writer, animation, track, {{"name", "camera"}, {"camera", index}});
}

GltfJson extras_of(const RecordingReader& reader, const GltfOptions& options,
                   const GltfReport& report) {
  GltfJson cloths = GltfJson::array();
  for (const GltfClothReport& cloth : report.cloths) {
    cloths.push_back({{"name", cloth.name},
                      {"nodes", cloth.num_nodes},
                      {"morph_targets", cloth.num_targets},
                      {"largest_error_m", cloth.largest_error},
                      {"rms_error_m", cloth.rms_error},
                      {"normal_rms_error_rad", cloth.normal_rms_error},
                      {"is_within_error", cloth.is_within_error}});
  }
  const auto engine = reader.provenance().find("engine");
  return {{"scene", reader.scene().name},
          {"engine", engine == reader.provenance().end() ? "unknown" : engine->second},
          {"content_hash", reader.content_hash()},
          {"frames", reader.num_frames()},
          {"error_m", options.error},
          {"cloths", std::move(cloths)},
          {"left_out", report.left_out}};
}

}  // namespace

GltfExport export_gltf(const RecordingReader& reader, const GltfOptions& options,
                       const std::function<void(double)>& on_progress) {
  if (reader.num_frames() == 0) throw InvalidArgument("export_gltf: a recording without a frame");
  const Scene& scene = reader.scene();
  GlbWriter writer;
  GltfMaterials materials(writer, scene);
  GltfAnimation animation(writer, times_of(reader));
  GltfReport report;
  const double num_reads = static_cast<double>(scene.cloths.size() + 1) * reader.num_frames();
  int num_done = 0;
  const auto on_frame = [&] {
    if (on_progress) on_progress(++num_done / num_reads);
  };
  const Poses poses = read_poses(reader, on_frame);

  GltfJson children = GltfJson::array();
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    if (!is_shown(scene.cloths[i])) {
      report.left_out.push_back(scene.cloths[i].name);
      continue;
    }
    GltfClothNode cloth = add_cloth({writer, materials, animation}, reader, i, options, on_frame);
    children.push_back(cloth.node);
    report.cloths.push_back(std::move(cloth.report));
  }
  GltfBodies bodies(writer, materials);
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    const Collider& collider = scene.colliders[i];
    if (!is_shown(collider)) {
      report.left_out.push_back(collider.name);
      continue;
    }
    const int mesh = bodies.add_mesh(scene, collider);
    children.push_back(add_posed_node(writer, animation, poses.rigids[i],
                                      {{"name", collider.name}, {"mesh", mesh}}));
    ++report.num_rigid_bodies;
  }
  children.push_back(add_camera(writer, animation, scene.camera, poses.camera));
  const Eigen::Quaterniond turn = upright(scene.world.gravity);
  const int top = writer.add("nodes", {{"name", scene.name},
                                       {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                                       {"children", std::move(children)}});
  writer.add("scenes", {{"name", scene.name}, {"nodes", GltfJson::array({top})}});
  writer.root()["scene"] = 0;
  animation.finish();
  writer.root()["asset"]["extras"] = extras_of(reader, options, report);
  return {writer.bytes(), std::move(report)};
}

}  // namespace weft::scenes
