#pragma once

// Tested by tests/validation/report/formats/quantized_test.cpp, tests/validation/report/json_test.cpp.

#include <array>
#include <string>
#include <vector>

#include <weft/validation/report/formats/quantized.hpp>

namespace weft::validation {

/// How far an engine's nodes are from the same nodes of the reference, over time.
struct DistanceViewEngine {
  std::string name;  ///< "bullet_soft float32"
  std::vector<double>
      largest;  ///< [m] per frame, over all nodes, not only those drawn; NaN: no frame
  std::vector<Quantized> distances;  ///< [m] per frame, one per drawn node; no bytes: no frame
};

/// A rigid body that the page can draw by its name and sizes.
struct DistanceViewBody {
  std::string shape;          ///< "sphere", "box", "plane", "capsule", "cylinder" or "cone"
  std::vector<double> sizes;  ///< [m] radius; three edges; none; radius and height
  /// Per frame position [m] and orientation (w, x, y, z) in the reference.
  std::vector<std::array<double, 7>> poses;
};

/// The reference's cloth in motion with the distance of other engines painted on it: few frames and
/// few nodes, so that a report of many scenes stays a page one can send.
struct DistanceView {
  int simulated_nodes = 0;           ///< of which the drawn ones are a part
  std::vector<double> times;         ///< [s] of the frames
  std::vector<Quantized> positions;  ///< [m] per frame, x y z of each drawn node, in the reference
  std::vector<int> triangles;        ///< 3 drawn nodes each
  std::vector<DistanceViewEngine> engines;
  std::vector<DistanceViewBody> bodies;
};

}  // namespace weft::validation
