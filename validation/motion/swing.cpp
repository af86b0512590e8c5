#include <weft/validation/motion/swing.hpp>

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <weft/core/error.hpp>

namespace weft::validation {
namespace {

constexpr double kGravity = 9.81;    // [m/s^2]
constexpr int kPlateSubsteps = 200;  // of the plate's equation: its error is a few micrometres
constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// The sheet turned about its held edge by an angle from where it starts [rad].
Matrix3X<double> turned(const ClothMesh& mesh, double angle) {
  const double axis = mesh.rest_positions.row(2).maxCoeff();
  Matrix3X<double> places = mesh.rest_positions;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const double lever = axis - mesh.rest_positions(2, i);
    places(1, i) = mesh.rest_positions(1, i) - lever * std::sin(angle);
    places(2, i) = axis - lever * std::cos(angle);
  }
  return places;
}

}  // namespace

SwingTrack::SwingTrack(const ClothMesh& mesh, double time_step, Places places)
    : mesh_(mesh), time_step_(time_step), places_(std::move(places)) {
  if (places_.size() < 2) {
    throw InvalidArgument(fmt::format("swing: {} states, expected 2 or more", places_.size()));
  }
  for (const Matrix3X<double>& state : places_) {
    if (state.cols() == mesh.num_nodes()) continue;
    throw InvalidArgument(
        fmt::format("swing: {} nodes, expected {}", state.cols(), mesh.num_nodes()));
  }
}

double SwingTrack::kinetic_energy(double begin, double end) const {
  double sum = 0;
  int count = 0;
  for (std::size_t step = 1; step < places_.size(); ++step) {
    const double time = static_cast<double>(step) * time_step_;
    if (time <= begin + 1e-9 || time > end + 1e-9) continue;
    const VectorX<double> squared =
        (places_[step] - places_[step - 1]).colwise().squaredNorm().transpose();
    sum += 0.5 * mesh_.masses.dot(squared) / (time_step_ * time_step_);
    ++count;
  }
  return count > 0 ? sum / count : kNoFigure;
}

double SwingTrack::turning_time() const {
  const auto across = [&](std::size_t step) {
    return places_[step].row(2).dot(mesh_.masses.transpose()) / mesh_.masses.sum();
  };
  double before = across(1) - across(0);
  for (std::size_t step = 2; step < places_.size(); ++step) {
    const double after = across(step) - across(step - 1);
    // The velocities are those in the middle of their steps.
    if (before > 0 && after <= 0) {
      return (static_cast<double>(step) - 1.5 + before / (before - after)) * time_step_;
    }
    before = after;
  }
  return kNoFigure;
}

SwingTrack::Stretch SwingTrack::stretch() const {
  const Edges edges = mesh_.edges_of({"stretch"});
  const VectorX<double> now = edge_lengths(places_.back(), edges);
  const VectorX<double> rest = edge_lengths(mesh_.rest_positions, edges);
  const VectorX<double> change = (now.array() / rest.array() - 1).abs();
  return {change.maxCoeff(), change.mean()};
}

double rms_distance(const Places& a, const Places& b) {
  double sum = 0;
  double count = 0;
  for (std::size_t step = 1; step < std::min(a.size(), b.size()); ++step) {
    if (a[step].cols() != b[step].cols()) {
      throw InvalidArgument(fmt::format("swing: states of {} and {} nodes, expected the same",
                                        a[step].cols(), b[step].cols()));
    }
    sum += (a[step] - b[step]).squaredNorm();
    count += static_cast<double>(a[step].cols());
  }
  return count > 0 ? std::sqrt(sum / count) : kNoFigure;
}

Places frozen(const ClothMesh& mesh, int num_steps) {
  return Places(static_cast<std::size_t>(num_steps) + 1, mesh.rest_positions);
}

Places hanging_flat(const ClothMesh& mesh, int num_steps) {
  return Places(static_cast<std::size_t>(num_steps) + 1, turned(mesh, 0.5 * M_PI));
}

Places rigid_plate(const ClothMesh& mesh, double time_step, int num_steps) {
  const double axis = mesh.rest_positions.row(2).maxCoeff();
  const VectorX<double> levers = (axis - mesh.rest_positions.row(2).array()).matrix().transpose();
  const double rate = kGravity * mesh.masses.dot(levers) / mesh.masses.dot(levers.cwiseAbs2());
  Places places = {mesh.rest_positions};
  double angle = 0;
  double speed = 0;
  const double h = time_step / kPlateSubsteps;
  for (int step = 0; step < num_steps; ++step) {
    for (int k = 0; k < kPlateSubsteps; ++k) {
      speed += 0.5 * h * rate * std::cos(angle);
      angle += h * speed;
      speed += 0.5 * h * rate * std::cos(angle);
    }
    places.push_back(turned(mesh, angle));
  }
  return places;
}

}  // namespace weft::validation
