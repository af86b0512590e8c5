#include <weft/validation/metrics/distance/penetration.hpp>

#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/validation/metrics/distance/signed_distance.hpp>
#include <weft/validation/metrics/series/percentile.hpp>

namespace weft::validation {
namespace {

LayerPenetration inside(const VectorX<double>& distances, double layer) {
  LayerPenetration result;
  const VectorX<double> depths = (layer - distances.array()).cwiseMax(0.0);
  result.num_inside = static_cast<int>((distances.array() < layer).count());
  if (distances.allFinite()) {
    result.deepest = depths.maxCoeff();
    result.percentile_99 = percentile(depths, 99.0);
  } else {
    result.deepest = result.percentile_99 = std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

Penetration penetration(const scenes::Cloth& cloth, const scenes::ClothState& cloth_state,
                        const scenes::Collider& collider, const Pose& pose) {
  Penetration result;
  result.cloth = cloth.name;
  result.collider = collider.name;
  result.closest = std::numeric_limits<double>::infinity();
  const ShapeDistance shape(collider.shape);
  VectorX<double> distances(cloth_state.positions.cols());
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    distances[i] = signed_distance(shape, pose, cloth_state.positions.col(i));
    if (!std::isfinite(distances[i]) && !result.first_non_finite_node) {
      result.first_non_finite_node = static_cast<int>(i);
    }
    if (distances[i] < result.closest) {
      result.closest = distances[i];
      result.closest_node = static_cast<int>(i);
    }
  }
  result.surface = inside(distances, 0.0);
  result.margin = inside(distances, cloth.collision_margin);
  if (result.first_non_finite_node) {
    result.closest = std::numeric_limits<double>::quiet_NaN();
    result.closest_node = *result.first_non_finite_node;
  }
  return result;
}

}  // namespace

std::vector<Penetration> penetrations(const scenes::Scene& scene, const scenes::SceneState& state) {
  if (state.cloths.size() != scene.cloths.size() || state.rigids.size() != scene.colliders.size()) {
    throw InvalidArgument(fmt::format(
        "penetration: state = {} cloths and {} rigid bodies, expected {} and {} as in scene '{}'",
        state.cloths.size(), state.rigids.size(), scene.cloths.size(), scene.colliders.size(),
        scene.name));
  }
  std::vector<Penetration> rows;
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    const Eigen::Index num_nodes = scenes::num_nodes(scene.cloths[i].source);
    if (state.cloths[i].positions.cols() != num_nodes) {
      throw InvalidArgument(fmt::format("penetration: cloth '{}' = {} positions, expected {}",
                                        scene.cloths[i].name, state.cloths[i].positions.cols(),
                                        num_nodes));
    }
    for (std::size_t j = 0; j < scene.colliders.size(); ++j) {
      const Pose pose{state.rigids[j].position, state.rigids[j].orientation};
      rows.push_back(penetration(scene.cloths[i], state.cloths[i], scene.colliders[j], pose));
    }
  }
  return rows;
}

}  // namespace weft::validation
