#pragma once

#include <string>
#include <vector>

#include <weft/custom_forces/set_up_warnings.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::scenes {

/// A warning about a cloth of a scene, and the engines that it is for.
struct SceneWarning {
  std::string cloth;
  forces::SetUpWarning warning;
  std::vector<std::string> engines;
};

/// What will most likely not do what was meant if engines of these names run the scene, by cloth. Colliders count with their extents
/// and their own speed; paths, controllers and what happens later do not. Of a character's cloth, which its bones hold near their
/// places, the mesh is looked at alone. Throws InvalidArgument as make_mesh(), and for an engine that is not in kEngineKinds.
[[nodiscard]] std::vector<SceneWarning> find_warnings(const Scene& scene,
                                                      const std::vector<std::string>& engines,
                                                      bool is_single_precision);

/// Half of the smallest and half of the middle extent of a shape in its own frame [m]; of a compound the least of its parts;
/// infinity for planes, meshes and height fields, which are ground.
struct HalfExtents {
  double least;
  double middle;
};
[[nodiscard]] HalfExtents half_extents(const Shape& shape);

}  // namespace weft::scenes
