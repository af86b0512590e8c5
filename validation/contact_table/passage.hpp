#pragma once

#include <vector>

#include <weft/validation/metrics/distance/shape_distance.hpp>
#include <weft/validation/metrics/distance/signed_distance.hpp>

namespace weft::validation {

/// Follows the nodes of a cloth through one solid, state after state: how deep they go, and which of
/// them pass.
///
/// A depth is that of a node's centre below the surface, at the end of a step. A node has tunnelled
/// if it is deeper than half the solid's radius in the last state, or has ever left the solid more
/// than one radius from where it had entered it, both places in the solid's frame. Between two
/// states nodes go straight; entries and exits are found on that line to 1/16 of it.
class Passage {
 public:
  /// radius [m], > 0: a scale of the solid, that of the largest ball inside it.
  Passage(const scenes::Shape& shape, double radius) : distance_(shape), radius_(radius) {}

  /// Shapes   positions 3 x n [m], the same n every time
  void add(const Pose& pose, ConstMatrix3XRef<double> positions);

  [[nodiscard]] double deepest() const { return deepest_; }  ///< [m] of any node so far, >= 0
  [[nodiscard]] double deepest_now() const;                  ///< [m] in the last state, >= 0
  [[nodiscard]] int num_tunnelled() const;

 private:
  struct Node {
    Vector3<double> place{0, 0, 0};  ///< in the solid's frame [m]
    double distance = 0.0;           ///< [m]
    bool is_inside = false;
    Vector3<double> entry{0, 0, 0};  ///< in the solid's frame [m]
    bool has_passed = false;
  };
  void walk(Node& node, const Vector3<double>& to) const;

  ShapeDistance distance_;
  double radius_;
  double deepest_ = 0.0;
  std::vector<Node> nodes_;
};

}  // namespace weft::validation
