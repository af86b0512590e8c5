#include <weft/scenes/characters/character_settings.hpp>

#include <algorithm>
#include <limits>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

struct PaintOf {
  const SkinSource& source;

  VectorX<double> operator()(const PaintedColor& color) const {
    const characters::Part& part = *source.part;
    if (part.colors.cols() == 0) {
      throw InvalidArgument("the part '" + part.node + "' has no vertex colours (COLOR_0)");
    }
    return part.colors.row(color.channel);
  }
  VectorX<double> operator()(const PaintedGroup& group) const {
    return joint_weights(source.model->character, *source.part, group.bone);
  }
};

}  // namespace

VectorX<double> max_distances(const ReachSettings& reach, const SkinSource& source) {
  const Eigen::Index num_nodes = source.part->positions.cols();
  const double largest = reach.max_distance.value_or(std::numeric_limits<double>::infinity());
  VectorX<double> distances = VectorX<double>::Constant(num_nodes, largest);
  if (!reach.paint) return distances;
  const VectorX<double> paint = std::visit(PaintOf{source}, *reach.paint);
  for (Eigen::Index i = 0; i < num_nodes; ++i) {
    const double share = std::clamp(paint[i], 0.0, 1.0);
    distances[i] = share > 0 ? share * largest : 0.0;
  }
  return distances;
}

}  // namespace weft::scenes
