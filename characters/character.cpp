#include <weft/characters/character.hpp>

#include <algorithm>

#include <weft/characters/name_list.hpp>
#include <weft/characters/welding.hpp>
#include <weft/core/error.hpp>

namespace weft::characters {
namespace {

std::vector<int> parts_named(const Character& character, const std::string& name,
                             std::string Part::*key) {
  std::vector<int> found;
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    if (character.parts[p].*key == name) found.push_back(static_cast<int>(p));
  }
  return found;
}

/// Index of a joint of the part that is this bone with this bind matrix; added if it is new.
int joint_index(Part& part, int bone, const Eigen::Affine3d& inverse_bind) {
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    if (part.joints[j] == bone && part.inverse_bind[j].matrix() == inverse_bind.matrix()) {
      return static_cast<int>(j);
    }
  }
  part.joints.push_back(bone);
  part.inverse_bind.push_back(inverse_bind);
  return static_cast<int>(part.joints.size()) - 1;
}

void append_influences(const Part& other, Part& part) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < other.joints.size(); ++j) {
    joints.push_back(joint_index(part, other.joints[j], other.inverse_bind[j]));
  }
  const int offset = static_cast<int>(part.influence_joint.size());
  for (std::size_t i = 1; i < other.first_influence.size(); ++i) {
    part.first_influence.push_back(offset + other.first_influence[i]);
  }
  for (std::size_t k = 0; k < other.influence_joint.size(); ++k) {
    part.influence_joint.push_back(joints[static_cast<std::size_t>(other.influence_joint[k])]);
    part.influence_weight.push_back(other.influence_weight[k]);
  }
}

/// Corners without a place in a picture lie at its corner (0, 0) if others have one.
void append_corners(const Part& other, Part& part) {
  if (part.corner_texture_coordinates.cols() + other.corner_texture_coordinates.cols() == 0) return;
  const Eigen::Index old_corners = part.triangles.size();
  const Eigen::Index had = part.corner_texture_coordinates.cols();
  Eigen::Matrix2Xd& corners = part.corner_texture_coordinates;
  corners.conservativeResize(2, old_corners + other.triangles.size());
  corners.rightCols(corners.cols() - had).setZero();
  if (other.corner_texture_coordinates.cols() > 0) {
    corners.rightCols(other.triangles.size()) = other.corner_texture_coordinates;
  }
}

void append(const Part& other, Part& part) {
  append_influences(other, part);
  const Eigen::Index old_vertices = part.positions.cols();
  const Eigen::Index new_vertices = old_vertices + other.positions.cols();
  part.positions.conservativeResize(3, new_vertices);
  part.positions.rightCols(other.positions.cols()) = other.positions;
  // White where a part has no colours and another one has.
  if (part.colors.cols() > 0 || other.colors.cols() > 0) {
    const Eigen::Index had = part.colors.cols();
    part.colors.conservativeResize(4, new_vertices);
    part.colors.rightCols(new_vertices - had).setOnes();
    if (other.colors.cols() > 0) part.colors.rightCols(other.positions.cols()) = other.colors;
  }
  append_corners(other, part);
  const Eigen::Index old_triangles = part.triangles.cols();
  part.triangles.conservativeResize(3, old_triangles + other.triangles.cols());
  part.triangles.rightCols(other.triangles.cols()) =
      other.triangles.array() + static_cast<int>(old_vertices);
}

}  // namespace

Matrix3X<double> skinned_positions(const Part& part, const std::vector<Eigen::Affine3d>& frames) {
  std::vector<Eigen::Affine3d> skin(part.joints.size());
  for (std::size_t j = 0; j < skin.size(); ++j) {
    skin[j] = frames[static_cast<std::size_t>(part.joints[j])] * part.inverse_bind[j];
  }
  Matrix3X<double> result = Matrix3X<double>::Zero(3, part.positions.cols());
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    const auto vertex = static_cast<std::size_t>(i);
    const Vector3<double> position = part.positions.col(i);
    for (int k = part.first_influence[vertex]; k < part.first_influence[vertex + 1]; ++k) {
      const auto influence = static_cast<std::size_t>(k);
      const auto joint = static_cast<std::size_t>(part.influence_joint[influence]);
      result.col(i) += part.influence_weight[influence] * (skin[joint] * position);
    }
  }
  return result;
}

std::vector<int> find_parts(const Character& character, const std::string& name) {
  std::vector<std::string> names;
  for (const auto key : {&Part::node, &Part::mesh, &Part::material}) {
    std::vector<int> found = parts_named(character, name, key);
    if (!found.empty()) return found;
    for (const Part& part : character.parts) {
      if (std::find(names.begin(), names.end(), part.*key) == names.end()) {
        names.push_back(part.*key);
      }
    }
  }
  refuse_name("part", name, names);
}

Part merged_part(const Character& character, const std::vector<int>& parts, Weld weld) {
  if (parts.empty()) throw InvalidArgument("character: no part to merge, expected at least one");
  Part merged = character.parts.at(static_cast<std::size_t>(parts[0]));
  for (std::size_t p = 1; p < parts.size(); ++p) {
    append(character.parts.at(static_cast<std::size_t>(parts[p])), merged);
  }
  ImportReport ignored;  // seams between materials: nothing that is wrong with the file
  return welded(merged, weld, ignored);
}

const Clip& find_clip(const Character& character, const std::string& name) {
  std::vector<std::string> names;
  for (const Clip& clip : character.clips) {
    if (clip.name == name) return clip;
    names.push_back(clip.name);
  }
  refuse_name("clip", name, names);
}

VectorX<double> joint_weights(const Character& character, const Part& part,
                              const std::string& bone) {
  VectorX<double> weights = VectorX<double>::Zero(part.positions.cols());
  std::vector<std::string> names;
  bool is_there = false;
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    names.push_back(character.skeleton.bones[static_cast<std::size_t>(part.joints[j])].name);
    if (names.back() != bone) continue;
    is_there = true;
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const auto vertex = static_cast<std::size_t>(i);
      for (int k = part.first_influence[vertex]; k < part.first_influence[vertex + 1]; ++k) {
        const auto influence = static_cast<std::size_t>(k);
        if (part.influence_joint[influence] == static_cast<int>(j)) {
          weights[i] += part.influence_weight[influence];
        }
      }
    }
  }
  if (!is_there) refuse_name("vertex group", bone, names);
  return weights;
}

}  // namespace weft::characters
