#pragma once

// Tested by tests/reference/face_contact_test.cpp.

#include <weft/reference/contact/distance/signed_distance.hpp>

namespace weft::reference {

/// The place of a triangle (columns, world frame [m]) that is nearest to a collider or deepest in
/// it, as barycentric weights [-]. Exact for a sphere; for the other shapes by compass search to
/// kCompassStep of the triangle, which finds it for convex shapes. A plane needs none: there it is a
/// corner.
[[nodiscard]] Vector3<double> deepest_point(const Shape& shape, const Pose& pose,
                                            const Matrix3<double>& triangle);

inline constexpr double kCompassStep = 1e-3;

}  // namespace weft::reference
