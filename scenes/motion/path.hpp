#pragma once

#include <vector>

#include <weft/scenes/motion/pose.hpp>

namespace weft::scenes {

/// How a frame turns while it follows a path.
enum class PathFollow {
  kFixed,    ///< only by Path::turns
  kHeading,  ///< about the vertical, as its direction of travel turns
  kBanked,   ///< also leans into its curves, as far as a pendulum would
};

/// A smooth motion through given places at given times: a cubic spline, so that velocities and
/// accelerations are continuous.
struct Path {
  std::vector<double> times;            ///< [s], growing, at least 2
  std::vector<Vector3<double>> points;  ///< [m], one for each time
  /// Goes on from the first point after the last one, which must be the same place. Otherwise the
  /// motion starts and ends at rest, and rests before and after.
  bool loop = false;
  /// Over this time [s] the clock of the motion speeds up from 0, so that a loop starts at rest.
  double ease_in = 0.0;
  PathFollow follow = PathFollow::kFixed;
  Vector3<double> turn_axis{0, 1, 0};  ///< [-]
  /// [rad] about turn_axis, one for each time, or none; a loop ends as it starts, or whole turns on
  std::vector<double> turns = {};
};

/// Evaluates a Path. Poses are relative to the start: at time 0 the orientation is the identity
/// turned by turns[0].
class PathMotion {
 public:
  /// Throws InvalidArgument for what the comments of Path forbid, for more than kMaxPoints points,
  /// and for a path that follows its heading but has two equal points in a row.
  explicit PathMotion(Path path);

  static constexpr std::size_t kMaxPoints = 500;

  [[nodiscard]] Pose pose(double time) const;                     ///< time [s]
  [[nodiscard]] Vector3<double> position(double time) const;      ///< [m]
  [[nodiscard]] Vector3<double> velocity(double time) const;      ///< [m/s]
  [[nodiscard]] Vector3<double> acceleration(double time) const;  ///< [m/s^2]
  [[nodiscard]] const Path& path() const { return path_; }

 private:
  using Row = Eigen::Matrix<double, 4, 1>;  ///< place [m] and turn [rad]
  struct Place {
    std::size_t piece;
    double time;  ///< of the spline [s]
    double rate;  ///< of its clock against the real one [-]
  };
  [[nodiscard]] Place place(double time) const;
  [[nodiscard]] Row value(const Place& place) const;
  [[nodiscard]] Row slope(const Place& place) const;      ///< per second of the spline's clock
  [[nodiscard]] Row curvature(const Place& place) const;  ///< per second^2
  [[nodiscard]] Vector3<double> travel(double time) const;
  [[nodiscard]] Eigen::Quaterniond heading(double time) const;
  [[nodiscard]] Eigen::Quaterniond bank(double time) const;

  Path path_;
  std::vector<Row> knots_;
  std::vector<Row> bends_;  ///< second derivatives at the knots
  double first_yaw_ = 0.0;  ///< of the direction of travel at the start [rad]
};

}  // namespace weft::scenes
