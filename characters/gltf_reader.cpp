#include <weft/characters/gltf_reader.hpp>

#include <weft/characters/gltf_content.hpp>
#include <weft/characters/gltf_document.hpp>
#include <weft/core/error.hpp>

namespace weft::characters {
namespace {

/// What a matrix of 32-bit numbers may be off its last row 0 0 0 1 [-].
constexpr double kLastRowTolerance = 1e-5;

Transform read_transform(const GltfDocument& document, const nlohmann::json& node,
                         const std::string& where) {
  Transform transform;
  if (const auto t = document.numbers(node, "translation", 3, where)) transform.translation = *t;
  if (const auto s = document.numbers(node, "scale", 3, where)) transform.scale = *s;
  if (const auto r = document.numbers(node, "rotation", 4, where)) {
    if (!(r->norm() > 0)) document.fail(where + ".rotation has no length, expected a quaternion");
    transform.rotation = Eigen::Quaterniond((*r)[3], (*r)[0], (*r)[1], (*r)[2]).normalized();
  }
  return transform;
}

Bone read_bone(const GltfDocument& document, std::size_t node_index, int parent) {
  const nlohmann::json& node = document.entry("nodes", node_index);
  const std::string where = "nodes[" + std::to_string(node_index) + "]";
  Bone bone;
  bone.name = document.text(node, "name", "node_" + std::to_string(node_index));
  bone.parent = parent;
  bone.rest = read_transform(document, node, where);
  if (const auto matrix = document.numbers(node, "matrix", 16, where)) {
    bone.rest_matrix = affine_of(document, *matrix, where + ".matrix");
  }
  return bone;
}

std::vector<std::size_t> indices(const GltfDocument& document, const nlohmann::json& object,
                                 const std::string& key, const std::string& where) {
  std::vector<std::size_t> result;
  const auto found = object.find(key);
  if (found == object.end()) return result;
  if (!found->is_array()) document.fail(where + "." + key + " is no array");
  for (const nlohmann::json& entry : *found) {
    const std::size_t size = document.count("nodes");
    if (!entry.is_number_unsigned() || entry.get<std::size_t>() >= size) {
      document.fail(where + "." + key + " names node " + entry.dump().substr(0, 40) +
                    ", expected one of the " + std::to_string(size) + " nodes, from 0");
    }
    result.push_back(entry.get<std::size_t>());
  }
  return result;
}

std::vector<std::size_t> root_nodes(const GltfDocument& document) {
  if (document.count("scenes") == 0) document.fail("has no scene, expected one with a character");
  const std::size_t scene = document.index(document.root(), "scene", "scenes", "file").value_or(0);
  return indices(document, document.entry("scenes", scene), "nodes",
                 "scenes[" + std::to_string(scene) + "]");
}

}  // namespace

Eigen::Affine3d affine_of(const GltfDocument& document, const Eigen::VectorXd& numbers,
                          const std::string& where) {
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(numbers.data());
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kLastRowTolerance) {
    document.fail(where + " has another last row than 0 0 0 1, expected an affine matrix");
  }
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = matrix.topLeftCorner<3, 3>();
  result.translation() = matrix.topRightCorner<3, 1>();
  return result;
}

// Without recursion: a file may be a chain of a million nodes.
ReadBones read_bones(const GltfDocument& document) {
  ReadBones bones;
  bones.bone_of_node.assign(document.count("nodes"), -1);
  struct Waiting {
    std::size_t node;
    int parent;
  };
  std::vector<Waiting> waiting;
  const auto push = [&](const std::vector<std::size_t>& nodes, int parent) {
    for (std::size_t i = nodes.size(); i-- > 0;) waiting.push_back({nodes[i], parent});
  };
  push(root_nodes(document), -1);
  while (!waiting.empty()) {
    const Waiting next = waiting.back();
    waiting.pop_back();
    if (bones.bone_of_node[next.node] >= 0) {
      document.fail("nodes[" + std::to_string(next.node) +
                    "] is reached twice, expected a tree without loops");
    }
    const int bone = static_cast<int>(bones.skeleton.bones.size());
    bones.bone_of_node[next.node] = bone;
    bones.node_of_bone.push_back(next.node);
    bones.skeleton.bones.push_back(read_bone(document, next.node, next.parent));
    push(indices(document, document.entry("nodes", next.node), "children",
                 "nodes[" + std::to_string(next.node) + "]"),
         bone);
  }
  return bones;
}

Character read_gltf(std::span<const std::byte> bytes, const std::string& name,
                    const FileSource& files) {
  const GltfDocument document(bytes, name, files);
  const ReadBones bones = read_bones(document);
  Character character;
  character.skeleton = bones.skeleton;
  character.clips = read_clips(document, bones.bone_of_node);
  character.parts = read_parts(document, bones, character.report);
  if (character.parts.empty()) document.fail("has no surface of triangles in its scene");
  return character;
}

Character read_gltf_file(const std::filesystem::path& path) {
  std::string bytes;
  try {
    bytes = read_input_file(path);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(path.string() + ": " + error.what() +
                          "; expected a glTF model (.glb or .gltf)");
  }
  return read_gltf(std::as_bytes(std::span(bytes)), path.filename().string(),
                   files_below(path.parent_path()));
}

}  // namespace weft::characters
