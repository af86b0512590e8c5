#include <weft/playback/exchange/exchange_body.hpp>

#include <algorithm>
#include <cctype>
#include <set>

#include <weft/scenes/shapes/shape_surface.hpp>

namespace weft::scenes {
namespace {

/// Names of bodies that a program recorded may hold anything, names of files should not.
std::string plain(const std::string& name) {
  std::string text = name;
  const auto is_other = [](unsigned char c) { return !std::isalnum(c) && c != '_' && c != '-'; };
  std::replace_if(text.begin(), text.end(), is_other, '_');
  return text.empty() ? "body" : text;
}

std::string claim(std::set<std::string>& names, const std::string& name) {
  std::string free = plain(name);
  for (int number = 2; !names.insert(free).second; ++number) {
    free = plain(name) + "-" + std::to_string(number);
  }
  return free;
}

}  // namespace

std::vector<ExchangeBody> exchange_bodies(const Scene& scene) {
  std::vector<ExchangeBody> bodies;
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    const Cloth& cloth = scene.cloths[i];
    bodies.push_back({cloth.name, claim(names, cloth.name), false, i, make_mesh(cloth)});
  }
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    const Collider& collider = scene.colliders[i];
    if (std::holds_alternative<PlaneShape>(collider.shape)) continue;
    const MeshShape surface = shape_surface(collider.shape);
    ClothMesh mesh;
    mesh.rest_positions = surface.points;
    mesh.triangles = surface.triangles;
    bodies.push_back({collider.name, claim(names, collider.name), true, i, mesh});
  }
  return bodies;
}

std::vector<ExchangeBody> drawn_bodies(const Scene& scene,
                                       const std::vector<ExchangeBody>& bodies) {
  std::set<std::string> names;
  for (const ExchangeBody& body : bodies) names.insert(body.file_name);
  std::vector<ExchangeBody> drawn;
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    const Cloth& cloth = scene.cloths[i];
    if (!cloth.drawn_mesh) continue;
    const Surface& surface = *cloth.drawn_mesh->surface;
    ExchangeBody& body = drawn.emplace_back();
    body.name = cloth.name + "-drawn";
    body.file_name = claim(names, body.name);
    body.index = i;
    body.mesh.rest_positions = surface.positions;
    body.mesh.triangles = surface.triangles;
    body.mesh.corner_texture_coordinates = surface.corner_texture_coordinates;
    const ClothMesh leader = make_mesh(cloth);
    body.embedding = std::make_shared<const ClothEmbedding>(
        leader.rest_positions, leader.triangles, DrawnMesh{surface.positions, surface.triangles},
        cloth.drawn_mesh->embedding);
  }
  return drawn;
}

namespace {

Matrix3X<double> led_positions(const ClothEmbedding& embedding, const ClothState& cloth) {
  ClothPose pose = embedding.make_pose();
  embedding.set_pose(cloth.positions, pose);
  Matrix3X<double> positions(3, embedding.num_vertices());
  for (int v = 0; v < embedding.num_vertices(); ++v) {
    positions.col(v) = embedding.vertex(pose, v).position;
  }
  return positions;
}

}  // namespace

Matrix3X<double> world_positions(const ExchangeBody& body, const SceneState& state) {
  if (body.embedding) return led_positions(*body.embedding, state.cloths[body.index]);
  if (!body.is_rigid) return state.cloths[body.index].positions;
  const RigidState& rigid = state.rigids[body.index];
  return (rigid.orientation.toRotationMatrix() * body.mesh.rest_positions).colwise() +
         rigid.position;
}

Matrix3X<double> world_velocities(const ExchangeBody& body, const SceneState& state) {
  if (!body.is_rigid) return state.cloths[body.index].velocities;
  const RigidState& rigid = state.rigids[body.index];
  Matrix3X<double> velocities = rigid.orientation.toRotationMatrix() * body.mesh.rest_positions;
  for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
    const Vector3<double> arm = velocities.col(i);
    velocities.col(i) = rigid.velocity + rigid.angular_velocity.cross(arm);
  }
  return velocities;
}

Edges line_segments(const ClothMesh& mesh) {
  const bool is_surface = mesh.triangles.cols() > 0;
  return is_surface || !mesh.has_edge_set("stretch") ? Edges(2, 0) : mesh.edges_of({"stretch"});
}

}  // namespace weft::scenes
