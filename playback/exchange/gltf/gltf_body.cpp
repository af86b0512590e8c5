#include <weft/playback/exchange/gltf/gltf_body.hpp>

#include <array>
#include <utility>

#include <weft/playback/rendering/meshes/collider_mesh.hpp>

namespace weft::scenes {
namespace {

using Use = GlbWriter::Use;

/// Positions, normals and texture coordinates, a column for each vertex.
struct VertexColumns {
  explicit VertexColumns(const SurfaceMesh& surface);
  Eigen::Matrix3Xf positions;
  Eigen::Matrix3Xf normals;
  Eigen::Matrix2Xf coordinates;
};

VertexColumns::VertexColumns(const SurfaceMesh& surface) {
  const auto count = static_cast<Eigen::Index>(surface.vertices.size());
  positions.resize(3, count);
  normals.resize(3, count);
  coordinates.resize(2, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SurfaceVertex& vertex = surface.vertices[static_cast<std::size_t>(i)];
    const float length = vertex.normal.norm();
    positions.col(i) = vertex.position;
    normals.col(i) =
        length > 0.0f ? Eigen::Vector3f(vertex.normal / length) : Eigen::Vector3f::UnitY();
    coordinates.col(i) = vertex.value;
  }
}

Eigen::Matrix2Xf front_coordinates(const Eigen::Matrix3Xf& positions) {
  Eigen::Matrix2Xf places(2, positions.cols());
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    places.col(i) =
        place_in_picture(TextureMapping::kFromFront, positions.col(i).cast<double>()).cast<float>();
  }
  return places;
}

/// Indices of the triangles in octants of the sign: 1 or -1.
std::vector<int> octants(const SurfaceMesh& surface, float sign) {
  std::vector<int> indices;
  for (std::size_t t = 0; t + 2 < surface.indices.size(); t += 3) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (std::size_t c = 0; c < 3; ++c) sum += surface.vertices[surface.indices[t + c]].position;
    if (sign * sum.prod() < 0.0f) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      indices.push_back(static_cast<int>(surface.indices[t + c]));
    }
  }
  return indices;
}

GltfJson primitive_of(GlbWriter& writer, const GltfJson& attributes,
                      const std::vector<int>& indices, int material) {
  const Eigen::Map<const Eigen::VectorXi> column(indices.data(), std::ssize(indices));
  return {
      {"attributes", attributes}, {"indices", writer.add_indices(column)}, {"material", material}};
}

std::string key_of(const SurfaceMesh& surface, const Appearance& appearance,
                   const std::vector<int>& materials) {
  const auto& vertices = surface.vertices;
  const auto& indices = surface.indices;
  std::string key(reinterpret_cast<const char*>(vertices.data()),
                  vertices.size() * sizeof vertices.front());
  key.append(reinterpret_cast<const char*>(indices.data()),
             indices.size() * sizeof indices.front());
  for (const int material : materials) key += " " + std::to_string(material);
  for (const double repeat : appearance.texture_repeat) key += " " + std::to_string(repeat);
  return key + (appearance.smooth ? " smooth" : " flat");
}

}  // namespace

PoseTrack::PoseTrack(int num_frames) : translations(3, num_frames), rotations(4, num_frames) {}

void PoseTrack::set(int frame, const Vector3<double>& position,
                    const Eigen::Quaterniond& orientation) {
  translations.col(frame) = position.cast<float>();
  rotations.col(frame) = orientation.normalized().coeffs().cast<float>();
  if (frame > 0 && rotations.col(frame).dot(rotations.col(frame - 1)) < 0.0f) {
    rotations.col(frame) *= -1.0f;
  }
}

int add_posed_node(GlbWriter& writer, GltfAnimation& animation, const PoseTrack& track,
                   GltfJson object) {
  const Eigen::Vector3f place = track.translations.col(0);
  const Eigen::Vector4f turn = track.rotations.col(0);
  object["translation"] = {place[0], place[1], place[2]};
  object["rotation"] = {turn[0], turn[1], turn[2], turn[3]};
  const int node = writer.add("nodes", std::move(object));
  const auto moves = [](const auto& keys) {
    return (keys.colwise() - keys.col(0)).cwiseAbs().maxCoeff() > 0.0f;
  };
  if (moves(track.translations)) animation.add(node, "translation", track.translations);
  if (moves(track.rotations)) animation.add(node, "rotation", track.rotations);
  return node;
}

int GltfBodies::add_mesh(const Scene& scene, const Collider& collider) {
  const SurfaceMesh surface = collider_surface(collider.shape);
  const Appearance& appearance = collider.appearance;
  const BodyLook look = collider_look(scene, collider);
  std::vector<int> materials = {materials_.add(look, appearance)};
  if (look.is_two_tone) materials.push_back(materials_.add_color(look.back));
  const auto [entry, is_new] = meshes_.try_emplace(key_of(surface, appearance, materials), 0);
  if (!is_new) return entry->second;

  const VertexColumns columns(surface);
  GltfJson attributes = {{"POSITION", writer_.add_numbers(columns.positions, Use::kVertices)}};
  // Without normals every triangle is flat.
  if (appearance.smooth) {
    attributes["NORMAL"] = writer_.add_numbers(columns.normals, Use::kVertices);
  }
  if (look.picture) {
    const bool is_from_front = look.mapping == TextureMapping::kFromFront;
    const Eigen::Matrix2Xf coordinates = gltf_coordinates(
        is_from_front ? front_coordinates(columns.positions) : columns.coordinates, appearance);
    attributes["TEXCOORD_0"] = writer_.add_numbers(coordinates, Use::kVertices);
  }
  GltfJson primitives = GltfJson::array();
  if (look.is_two_tone) {
    primitives.push_back(primitive_of(writer_, attributes, octants(surface, -1.0f), materials[0]));
    primitives.push_back(primitive_of(writer_, attributes, octants(surface, 1.0f), materials[1]));
  } else {
    const std::vector<int> indices(surface.indices.begin(), surface.indices.end());
    primitives.push_back(primitive_of(writer_, attributes, indices, materials[0]));
  }
  entry->second =
      writer_.add("meshes", {{"name", collider.name}, {"primitives", std::move(primitives)}});
  return entry->second;
}

}  // namespace weft::scenes
