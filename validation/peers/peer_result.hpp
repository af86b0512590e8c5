#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// What another program says about a cloth; validation/peers/run.sh makes it.
struct PeerResult {
  std::string peer;                  ///< "Blender 3.4.1"
  scenes::Scene scene;               ///< the same cloth for Weft's engines, one frame per 1/50 s
  std::vector<std::string> mapping;  ///< how the material was carried over
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the peer, in its own words
  struct Calibration {
    std::string what;
    double measured;
    double expected;
  };
  std::vector<Calibration> calibration;
  std::vector<double> times;                ///< [s]
  std::vector<Matrix3X<double>> positions;  ///< 3 x n [m] per time
};

/// The stored results as JSON text; built in.
[[nodiscard]] std::span<const std::string_view> peer_texts();

/// @throws Error for text that is no result of a peer.
[[nodiscard]] PeerResult read_peer_result(std::string_view text);

}  // namespace weft::validation
