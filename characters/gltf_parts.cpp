// Tested by tests/characters/gltf_faults_test.cpp, tests/characters/skinning_test.cpp.

#include <algorithm>
#include <cmath>

#include <weft/characters/gltf_content.hpp>
#include <weft/characters/welding.hpp>

namespace weft::characters {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kTriangleMode = 4;
constexpr std::size_t kNumbersOfJoint = 17;  ///< its bone and its matrix
constexpr Eigen::Index kMaxVertices = 1'000'000;

/// Sums of weights this close to 1 are 1 [-]: 8-bit weights are off by up to 4 x 0.5 / 255.
constexpr double kWeightTolerance = 0.01;

/// Smallest determinant of a bind matrix, relative to the product of its columns' lengths [-]: below
/// it the matrix flattens space.
constexpr double kFlatMatrix = 1e-9;

/// The skin of a part before its vertices have it.
struct Joints {
  std::vector<int> bones;
  std::vector<Eigen::Affine3d> inverse_bind;
};

Joints read_skin(const GltfDocument& document, std::size_t index, const ReadBones& bones,
                 ImportReport& report) {
  const Json& skin = document.entry("skins", index);
  const std::string where = "skins[" + std::to_string(index) + "]";
  const auto list = skin.find("joints");
  if (list == skin.end() || !list->is_array() || list->empty()) {
    document.fail(where + ".joints is missing or empty, expected the nodes of its joints");
  }
  document.claim(kNumbersOfJoint * list->size(), where);
  Joints joints;
  for (const Json& entry : *list) {
    const std::size_t size = bones.bone_of_node.size();
    if (!entry.is_number_unsigned() || entry.get<std::size_t>() >= size ||
        bones.bone_of_node[entry.get<std::size_t>()] < 0) {
      document.fail(where + ".joints names node " + entry.dump().substr(0, 40) +
                    ", expected nodes of the scene");
    }
    joints.bones.push_back(bones.bone_of_node[entry.get<std::size_t>()]);
  }
  const auto accessor = document.index(skin, "inverseBindMatrices", "accessors", where);
  if (!accessor) {
    joints.inverse_bind.assign(joints.bones.size(), Eigen::Affine3d::Identity());
    report.notes.push_back(where + " has no inverse bind matrices: taken as unit matrices");
    return joints;
  }
  const Eigen::MatrixXd matrices = document.accessor(*accessor, {"MAT4"});
  if (matrices.cols() < static_cast<Eigen::Index>(joints.bones.size())) {
    document.fail(where + ".inverseBindMatrices has " + std::to_string(matrices.cols()) +
                  " matrices for " + std::to_string(joints.bones.size()) + " joints");
  }
  for (std::size_t j = 0; j < joints.bones.size(); ++j) {
    const std::string place = where + ".inverseBindMatrices, joint " + std::to_string(j);
    const Eigen::Affine3d matrix =
        affine_of(document, matrices.col(static_cast<Eigen::Index>(j)), place);
    const double size = matrix.linear().colwise().norm().prod();
    if (!(std::abs(matrix.linear().determinant()) > kFlatMatrix * size)) {
      document.fail(place + " ('" +
                    bones.skeleton.bones[static_cast<std::size_t>(joints.bones[j])].name +
                    "') has no inverse, expected determinant != 0");
    }
    joints.inverse_bind.push_back(matrix);
  }
  return joints;
}

Triangles read_triangles(const GltfDocument& document, const Json& primitive,
                         Eigen::Index num_vertices, const std::string& where) {
  Eigen::MatrixXd corners;
  if (const auto accessor = document.index(primitive, "indices", "accessors", where)) {
    corners = document.accessor(*accessor, {"SCALAR"});
  } else {
    corners = Eigen::RowVectorXd::LinSpaced(num_vertices, 0, static_cast<double>(num_vertices - 1));
  }
  if (corners.size() % 3 != 0) {
    document.fail(where + " has " + std::to_string(corners.size()) +
                  " corners, expected a multiple of 3");
  }
  for (Eigen::Index c = 0; c < corners.size(); ++c) {
    const double corner = corners(0, c);
    if (corner < 0 || corner >= static_cast<double>(num_vertices) || corner != std::floor(corner)) {
      document.fail(where + ": corner " + std::to_string(c % 3) + " of triangle " +
                    std::to_string(c / 3) + " names vertex " + std::to_string(corner) +
                    ", expected 0 to " + std::to_string(num_vertices - 1));
    }
  }
  return corners.reshaped(3, corners.size() / 3).cast<int>();
}

/// One vertex's influences, which are the last ones, to sum 1.
void normalize_last(const GltfDocument& document, Part& part, std::size_t first, std::size_t vertex,
                    const std::string& where, ImportReport& report) {
  double sum = 0;
  for (std::size_t k = first; k < part.influence_weight.size(); ++k) {
    const double weight = part.influence_weight[k];
    if (weight < 0) {
      document.fail(where + ": vertex " + std::to_string(vertex) + " has the weight " +
                    std::to_string(weight) + ", expected >= 0");
    }
    sum += weight;
  }
  if (!(sum > 0)) {
    document.fail(where + ": the weights of vertex " + std::to_string(vertex) +
                  " sum to 0, expected 1");
  }
  if (std::abs(sum - 1) > kWeightTolerance) {
    ++report.num_normalized_weights;
    report.largest_weight_error = std::max(report.largest_weight_error, std::abs(sum - 1));
  }
  for (std::size_t k = first; k < part.influence_weight.size(); ++k)
    part.influence_weight[k] /= sum;
}

void read_influences(const GltfDocument& document, const Json& attributes, Part& part,
                     const std::string& where, ImportReport& report) {
  std::vector<Eigen::MatrixXd> joints;
  std::vector<Eigen::MatrixXd> weights;
  const Eigen::Index num_vertices = part.positions.cols();
  for (int set = 0;; ++set) {
    const std::string number = std::to_string(set);
    const auto joint = document.index(attributes, "JOINTS_" + number, "accessors", where);
    const auto weight = document.index(attributes, "WEIGHTS_" + number, "accessors", where);
    if (!joint && !weight) break;
    if (!joint || !weight)
      document.fail(where + " has JOINTS_" + number + " or WEIGHTS_" + number + " alone");
    joints.push_back(document.accessor(*joint, {"VEC4"}));
    weights.push_back(document.accessor(*weight, {"VEC4"}));
    if (joints.back().cols() != num_vertices || weights.back().cols() != num_vertices) {
      document.fail(where + " has another number of JOINTS_" + number + " or WEIGHTS_" + number +
                    " than of vertices");
    }
  }
  if (joints.empty()) document.fail(where + " has a skin, but no JOINTS_0 and WEIGHTS_0");
  const auto num_joints = static_cast<double>(part.joints.size());
  part.first_influence.push_back(0);
  for (Eigen::Index v = 0; v < num_vertices; ++v) {
    const std::size_t first = part.influence_joint.size();
    for (std::size_t set = 0; set < joints.size(); ++set) {
      for (Eigen::Index k = 0; k < 4; ++k) {
        const double joint = joints[set](k, v);
        const double weight = weights[set](k, v);
        if (weight == 0) continue;  // its joint may be any number
        if (!(joint >= 0 && joint < num_joints)) {
          document.fail(where + ": vertex " + std::to_string(v) + " names joint " +
                        std::to_string(joint) + ", expected 0 to " +
                        std::to_string(part.joints.size() - 1));
        }
        part.influence_joint.push_back(static_cast<int>(joint));
        part.influence_weight.push_back(weight);
      }
    }
    normalize_last(document, part, first, static_cast<std::size_t>(v), where, report);
    part.first_influence.push_back(static_cast<int>(part.influence_joint.size()));
  }
}

void read_looks(const GltfDocument& document, const Json& attributes, Part& part,
                const std::string& where) {
  const Eigen::Index num_vertices = part.positions.cols();
  if (const auto colors = document.index(attributes, "COLOR_0", "accessors", where)) {
    const Eigen::MatrixXd values = document.accessor(*colors, {"VEC4", "VEC3"});
    if (values.cols() != num_vertices)
      document.fail(where + " has another number of COLOR_0 than of vertices");
    part.colors = Eigen::Matrix4Xd::Ones(4, num_vertices);
    part.colors.topRows(values.rows()) = values;
  }
  if (const auto places = document.index(attributes, "TEXCOORD_0", "accessors", where)) {
    const Eigen::MatrixXd values = document.accessor(*places, {"VEC2"});
    if (values.cols() != num_vertices)
      document.fail(where + " has another number of TEXCOORD_0 than of vertices");
    part.corner_texture_coordinates = values(Eigen::all, part.triangles.reshaped());
    // glTF counts from the upper left corner of a picture, downwards.
    part.corner_texture_coordinates.row(1) = 1.0 - part.corner_texture_coordinates.row(1).array();
  }
}

/// Name of the primitive's material; primitives without one differ by nothing.
std::string material_name(const GltfDocument& document, const Json& primitive,
                          const std::string& where) {
  const auto material = document.index(primitive, "material", "materials", where);
  return material ? document.text(document.entry("materials", *material), "name", "") : "";
}

std::optional<Part> read_primitive(const GltfDocument& document, const Json& primitive,
                                   const std::string& where, const Joints* skin, int bone,
                                   ImportReport& report) {
  const auto mode = primitive.find("mode");
  if (mode != primitive.end() && *mode != kTriangleMode) {
    report.notes.push_back(where + " has no list of triangles: left out");
    return std::nullopt;
  }
  if (primitive.contains("targets")) {
    report.notes.push_back(where + " has morph targets: they stay at 0");
  }
  const auto attributes = primitive.find("attributes");
  if (attributes == primitive.end() || !attributes->is_object()) {
    document.fail(where + ".attributes is missing");
  }
  Part part;
  part.positions = document.accessor(
      document.required_index(*attributes, "POSITION", "accessors", where), {"VEC3"});
  const Eigen::Index num_vertices = part.positions.cols();
  if (num_vertices < 3 || num_vertices > kMaxVertices) {
    document.fail(where + " has " + std::to_string(num_vertices) + " vertices, expected 3 to " +
                  std::to_string(kMaxVertices));
  }
  part.triangles = read_triangles(document, primitive, num_vertices, where);
  read_looks(document, *attributes, part, where);
  if (skin != nullptr) {
    document.claim(kNumbersOfJoint * skin->bones.size(), where);
    part.joints = skin->bones;
    part.inverse_bind = skin->inverse_bind;
    read_influences(document, *attributes, part, where, report);
  } else {
    part.joints = {bone};
    part.inverse_bind = {Eigen::Affine3d::Identity()};
    for (Eigen::Index v = 0; v <= num_vertices; ++v)
      part.first_influence.push_back(static_cast<int>(v));
    part.influence_joint.assign(static_cast<std::size_t>(num_vertices), 0);
    part.influence_weight.assign(static_cast<std::size_t>(num_vertices), 1.0);
  }
  part.material = material_name(document, primitive, where);
  return welded(part, Weld::kSameSkin, report);
}

}  // namespace

