#include <weft/scenes/motion/path.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/LU>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

constexpr double kGravity = 9.81;  ///< [m/s^2] that a banking frame balances its curve against

/// Travel is measured over this share of the whole motion: at its ends, where the frame rests, the
/// derivative has no direction.
constexpr double kTravelShare = 1e-3;

/// [rad] a loop may end turned by, against whole turns: rounding of angles given in degrees.
constexpr double kWholeTurnTolerance = 1e-9;

void require_path(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("path: " + message);
}

bool is_whole_turn(double angle) {
  return std::abs(std::remainder(angle, 2 * std::numbers::pi)) < kWholeTurnTolerance;
}

void check(const Path& path) {
  const std::size_t n = path.times.size();
  require_path(n >= 2 && n <= PathMotion::kMaxPoints, std::to_string(n) + " times, expected 2 to " +
                                                          std::to_string(PathMotion::kMaxPoints));
  require_path(path.points.size() == n, std::to_string(path.points.size()) +
                                            " points, expected one for each of the " +
                                            std::to_string(n) + " times");
  require_path(path.turns.empty() || path.turns.size() == n,
               std::to_string(path.turns.size()) + " turns, expected none or one for each of the " +
                   std::to_string(n) + " times");
  for (std::size_t i = 0; i < n; ++i) {
    require_path(std::isfinite(path.times[i]), "a time is not finite");
    require_path(path.points[i].allFinite(), "a point is not finite");
    if (i == 0) continue;
    require_path(
        path.times[i] > path.times[i - 1],
        "time " + std::to_string(i) + " is not after the one before it, expected growing times");
    require_path(path.follow == PathFollow::kFixed || path.points[i] != path.points[i - 1],
                 "points " + std::to_string(i - 1) + " and " + std::to_string(i) +
                     " are the same place, which has no direction of travel");
  }
  for (const double turn : path.turns) require_path(std::isfinite(turn), "a turn is not finite");
  require_path(!path.loop || path.points.front() == path.points.back(),
               "a loop ends elsewhere than it starts, expected the last point = the first");
  require_path(!path.loop || n >= 3, "a loop of 2 times, expected at least 3");
  require_path(
      !path.loop || path.turns.empty() || is_whole_turn(path.turns.back() - path.turns.front()),
      "a loop ends turned, expected the last turn = the first, or whole turns more");
  require_path(std::isfinite(path.ease_in) && path.ease_in >= 0,
               "ease_in is not >= 0 [s] and finite");
  require_path(path.turn_axis.allFinite() && !path.turn_axis.isZero(),
               "turn_axis has no direction");
}

/// Second derivatives of the cubic spline through the knots: periodic, or at rest at both ends.
template <class Row>
std::vector<Row> bends_of(const std::vector<double>& t, const std::vector<Row>& y, bool loop) {
  const auto n = static_cast<Eigen::Index>(t.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, Row::RowsAtCompileTime);
  const auto h = [&](Eigen::Index i) {
    return t[static_cast<std::size_t>(i + 1)] - t[static_cast<std::size_t>(i)];
  };
  const auto slope = [&](Eigen::Index i) -> Row {
    return (y[static_cast<std::size_t>(i + 1)] - y[static_cast<std::size_t>(i)]) / h(i);
  };
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    a(i, i - 1) = h(i - 1);
    a(i, i) = 2 * (h(i - 1) + h(i));
    a(i, i + 1) = h(i);
    b.row(i) = 6 * (slope(i) - slope(i - 1)).transpose();
  }
  a(0, 0) = 2 * h(0);
  a(0, 1) = h(0);
  if (loop) {
    // The same bend at both ends, and the same slope.
    a(0, n - 2) += h(n - 2);
    a(0, n - 1) += 2 * h(n - 2);
    b.row(0) = 6 * (slope(0) - slope(n - 2)).transpose();
    a(n - 1, 0) = 1;
    a(n - 1, n - 1) = -1;
  } else {
    b.row(0) = 6 * slope(0).transpose();
    a(n - 1, n - 2) = h(n - 2);
    a(n - 1, n - 1) = 2 * h(n - 2);
    b.row(n - 1) = -6 * slope(n - 2).transpose();
  }
  const Eigen::MatrixXd bends = a.partialPivLu().solve(b);
  std::vector<Row> result;
  for (Eigen::Index i = 0; i < n; ++i) result.emplace_back(bends.row(i).transpose());
  return result;
}

double yaw_of(const Vector3<double>& direction) {
  return std::atan2(-direction.z(), direction.x());
}

}  // namespace

PathMotion::PathMotion(Path path) : path_(std::move(path)) {
  check(path_);
  path_.turn_axis.normalize();
  for (std::size_t i = 0; i < path_.times.size(); ++i) {
    Row& row = knots_.emplace_back();
    row << path_.points[i], path_.turns.empty() ? 0.0 : path_.turns[i];
  }
  bends_ = bends_of(path_.times, knots_, path_.loop);
  if (path_.follow != PathFollow::kFixed) first_yaw_ = yaw_of(travel(0.0));
}

