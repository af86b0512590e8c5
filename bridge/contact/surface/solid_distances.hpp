#pragma once

// Tested by tests/bridge/contact/surface/solid_distances_test.cpp.

#include <array>

#include <Eigen/Core>

#include <weft/bridge/contact/rigid_contacts.hpp>
#include <weft/bridge/contact/surface/surface_distance.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The distances of nodes from a box or a ball, for a group of nodes at a time in loops over arrays: most cloth lies on one of
/// these. The numbers are those of surface_distance() for one node after the other, to the bit.
class SolidDistances {
 public:
  static constexpr int kLanes = NodeGroups::kLargest;
  using Lanes = Eigen::Array<double, kLanes, 1>;
  using Vectors = std::array<Lanes, 3>;
  struct Distances {
    Vectors points;  ///< the positions as seen from the solid [m]
    Vectors out;     ///< unit vectors out of the solid, as seen from it
    Lanes distance;  ///< of the points from the solid [m]

    [[nodiscard]] Vector3<double> point(int lane) const { return at(points, lane); }
    [[nodiscard]] SurfaceDistance surface(int lane) const {
      return {distance[lane], at(out, lane)};
    }

   private:
    [[nodiscard]] static Vector3<double> at(const Vectors& vectors, int lane) {
      return {vectors[0][lane], vectors[1][lane], vectors[2][lane]};
    }
  };

  [[nodiscard]] static bool has(const btCollisionShape& shape);
  /// A shape as has() says; where the collider stands.
  explicit SolidDistances(const Collider& collider);

  /// positions: in the world [m].
  [[nodiscard]] Distances of(const Vectors& positions) const;

 private:
  void find_from_box(Distances& found) const;
  void find_from_ball(Distances& found) const;

  bool is_ball_;
  double radius_ = 0;              ///< of a ball [m]
  Vector3<double> half_{0, 0, 0};  ///< of a box [m]
  Vector3<double> origin_;         ///< [m]
  Eigen::Matrix<double, 3, 3> turn_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
