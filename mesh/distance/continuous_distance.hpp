#pragma once

// Tested by tests/reference/self_contact_test.cpp.

#include <cstdint>
#include <optional>

#include <weft/mesh/distance/primitive_distance.hpp>

namespace weft {

enum class PairKind { kPointTriangle, kEdges };

/// Nearest places of a pair, by its kind.
[[nodiscard]] Nearest nearest(PairKind kind, const FourPoints& points);

/// Part of a straight motion, 0 to 1, at which a pair comes nearer than a distance [m]; nothing if
/// it does not. Conservative: nothing means that the distance is never below 0.9 of it. The motion
/// is advanced by what the distance certainly allows (conservative advancement), so no root of a
/// polynomial can be missed. num_distances: grows by the number of distances that it took.
[[nodiscard]] std::optional<double> first_approach(PairKind kind, const FourPoints& start,
                                                   const FourPoints& motion, double distance,
                                                   std::int64_t* num_distances = nullptr);

}  // namespace weft
