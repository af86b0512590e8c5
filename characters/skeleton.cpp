#include <weft/characters/skeleton.hpp>

#include <algorithm>
#include <cmath>

#include <weft/characters/name_list.hpp>

namespace weft::characters {
namespace {

/// Angle between two rotations, as a cosine, above which the great circle through them is not known
/// well enough: the sine of the angle loses half of its digits there. A straight line is exact to the
/// last bits so close.
constexpr double kNearlySame = 1.0 - 1e-9;

Eigen::Vector4d on_great_circle(const Eigen::Vector4d& a, Eigen::Vector4d b, double part) {
  double cosine = a.dot(b);
  if (cosine < 0) {  // q and -q are the same rotation: the shorter way
    b = -b;
    cosine = -cosine;
  }
  if (cosine > kNearlySame) return (a + part * (b - a)).normalized();
  const double angle = std::acos(std::min(cosine, 1.0));
  return (std::sin((1 - part) * angle) * a + std::sin(part * angle) * b) / std::sin(angle);
}

/// Column of values with the value, not a tangent, of key k.
Eigen::Index value_column(const Channel& channel, std::size_t key) {
  const auto k = static_cast<Eigen::Index>(key);
  return channel.interpolation == Interpolation::kCubic ? 3 * k + 1 : k;
}

Eigen::VectorXd key_value(const Channel& channel, std::size_t key) {
  Eigen::VectorXd value = channel.values.col(value_column(channel, key));
  if (channel.property == Property::kRotation) value.normalize();
  return value;
}

Eigen::VectorXd on_spline(const Channel& channel, std::size_t key, double interval, double s) {
  const Eigen::Index from = value_column(channel, key);
  const Eigen::Index to = value_column(channel, key + 1);
  const double s2 = s * s;
  const double s3 = s2 * s;
  Eigen::VectorXd value = (2 * s3 - 3 * s2 + 1) * channel.values.col(from) +
                          interval * (s3 - 2 * s2 + s) * channel.values.col(from + 1) +
                          (3 * s2 - 2 * s3) * channel.values.col(to) +
                          interval * (s3 - s2) * channel.values.col(to - 1);
  if (channel.property == Property::kRotation) value.normalize();
  return value;
}

void apply(const Channel& channel, double time, Transform& transform) {
  const Eigen::VectorXd value = value_at(channel, time);
  switch (channel.property) {
    case Property::kTranslation:
      transform.translation = value;
      break;
    case Property::kRotation:
      transform.rotation = Eigen::Quaterniond(value[3], value[0], value[1], value[2]);
      break;
    case Property::kScale:
      transform.scale = value;
      break;
  }
}

}  // namespace

Eigen::Affine3d Transform::matrix() const {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = rotation.toRotationMatrix() * scale.asDiagonal();
  result.translation() = translation;
  return result;
}

Eigen::VectorXd value_at(const Channel& channel, double time) {
  const std::vector<double>& times = channel.times;
  if (time <= times.front()) return key_value(channel, 0);
  if (time >= times.back()) return key_value(channel, times.size() - 1);
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
  if (channel.interpolation == Interpolation::kStep) return key_value(channel, key);
  const double interval = times[key + 1] - times[key];
  const double part = (time - times[key]) / interval;
  if (channel.interpolation == Interpolation::kCubic) {
    return on_spline(channel, key, interval, part);
  }
  const Eigen::VectorXd from = key_value(channel, key);
  const Eigen::VectorXd to = key_value(channel, key + 1);
  if (channel.property == Property::kRotation) return on_great_circle(from, to, part);
  return from + part * (to - from);
}

std::vector<Eigen::Affine3d> bone_frames(const Skeleton& skeleton, const Clip* clip, double time) {
  const std::size_t num_bones = skeleton.bones.size();
  std::vector<Transform> local(num_bones);
  std::vector<bool> is_animated(num_bones, false);
  for (std::size_t b = 0; b < num_bones; ++b) local[b] = skeleton.bones[b].rest;
  if (clip != nullptr) {
    for (const Channel& channel : clip->channels) {
      const auto bone = static_cast<std::size_t>(channel.bone);
      apply(channel, time, local[bone]);
      is_animated[bone] = true;
    }
  }
  std::vector<Eigen::Affine3d> frames(num_bones);
  for (std::size_t b = 0; b < num_bones; ++b) {
    const Bone& bone = skeleton.bones[b];
    const bool is_matrix = bone.rest_matrix && !is_animated[b];
    frames[b] = is_matrix ? *bone.rest_matrix : local[b].matrix();
    if (bone.parent >= 0) frames[b] = frames[static_cast<std::size_t>(bone.parent)] * frames[b];
  }
  return frames;
}

double clip_time(const Clip& clip, double time, bool is_looped) {
  if (!(clip.duration > 0)) return 0.0;
  if (!is_looped) return std::clamp(time, 0.0, clip.duration);
  const double rest = std::fmod(time, clip.duration);
  return rest < 0 ? rest + clip.duration : rest;
}

int find_bone(const Skeleton& skeleton, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    if (skeleton.bones[b].name == name) return static_cast<int>(b);
    names.push_back(skeleton.bones[b].name);
  }
  refuse_name("bone", name, names);
}

}  // namespace weft::characters
