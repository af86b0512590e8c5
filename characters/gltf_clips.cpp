// Tested by tests/characters/gltf_faults_test.cpp, tests/characters/skinning_test.cpp.

#include <algorithm>
#include <cmath>

#include <weft/characters/gltf_content.hpp>

namespace weft::characters {
namespace {

using Json = nlohmann::json;

Interpolation read_interpolation(const GltfDocument& document, const Json& sampler,
                                 const std::string& where) {
  const std::string word = document.text(sampler, "interpolation", "LINEAR");
  if (word == "STEP") return Interpolation::kStep;
  if (word == "LINEAR") return Interpolation::kLinear;
  if (word == "CUBICSPLINE") return Interpolation::kCubic;
  document.fail(where + ".interpolation = '" + word + "', expected STEP, LINEAR or CUBICSPLINE");
}

std::vector<double> read_times(const GltfDocument& document, std::size_t accessor,
                               const std::string& where) {
  const Eigen::MatrixXd values = document.accessor(accessor, {"SCALAR"});
  std::vector<double> times(values.data(), values.data() + values.size());
  if (times.empty()) document.fail(where + " has no time, expected at least one");
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (times[k] < 0 || (k > 0 && !(times[k] > times[k - 1]))) {
      document.fail(where + ": time " + std::to_string(k) + " = " + std::to_string(times[k]) +
                    " s, expected times >= 0 s that grow");
    }
  }
  return times;
}

void check_values(const GltfDocument& document, const Channel& channel, const std::string& where) {
  const auto num_times = static_cast<Eigen::Index>(channel.times.size());
  const bool is_cubic = channel.interpolation == Interpolation::kCubic;
  const Eigen::Index expected = is_cubic ? 3 * num_times : num_times;
  if (channel.values.cols() != expected) {
    document.fail(where + " has " + std::to_string(channel.values.cols()) + " values for " +
                  std::to_string(num_times) + " times, expected " + std::to_string(expected));
  }
  if (channel.property != Property::kRotation) return;
  for (Eigen::Index k = is_cubic ? 1 : 0; k < expected; k += is_cubic ? 3 : 1) {
    if (!(channel.values.col(k).norm() > 0)) {
      document.fail(where + ": rotation " + std::to_string(k) + " has no length");
    }
  }
}

/// None for what moves no bone of the scene.
std::optional<Channel> read_channel(const GltfDocument& document, const Json& animation,
                                    const Json& entry, const std::vector<int>& bone_of_node,
                                    const std::string& where) {
  const auto target = entry.find("target");
  if (target == entry.end() || !target->is_object()) document.fail(where + ".target is missing");
  const std::string path = document.text(*target, "path", "");
  Channel channel;
  if (path == "rotation") {
    channel.property = Property::kRotation;
  } else if (path == "scale") {
    channel.property = Property::kScale;
  } else if (path != "translation") {
    return std::nullopt;  // weights of morph targets, pointers of extensions
  }
  const auto node = document.index(*target, "node", "nodes", where + ".target");
  if (!node || bone_of_node[*node] < 0) return std::nullopt;
  channel.bone = bone_of_node[*node];

  const auto samplers = animation.find("samplers");
  const auto sampler = entry.find("sampler");
  if (samplers == animation.end() || !samplers->is_array() || sampler == entry.end() ||
      !sampler->is_number_unsigned() || sampler->get<std::size_t>() >= samplers->size() ||
      !(*samplers)[sampler->get<std::size_t>()].is_object()) {
    document.fail(where + ".sampler, expected the index of a sampler of its animation");
  }
  const Json& source = (*samplers)[sampler->get<std::size_t>()];
  channel.interpolation = read_interpolation(document, source, where);
  channel.times = read_times(document, document.required_index(source, "input", "accessors", where),
                             where + ".input");
  const std::string type = channel.property == Property::kRotation ? "VEC4" : "VEC3";
  channel.values =
      document.accessor(document.required_index(source, "output", "accessors", where), {type});
  check_values(document, channel, where);
  return channel;
}

}  // namespace

std::vector<Clip> read_clips(const GltfDocument& document, const std::vector<int>& bone_of_node) {
  std::vector<Clip> clips;
  for (std::size_t a = 0; a < document.count("animations"); ++a) {
    const Json& animation = document.entry("animations", a);
    const std::string where = "animations[" + std::to_string(a) + "]";
    Clip clip;
    clip.name = document.text(animation, "name", "clip_" + std::to_string(a));
    const auto channels = animation.find("channels");
    if (channels == animation.end() || !channels->is_array()) {
      document.fail(where + ".channels is missing");
    }
    for (std::size_t c = 0; c < channels->size(); ++c) {
      const std::string place = where + ".channels[" + std::to_string(c) + "]";
      if (!(*channels)[c].is_object()) document.fail(place + " is no object");
      auto channel = read_channel(document, animation, (*channels)[c], bone_of_node, place);
      if (!channel) continue;
      clip.duration = std::max(clip.duration, channel->times.back());
      clip.channels.push_back(std::move(*channel));
    }
    clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace weft::characters
