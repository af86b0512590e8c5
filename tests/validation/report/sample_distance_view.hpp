#pragma once

#include <weft/validation/report/distance_view.hpp>

namespace weft::tests {

/// A cloth of 25 x 25 nodes that sinks on a sphere in six frames; two engines, of which the second has
/// no last frame and one node that is not finite. Invented numbers.
[[nodiscard]] validation::DistanceView sample_distance_view();

}  // namespace weft::tests
