#include <weft/playback/exchange/gltf/gltf_animation.hpp>

#include <cstring>
#include <utility>

namespace weft::scenes {

GltfAnimation::GltfAnimation(GlbWriter& writer, Eigen::RowVectorXf times)
    : writer_(writer), times_(std::move(times)) {}

void GltfAnimation::add(int node, const char* path, const Eigen::MatrixXf& keys) {
  if (!times_accessor_) {
    times_accessor_ = writer_.add_numbers(times_, GlbWriter::Use::kAnimation);
  }
  // Weights are scalars, those of one frame after the other.
  const bool is_weights = std::strcmp(path, "weights") == 0;
  const int output =
      is_weights
          ? writer_.add_numbers(Eigen::Map<const Eigen::RowVectorXf>(keys.data(), keys.size()),
                                GlbWriter::Use::kAnimation)
          : writer_.add_numbers(keys, GlbWriter::Use::kAnimation);
  samplers_.push_back(
      {{"input", *times_accessor_}, {"interpolation", "LINEAR"}, {"output", output}});
  channels_.push_back(
      {{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

void GltfAnimation::finish() {
  if (channels_.empty()) return;
  writer_.add("animations", {{"name", "recording"},
                             {"channels", std::move(channels_)},
                             {"samplers", std::move(samplers_)}});
}

}  // namespace weft::scenes
