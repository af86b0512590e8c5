#pragma once

// Tested by tests/reference/contact_test.cpp, tests/reference/self_contact_test.cpp.

#include <array>
#include <vector>

#include <weft/core/types.hpp>

namespace weft::reference {

/// A place on a triangle of a body that meets a collider.
struct FaceTouch {
  std::size_t collider = 0;
  std::size_t body = 0;
  std::array<int, 3> nodes{};
  Vector3<double> weights{0, 0, 0};  ///< barycentric [-]
};

/// Two places of cloth that meet: a node and a triangle, or two edges.
struct PairTouch {
  std::array<std::size_t, 4> bodies{};
  std::array<int, 4> nodes{};
  std::array<double, 4> weights{};  ///< [-], of the separation; they sum up to 0
  Vector3<double> normal{0, 1, 0};  ///< from the second place to the first
  double friction = 0.0;            ///< combined coefficient [-]
};

/// What touched in the position part of a step beside nodes and colliders.
struct Touches {
  std::vector<FaceTouch> faces;
  std::vector<PairTouch> pairs;
};

}  // namespace weft::reference
