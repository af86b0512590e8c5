#include <weft/scenes/controllers/detail.hpp>

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/SVD>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

void check(const Detail& detail, const Cloth& cloth) {
  if (cloth.tear) {
    throw InvalidArgument("detail: cloth '" + cloth.name + "' tears, expected one that does not");
  }
  if (!(detail.blend >= 0 && detail.follow > 0)) {
    throw InvalidArgument("detail: blend, expected >= 0 s; follow, expected > 0 Hz");
  }
  for (std::size_t i = 1; i < detail.levels.size(); ++i) {
    if (detail.levels[i].time > detail.levels[i - 1].time) continue;
    throw InvalidArgument("detail: times of levels, expected growing ones");
  }
}

/// The rotation that brings points nearest to the places of others, both about their centres. Where
/// they leave it open (fewer than three, or on a line) it stays near guess.
Matrix3<double> best_turn(const Matrix3X<double>& points, const Matrix3X<double>& places,
                          const Matrix3<double>& guess) {
  const Matrix3X<double> from = points.colwise() - points.rowwise().mean();
  const Matrix3X<double> to = places.colwise() - places.rowwise().mean();
  const double size = from.squaredNorm();
  if (!(size > 0)) return guess;
  const Matrix3<double> spread = to * from.transpose() / size + 1e-6 * guess;
  const Eigen::JacobiSVD<Matrix3<double>> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3<double> mirror = Matrix3<double>::Identity();
  mirror(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixU() * mirror * svd.matrixV().transpose();
}

void limit(const PositionLimits& limits, double time_step, Placement& placement) {
  if (limits.is_empty()) return;
  for (Eigen::Index i = 0; i < placement.positions.cols(); ++i) {
    const Vector3<double> position = placement.positions.col(i);
    const Vector3<double> allowed = limited_position(limits, static_cast<int>(i), position);
    placement.positions.col(i) = allowed;
    placement.velocities.col(i) += (allowed - position) / time_step;
  }
}

}  // namespace

DetailController::DetailController(const Detail& detail, std::size_t cloth,
                                   const Cloth& description)
    : detail_(detail), cloth_(cloth) {
  check(detail, description);
  const ClothMesh mesh = make_mesh(description);
  pinned_ = mesh.pinned;
  blended_ = detail_.blend;  // nothing to blend yet
  pinned_velocities_.resize(3, std::ssize(pinned_));
  for (std::size_t i = 0; i < pinned_.size(); ++i) {
    pinned_velocities_.col(static_cast<Eigen::Index>(i)) = mesh.pinned_velocity(i);
  }
}

void DetailController::follow_list(double end_time) {
  // Half a nanosecond of tolerance: times of steps are sums, those of the list are not.
  while (next_switch_ < detail_.levels.size() &&
         detail_.levels[next_switch_].time <= end_time + 0.5e-9) {
    level_ = detail_.levels[next_switch_++].level;
  }
}

void DetailController::leave_full(const ClothState& cloth) {
  shape_ = cloth.positions;
  shape_pins_ = cloth.positions(Eigen::all, pinned_);
  turn_ = Matrix3<double>::Identity();
}

Matrix3X<double> DetailController::pins_at_end(const ClothState& cloth, double time_step,
                                               const ClothCommands& lead) const {
  if (lead.pinned_positions.cols() > 0) return lead.pinned_positions;
  return cloth.positions(Eigen::all, pinned_) + time_step * pinned_velocities_;
}

/// Brings the shape to where the pins have it.
void DetailController::carry(const Matrix3X<double>& pins) {
  if (pins.cols() == 0) return;  // nothing carries it: it stays
  turn_ = best_turn(shape_pins_, pins, turn_);
}

DetailController::Goal DetailController::goal_of(const ClothState& cloth, double time_step,
                                                 const ClothCommands& lead) {
  Goal goal;
  if (lead.animated_positions.cols() > 0) {
    goal.end = lead.animated_positions;
    goal.start = last_animated_.cols() > 0 ? last_animated_ : cloth.positions;
  } else {
    const auto placed = [&](const Matrix3X<double>& pins) -> Matrix3X<double> {
      if (pins.cols() == 0) return shape_;
      const Vector3<double> center = shape_pins_.rowwise().mean();
      const Vector3<double> place = pins.rowwise().mean();
      return (turn_ * (shape_.colwise() - center)).colwise() + place;
    };
    goal.start = placed(cloth.positions(Eigen::all, pinned_));
    const Matrix3X<double> pins = pins_at_end(cloth, time_step, lead);
    carry(pins);
    goal.end = placed(pins);
  }
  goal.velocity = (goal.end - goal.start) / time_step;
  return goal;
}

