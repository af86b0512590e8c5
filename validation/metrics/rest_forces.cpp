#include <weft/validation/metrics/rest_forces.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/validation/metrics/distance/signed_distance.hpp>

namespace weft::validation {
namespace {

/// +1 or -1, as random as it needs to be, and the same on every machine.
double sign_of(std::uint32_t number) {
  number = (number ^ (number >> 16)) * 0x45d9f3bU;
  number = (number ^ (number >> 16)) * 0x45d9f3bU;
  return ((number >> 16) & 1U) != 0 ? 1.0 : -1.0;
}

/// Each coordinate off by half the distance of two neighboring numbers at most, as rounding leaves it.
Matrix3X<double> rounded(const Matrix3X<double>& positions, double epsilon) {
  Matrix3X<double> moved = positions;
  for (Eigen::Index i = 0; i < moved.size(); ++i) {
    moved.data()[i] *= 1 + 0.5 * epsilon * sign_of(static_cast<std::uint32_t>(i));
  }
  return moved;
}

double gravity_of(const scenes::Scene& scene) {
  for (const scenes::Cloth& cloth : scene.cloths) {
    for (const forces::LawSpecification& given : cloth.laws) {
      if (forces::role_of(given.law) != forces::LawRole::kGravity) continue;
      const std::vector<double> a = forces::checked(given).parameters.at("acceleration");
      const double size = std::hypot(a.at(0), a.at(1), a.at(2));
      if (size > 0) return size;
    }
  }
  throw InvalidArgument(fmt::format(
      "rest forces: scene '{}' has no gravity, expected a weight to compare with", scene.name));
}

}  // namespace

RestForces::RestForces(const scenes::Scene& scene, double epsilon)
    : scene_(scene), epsilon_(epsilon), gravity_(gravity_of(scene)) {
  if (!(epsilon > 0)) {
    throw InvalidArgument(fmt::format("rest forces: epsilon = {} [-], expected > 0", epsilon));
  }
  for (const scenes::Cloth& cloth : scene.cloths) {
    if (cloth.self_collision || cloth.soft_collision) {
      throw InvalidArgument(fmt::format(
          "rest forces: cloth '{}' meets cloth, expected forces of laws and colliders only",
          cloth.name));
    }
    ClothPart part{make_mesh(cloth), {}};
    for (const forces::LawSpecification& law : cloth.laws) {
      part.laws.push_back(forces::make_law<double>(law, part.mesh));
    }
    cloths_.push_back(std::move(part));
  }
}

Matrix3X<double> RestForces::forces(std::size_t cloth, const Matrix3X<double>& positions,
                                    double time) const {
  const ClothPart& part = cloths_.at(cloth);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, positions.cols());
  const forces::State<double> state{positions, still, part.mesh.masses, time};
  Matrix3X<double> sum = still;
  Matrix3X<double> scratch;
  for (const auto& law : part.laws) {
    scratch.setZero(3, law->scratch_columns());
    law->add_forces(state, scratch, sum);
  }
  return sum;
}

bool RestForces::is_free(std::size_t cloth, int node, const scenes::SceneState& state) const {
  const std::vector<int>& pinned = cloths_[cloth].mesh.pinned;
  if (std::binary_search(pinned.begin(), pinned.end(), node)) return false;
  const double reach = 2 * scene_.cloths[cloth].collision_margin;
  for (std::size_t i = 0; i < scene_.colliders.size(); ++i) {
    const Pose pose{state.rigids[i].position, state.rigids[i].orientation};
    const Vector3<double> place = state.cloths[cloth].positions.col(node);
    // A distance that is not a number leaves the node free, so that it is seen.
    if (signed_distance(scene_.colliders[i].shape, pose, place) <= reach) return false;
  }
  return true;
}

UnbalancedForces RestForces::evaluate(const scenes::SceneState& state) const {
  if (state.cloths.size() != cloths_.size() || state.rigids.size() != scene_.colliders.size()) {
    throw InvalidArgument(fmt::format(
        "rest forces: state = {} cloths and {} rigid bodies, expected {} and {}",
        state.cloths.size(), state.rigids.size(), cloths_.size(), scene_.colliders.size()));
  }
  UnbalancedForces result;
  for (std::size_t c = 0; c < cloths_.size(); ++c) {
    const Matrix3X<double>& places = state.cloths[c].positions;
    if (places.cols() != cloths_[c].mesh.num_nodes()) {
      throw InvalidArgument(fmt::format("rest forces: cloth {} = {} nodes, expected {}", c,
                                        places.cols(), cloths_[c].mesh.num_nodes()));
    }
    const Matrix3X<double> sum = forces(c, places, state.time);
    const Matrix3X<double> change = forces(c, rounded(places, epsilon_), state.time) - sum;
    for (int i = 0; i < static_cast<int>(places.cols()); ++i) {
      if (!is_free(c, i, state)) continue;
      const double weight = cloths_[c].mesh.masses[i] * gravity_;
      const double share = sum.col(i).norm() / weight;
      // Not std::max, which would drop a value that is not a number.
      if (!(share <= result.largest)) result.largest = share;
      result.mean += share;
      result.rounding_largest = std::max(result.rounding_largest, change.col(i).norm() / weight);
      result.rounding_mean += change.col(i).norm() / weight;
      ++result.num_nodes;
    }
  }
  if (!std::isfinite(result.mean)) result.largest = std::numeric_limits<double>::quiet_NaN();
  if (result.num_nodes == 0) return result;
  result.mean /= result.num_nodes;
  result.rounding_mean /= result.num_nodes;
  return result;
}

}  // namespace weft::validation
