#pragma once

#include <optional>

#include <weft/bridge/contact/surface/hull_facets.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The distance from a point [m] to the surface of a solid, both in the solid's frame: in closed form for balls, boxes, capsules,
/// cylinders and cones, over the facets for a hull. Boxes and cylinders are as large as with their
/// margin and have sharp edges; cones and hulls are grown by it. From reach [m] on it may be any
/// distance that is not below reach. Nothing for any other shape, and for a hull without facets. Any thread.
[[nodiscard]] std::optional<SurfaceDistance> surface_distance(const btCollisionShape& shape,
                                                              const HullFacets* facets,
                                                              const Vector3<double>& point,
                                                              double reach);

/// Whether surface_distance() gives nothing.
[[nodiscard]] bool needs_distance_field(const btCollisionShape& shape, const HullFacets* facets);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
