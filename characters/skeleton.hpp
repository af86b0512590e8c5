#pragma once

// Tested by tests/characters/skinning_test.cpp.

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/types.hpp>

namespace weft::characters {

/// Translation, rotation and scale of a bone with respect to its parent: p -> T + R (S p).
struct Transform {
  Vector3<double> translation{0, 0, 0};  ///< [m] in the model's unit
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3<double> scale{1, 1, 1};  ///< [-]

  [[nodiscard]] Eigen::Affine3d matrix() const;
};

/// A node of the hierarchy that an animation moves; joints of skins are bones, and so are nodes that
/// carry a mesh or only group others.
struct Bone {
  std::string name;
  int parent = -1;  ///< index of a bone before this one; -1: none
  Transform rest;
  /// Instead of rest, where the file gives a matrix, which may shear and cannot be animated.
  std::optional<Eigen::Affine3d> rest_matrix = std::nullopt;
};

/// Parents come before their children.
struct Skeleton {
  std::vector<Bone> bones;
};

enum class Interpolation { kStep, kLinear, kCubic };
enum class Property { kTranslation, kRotation, kScale };

/// One property of one bone over time.
struct Channel {
  int bone = 0;
  Property property = Property::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> times;  ///< [s], increasing, at least one
  /// 3 x k, for rotations 4 x k (x, y, z, w). kCubic: 3 columns per time, in-tangent, value,
  /// out-tangent, the tangents per second.
  Eigen::MatrixXd values;
};

struct Clip {
  std::string name;
  double duration = 0.0;  ///< [s], the last time of any channel
  std::vector<Channel> channels;
};

/// Value of a channel at a time [s]: 3 values, or the 4 of a unit quaternion (x, y, z, w). Before the
/// first and after the last time it is that of the end. Rotations go the shorter way round, at
/// constant speed (kLinear), or along the cubic Hermite spline of their four numbers, normalised
/// (kCubic), as glTF 2.0 says in its appendix C.
[[nodiscard]] Eigen::VectorXd value_at(const Channel& channel, double time);

/// Place of every bone in the model's frame at a time [s] of the clip; without a clip the rest pose.
/// A pure function: the same bits for the same arguments.
[[nodiscard]] std::vector<Eigen::Affine3d> bone_frames(const Skeleton& skeleton, const Clip* clip,
                                                       double time);

/// Time within a clip [s] that is shown at a time [s] of a run: looped, or held at the end.
[[nodiscard]] double clip_time(const Clip& clip, double time, bool is_looped);

/// Index of the bone of this name. Throws InvalidArgument that lists the names there are.
[[nodiscard]] int find_bone(const Skeleton& skeleton, const std::string& name);

}  // namespace weft::characters
