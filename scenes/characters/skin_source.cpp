#include <weft/scenes/characters/skin_source.hpp>

#include <weft/mesh/surface_body.hpp>

namespace weft::scenes {
namespace {

std::vector<Eigen::Affine3d> placed(std::vector<Eigen::Affine3d> frames,
                                    const CharacterPose& pose) {
  Eigen::Affine3d world = Eigen::Affine3d::Identity();
  world.linear() = pose.scale * pose.place.orientation.toRotationMatrix();
  world.translation() = pose.place.position;
  for (Eigen::Affine3d& frame : frames) frame = world * frame;
  return frames;
}

Surface rest_surface(const SkinSource& source) {
  Surface surface;
  surface.positions = rest_positions(source);
  surface.triangles = source.part->triangles;
  surface.corner_texture_coordinates = source.part->corner_texture_coordinates;
  return surface;
}

}  // namespace

std::vector<Eigen::Affine3d> world_frames(const CharacterModel& model, const CharacterPose& pose,
                                          double time) {
  const characters::Character& character = model.character;
  if (!pose.clip) return placed(bone_frames(character.skeleton, nullptr, 0.0), pose);
  const characters::Clip& clip = character.clips.at(*pose.clip);
  const double at = clip_time(clip, time, pose.loop);
  return placed(bone_frames(character.skeleton, &clip, at), pose);
}

Matrix3X<double> skin_positions(const SkinSource& source, double time) {
  return skinned_positions(*source.part, world_frames(*source.model, source.pose, time));
}

Matrix3X<double> rest_positions(const SkinSource& source) {
  CharacterPose rest = source.pose;
  rest.clip.reset();
  return skinned_positions(*source.part, world_frames(*source.model, rest, 0.0));
}

ClothMesh make_skin_mesh(const SkinSource& source) {
  if (source.is_cloth) {
    return make_surface_body(rest_surface(source), {source.total_mass, source.lumping});
  }
  Surface surface = rest_surface(source);
  ClothMesh mesh;
  const Eigen::Index num_nodes = surface.positions.cols();
  mesh.masses =
      VectorX<double>::Constant(num_nodes, source.total_mass / static_cast<double>(num_nodes));
  mesh.rest_positions = std::move(surface.positions);
  mesh.triangles = std::move(surface.triangles);
  mesh.corner_texture_coordinates = std::move(surface.corner_texture_coordinates);
  return mesh;
}

double skin_area(const SkinSource& source) {
  return surface_area(rest_surface(source));
}

Matrix3X<double> vertex_normals(const Matrix3X<double>& positions, const Triangles& triangles) {
  Matrix3X<double> normals = Matrix3X<double>::Zero(3, positions.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Vector3<double> a = positions.col(triangles(0, t));
    const Vector3<double> b = positions.col(triangles(1, t));
    const Vector3<double> c = positions.col(triangles(2, t));
    const Vector3<double> normal = (b - a).cross(c - a);
    for (int corner = 0; corner < 3; ++corner) normals.col(triangles(corner, t)) += normal;
  }
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    const double length = normals.col(i).norm();
    normals.col(i) =
        length > 0 ? Vector3<double>(normals.col(i) / length) : Vector3<double>(0, 1, 0);
  }
  return normals;
}

}  // namespace weft::scenes