std::vector<Part> read_parts(const GltfDocument& document, const ReadBones& bones,
                             ImportReport& report) {
  std::vector<Part> parts;
  for (std::size_t b = 0; b < bones.node_of_bone.size(); ++b) {
    const std::size_t node_index = bones.node_of_bone[b];
    const Json& node = document.entry("nodes", node_index);
    const std::string node_where = "nodes[" + std::to_string(node_index) + "]";
    const auto mesh_index = document.index(node, "mesh", "meshes", node_where);
    if (!mesh_index) continue;
    std::optional<Joints> skin;
    if (const auto index = document.index(node, "skin", "skins", node_where)) {
      skin = read_skin(document, *index, bones, report);
    }
    const Json& mesh = document.entry("meshes", *mesh_index);
    const std::string where = "meshes[" + std::to_string(*mesh_index) + "]";
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array() || primitives->empty()) {
      document.fail(where + ".primitives is missing or empty");
    }
    for (std::size_t p = 0; p < primitives->size(); ++p) {
      const std::string place = where + ".primitives[" + std::to_string(p) + "]";
      if (!(*primitives)[p].is_object()) document.fail(place + " is no object");
      auto part = read_primitive(document, (*primitives)[p], place, skin ? &*skin : nullptr,
                                 static_cast<int>(b), report);
      if (!part) continue;
      part->mesh = document.text(mesh, "name", "mesh_" + std::to_string(*mesh_index));
      part->node = bones.skeleton.bones[b].name;
      parts.push_back(std::move(*part));
    }
  }
  return parts;
}

}  // namespace weft::characters
