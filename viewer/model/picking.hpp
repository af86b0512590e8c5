#pragma once

// Tested by tests/viewer/model/picking_test.cpp.

#include <optional>

#include <weft/scenes/simulator.hpp>

namespace weft::viewer {

/// A place in the picture: x to the right and y downwards from the upper left corner, both from 0
/// to 1.
struct Place {
  double x = 0.5;
  double y = 0.5;
};

/// A node of a cloth.
struct NodeId {
  std::size_t cloth = 0;
  int node = 0;
  friend bool operator==(const NodeId&, const NodeId&) = default;
};

/// The camera of the picture: where a scene's camera follows a body, it has moved with it.
[[nodiscard]] scenes::Camera followed(const scenes::Scene& scene, const scenes::Camera& camera,
                                      const scenes::SceneState& state);

/// The place of a point [m] in the picture; none behind the camera. aspect: width / height.
[[nodiscard]] std::optional<Place> project(const scenes::Camera& camera, double aspect,
                                           const Vector3<double>& point);

/// The point under a place that is as far from the camera as the given one [m].
[[nodiscard]] Vector3<double> point_at(const scenes::Camera& camera, double aspect,
                                       const Place& place, const Vector3<double>& as_far_as);

/// The node nearest to a place, at most a thirtieth of the picture's height away, and of those as near the
/// one in front. Only the first num_cloths cloths count.
[[nodiscard]] std::optional<NodeId> pick(const scenes::Camera& camera, double aspect,
                                         const Place& place, const scenes::SceneState& state,
                                         std::size_t num_cloths);

/// A collider, and the point of its surface that is seen at a place [m].
struct SeenCollider {
  std::size_t collider = 0;
  Vector3<double> point{0, 0, 0};
};

/// The collider at a place that is nearest to the camera. Planes and what is not drawn do not count; cloth hides nothing.
[[nodiscard]] std::optional<SeenCollider> pick_collider(const scenes::Camera& camera, double aspect,
                                                        const Place& place,
                                                        const scenes::Scene& scene,
                                                        const scenes::SceneState& state);

}  // namespace weft::viewer