Placement DetailController::simplified(const ClothState& cloth, const Goal& goal,
                                       double time_step) const {
  const double w = 2.0 * std::numbers::pi * detail_.follow;
  const double decay = std::exp(-w * time_step);
  const Matrix3X<double> offset = cloth.positions - goal.start;
  const Matrix3X<double> slope = cloth.velocities - goal.velocity + w * offset;
  Placement placement;
  placement.positions = goal.end + decay * (offset + time_step * slope);
  placement.velocities = goal.velocity + decay * (slope - w * (offset + time_step * slope));
  return placement;
}

void DetailController::begin_blending(const ClothState& cloth, const Goal& goal) {
  blended_ = 0.0;
  offset_ = cloth.positions - goal.start;
  offset_change_ = cloth.velocities - goal.velocity;
}

/// On Hermite's cubic from the offset and its change at the switch to 0 and 0.
Placement DetailController::blended(const Goal& goal) const {
  if (blended_ >= detail_.blend) return {goal.end, goal.velocity};
  const double s = blended_ / detail_.blend;
  const double rest = 1.0 - s;
  const double a = rest * rest * (1.0 + 2.0 * s);
  const double b = rest * rest * s * detail_.blend;
  const double da = -6.0 * s * rest / detail_.blend;
  const double db = rest * (1.0 - 3.0 * s);
  return {goal.end + a * offset_ + b * offset_change_,
          goal.velocity + da * offset_ + db * offset_change_};
}

void DetailController::place(const ClothState& cloth, double time_step, ClothCommands& lead) {
  if (last_level_ == DetailLevel::kFull) leave_full(cloth);
  const Matrix3X<double> pins = pins_at_end(cloth, time_step, lead);
  const Goal goal = goal_of(cloth, time_step, lead);
  if (level_ == DetailLevel::kSimplified) {
    lead.placement = simplified(cloth, goal, time_step);
    limit(lead.limits, time_step, *lead.placement);
  } else {
    if (last_level_ != DetailLevel::kSkin) begin_blending(cloth, goal);
    blended_ += time_step;
    lead.placement = blended(goal);
  }
  for (std::size_t i = 0; i < pinned_.size(); ++i) {
    const Vector3<double> pin = pins.col(static_cast<Eigen::Index>(i));
    lead.placement->velocities.col(pinned_[i]) =
        (pin - cloth.positions.col(pinned_[i])) / time_step;
    lead.placement->positions.col(pinned_[i]) = pin;
  }
}

// A limit around the place to which a node's own velocity brings it bounds its acceleration.
void DetailController::release(const ClothState& cloth, double time_step, ClothCommands& lead) {
  if (last_level_ != DetailLevel::kFull) blended_ = 0.0;
  blended_ += time_step;
  if (blended_ >= detail_.blend) return;
  const double s = blended_ / detail_.blend;
  const double radius = kReleaseAcceleration * s / (1.0 - s) * time_step * time_step;
  lead.limits = {};
  lead.limits.centers = cloth.positions + time_step * cloth.velocities;
  lead.limits.max_distances = VectorX<double>::Constant(cloth.positions.cols(), radius);
}

void DetailController::steer(const SceneState& state, double end_time, StepCommands& commands) {
  const ClothState& cloth = state.cloths[cloth_];
  ClothCommands& lead = commands.cloths[cloth_];
  const double time_step = end_time - state.time;
  follow_list(end_time);
  if (level_ != DetailLevel::kFull) {
    place(cloth, time_step, lead);
  } else if (last_level_ != DetailLevel::kFull || blended_ < detail_.blend) {
    release(cloth, time_step, lead);
  }
  last_animated_ = lead.animated_positions;
  last_level_ = level_;
}

void DetailController::serialize(StateArchive& archive) {
  archive.part("level of detail");
  archive.value(next_switch_);
  archive.value(level_);
  archive.value(last_level_);
  archive.value(last_animated_);
  archive.value(shape_);
  archive.value(shape_pins_);
  archive.value(turn_);
  archive.value(blended_);
  archive.value(offset_);
  archive.value(offset_change_);
}

}  // namespace weft::scenes
