#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <weft/core/types.hpp>

namespace weft::scenes {

/// Positions of one set of points over time, as a PC2 file (POINTCACHE2, version 1) has them.
struct PointCache {
  float first_frame = 0.0f;               ///< frame of the first sample [-]
  float frame_step = 1.0f;                ///< frames from one sample to the next [-], > 0
  std::vector<Eigen::Matrix3Xf> samples;  ///< 3 x n each, all with the same n
};

/// Bytes of a PC2 file, little-endian. Throws InvalidArgument for samples with different numbers of points.
[[nodiscard]] std::string encode_point_cache(const PointCache& cache);
/// file: for messages. Throws Error that names the file and the fault for bytes that are no whole PC2 file.
[[nodiscard]] PointCache decode_point_cache(std::string_view bytes, const std::string& file);

}  // namespace weft::scenes
