#include <weft/validation/contact_table/passage.hpp>

#include <algorithm>
#include <cmath>

namespace weft::validation {
namespace {

constexpr int kPieces = 16;  // of the way between two states

}  // namespace

void Passage::walk(Node& node, const Vector3<double>& to) const {
  const Vector3<double> way = to - node.place;
  const double end_distance = distance_(to);
  // Too far from the surface at both ends to reach it in between.
  const bool is_clear = !node.is_inside && node.distance + end_distance > way.norm();
  for (int piece = 1; piece <= kPieces && !is_clear; ++piece) {
    const Vector3<double> here = node.place + way * (static_cast<double>(piece) / kPieces);
    const bool is_inside = (piece == kPieces ? end_distance : distance_(here)) < 0;
    if (is_inside && !node.is_inside) node.entry = here;
    if (!is_inside && node.is_inside && (here - node.entry).norm() > radius_) {
      node.has_passed = true;
    }
    node.is_inside = is_inside;
  }
  node.place = to;
  node.distance = end_distance;
}

void Passage::add(const Pose& pose, ConstMatrix3XRef<double> positions) {
  const Eigen::Quaterniond turn = pose.orientation.normalized().conjugate();
  const bool is_first = nodes_.empty();
  nodes_.resize(static_cast<std::size_t>(positions.cols()));
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vector3<double> place =
        turn * Vector3<double>(positions.col(static_cast<Eigen::Index>(i)) - pose.position);
    Node& node = nodes_[i];
    if (is_first) {
      node.place = place;
      node.distance = distance_(place);
      node.is_inside = node.distance < 0;
      node.entry = place;
    } else {
      walk(node, place);
    }
    deepest_ = std::max(deepest_, -node.distance);
  }
}

double Passage::deepest_now() const {
  double deepest = 0.0;
  for (const Node& node : nodes_) deepest = std::max(deepest, -node.distance);
  return deepest;
}

int Passage::num_tunnelled() const {
  return static_cast<int>(std::count_if(nodes_.begin(), nodes_.end(), [&](const Node& node) {
    return node.has_passed || node.distance < -0.5 * radius_;
  }));
}

}  // namespace weft::validation
