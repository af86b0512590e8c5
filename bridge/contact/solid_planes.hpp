#pragma once

// Tested by tests/bridge/contact/solid_planes_test.cpp.

#include <array>

#include <Eigen/Core>

#include <weft/bridge/contact/rigid_contacts.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The planes that hold nodes in front of a box or a ball, for a group of nodes at a time in loops over arrays: most cloth lies
/// on one of these. The numbers are those of surface_distance() for one node after the other, to the bit.
class SolidPlanes {
 public:
  static constexpr int kLanes = NodeGroups::kLargest;
  using Lanes = Eigen::Array<double, kLanes, 1>;
  using Vectors = std::array<Lanes, 3>;
  struct Planes {
    std::array<Eigen::Array<btScalar, kLanes, 1>, 3> normal;  ///< out of the solid, as rounded
    Lanes offset;    ///< normal . x >= offset keeps a node the margin away [m]
    Lanes distance;  ///< of the node from the solid [m]
  };

  [[nodiscard]] static bool has(const btCollisionShape& shape);
  /// margin: of the cloth [m]. A shape as has() says; where the collider stands.
  SolidPlanes(const Collider& collider, btScalar margin);

  /// positions: in the world [m].
  [[nodiscard]] Planes at(const Vectors& positions) const;

 private:
  void find_box_distance(const Vectors& points, Vectors& out, Lanes& distance) const;
  void find_ball_distance(const Vectors& points, Vectors& out, Lanes& distance) const;

  bool is_ball_;
  double radius_ = 0;              ///< of a ball [m]
  Vector3<double> half_{0, 0, 0};  ///< of a box [m]
  double margin_;                  ///< [m]
  Vector3<double> origin_;         ///< [m]
  Eigen::Matrix<double, 3, 3> turn_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