PathMotion::Place PathMotion::place(double time) const {
  double rate = 1.0;
  if (path_.ease_in > 0) {
    if (time < path_.ease_in) {
      rate = std::max(time, 0.0) / path_.ease_in;
      time = 0.5 * std::max(time, 0.0) * rate;
    } else {
      time -= 0.5 * path_.ease_in;
    }
  }
  const double first = path_.times.front();
  const double last = path_.times.back();
  if (path_.loop) {
    const double period = last - first;
    time -= period * std::floor((time - first) / period);
  } else if (time <= first || time >= last) {
    rate = 0.0;
  }
  time = std::clamp(time, first, last);
  const auto after = std::upper_bound(path_.times.begin() + 1, path_.times.end() - 1, time);
  return {static_cast<std::size_t>(after - path_.times.begin()) - 1, time, rate};
}

PathMotion::Row PathMotion::value(const Place& p) const {
  const double h = path_.times[p.piece + 1] - path_.times[p.piece];
  const double b = (p.time - path_.times[p.piece]) / h;
  const double a = 1 - b;
  return a * knots_[p.piece] + b * knots_[p.piece + 1] +
         (h * h / 6) * ((a * a * a - a) * bends_[p.piece] + (b * b * b - b) * bends_[p.piece + 1]);
}

PathMotion::Row PathMotion::slope(const Place& p) const {
  const double h = path_.times[p.piece + 1] - path_.times[p.piece];
  const double b = (p.time - path_.times[p.piece]) / h;
  const double a = 1 - b;
  return (knots_[p.piece + 1] - knots_[p.piece]) / h +
         (h / 6) * ((3 * b * b - 1) * bends_[p.piece + 1] - (3 * a * a - 1) * bends_[p.piece]);
}

PathMotion::Row PathMotion::curvature(const Place& p) const {
  const double h = path_.times[p.piece + 1] - path_.times[p.piece];
  const double b = (p.time - path_.times[p.piece]) / h;
  return (1 - b) * bends_[p.piece] + b * bends_[p.piece + 1];
}

Vector3<double> PathMotion::position(double time) const {
  return value(place(time)).head<3>();
}

Vector3<double> PathMotion::velocity(double time) const {
  const Place p = place(time);
  return p.rate * slope(p).head<3>();
}

Vector3<double> PathMotion::acceleration(double time) const {
  const Place p = place(time);
  Vector3<double> result = p.rate * p.rate * curvature(p).head<3>();
  if (path_.ease_in > 0 && time >= 0 && time < path_.ease_in && p.rate > 0) {
    result += slope(p).head<3>() / path_.ease_in;
  }
  return result;
}

/// Which way the frame goes, also where it rests for a moment.
Vector3<double> PathMotion::travel(double time) const {
  Place p = place(time);
  const double reach = kTravelShare * (path_.times.back() - path_.times.front());
  const auto at = [&](double t) {
    Place other = p;
    other.time = std::clamp(t, path_.times.front(), path_.times.back());
    const auto after = std::upper_bound(path_.times.begin() + 1, path_.times.end() - 1, other.time);
    other.piece = static_cast<std::size_t>(after - path_.times.begin()) - 1;
    return Vector3<double>(value(other).head<3>());
  };
  if (path_.loop) return slope(p).head<3>();
  return at(p.time + reach) - at(p.time - reach);
}

Eigen::Quaterniond PathMotion::heading(double time) const {
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(yaw_of(travel(time)) - first_yaw_, Vector3<double>::UnitY()));
}

Eigen::Quaterniond PathMotion::bank(double time) const {
  Vector3<double> forward = travel(time);
  forward.y() = 0;
  Vector3<double> sideways = acceleration(time);
  sideways.y() = 0;
  if (forward.squaredNorm() > 0) {
    sideways -= sideways.dot(forward) / forward.squaredNorm() * forward;
  }
  // The vertical leans towards the acceleration: about (0, 1, 0) x sideways.
  const Vector3<double> axis = Vector3<double>::UnitY().cross(sideways);
  const double size = axis.norm();
  if (!(size > 0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(size, kGravity), axis / size));
}

Pose PathMotion::pose(double time) const {
  const Row row = value(place(time));
  Pose pose;
  pose.position = row.head<3>();
  pose.orientation = Eigen::AngleAxisd(row[3], path_.turn_axis);
  if (path_.follow != PathFollow::kFixed) pose.orientation = heading(time) * pose.orientation;
  if (path_.follow == PathFollow::kBanked) pose.orientation = bank(time) * pose.orientation;
  pose.orientation.normalize();
  return pose;
}

}  // namespace weft::scenes
