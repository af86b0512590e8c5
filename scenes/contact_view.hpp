#pragma once

// Tested by tests/engines/contact_view_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// A node that a collider held in the last step.
struct NodeTouch {
  std::size_t cloth = 0;  ///< counted as Scene::cloths
  int node = 0;
  Vector3<double> normal{0, 0, 0};  ///< out of the collider
  /// Mean force of the collider on the node over the step, friction included [N].
  Vector3<double> force{0, 0, 0};
  bool is_sticking = false;  ///< held by friction; otherwise it slides
};

/// The interface of engines that say where cloth touches colliders and how hard, beside Simulator.
class ContactView {
 public:
  virtual ~ContactView() = default;

  /// The nodes that bore a force in the last step, cloth by cloth.
  [[nodiscard]] virtual std::vector<NodeTouch> touches() const = 0;
};

}  // namespace weft::scenes
