#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <weft/scenes/recording/recording.hpp>

namespace weft::validation {

/// The first frame of a common time in which two recordings have other bits.
struct FirstDifference {
  int frame_a = 0;
  int frame_b = 0;
  double time = 0.0;      ///< in a [s]
  std::string body = {};  ///< the first that differs, in the order of a; empty: only the time does
  std::string quantity;   ///< "time", "position", "velocity", "orientation", "topology" ...
  std::optional<int> node = {};  ///< of a cloth
};

/// How far one body of both recordings is apart, over the common times.
struct BodyDifference {
  std::string name;
  bool is_cloth = false;
  int num_times = 0;     ///< at which it was compared; without any, all below is zero
  double largest = 0.0;  ///< largest distance of a node, or of the centre of a rigid body [m]
  int node = 0;          ///< where the largest is
  int frame_a = 0;       ///< when the largest is
  int frame_b = 0;
  double time = 0.0;     ///< of frame_a [s]
  double rms = 0.0;      ///< at that time, by vertex_distance() with node_weights() [m]
  double rms_all = 0.0;  ///< over all times at which it was compared, each with the same weight [m]
  double largest_angle = 0.0;  ///< between the orientations of a rigid body [rad]
  std::string note = {};       ///< why it was not compared at all common times; empty: it was
};

/// What two recordings have in common, and what not.
struct RecordingDifference {
  int num_frames_a = 0;
  int num_frames_b = 0;
  int num_common = 0;             ///< frames of the same time, see scenes::common_frames()
  double largest_time_gap = 0.0;  ///< between two times that count as the same [s]
  bool is_same_precision = true;
  bool is_same_blow_up = true;
  std::optional<FirstDifference> first;
  std::vector<BodyDifference> bodies;  ///< of the same kind and name in both, in the order of a
  std::vector<std::string> only_in_a;  ///< names of bodies
  std::vector<std::string> only_in_b;

  /// Precision, all frames with their times, all bodies and the blow-up are the same, bit for bit.
  /// The text of the scene is not looked at.
  [[nodiscard]] bool is_equal() const;
  /// The body with the largest distance; none if none was compared.
  [[nodiscard]] const BodyDifference* farthest() const;
};

/// Compares every frame of a common time. progress, if any, is called with the part that is done, 0
/// to 1.
/// @throws Error if one of them is damaged.
[[nodiscard]] RecordingDifference compare_recordings(
    const scenes::RecordingReader& a, const scenes::RecordingReader& b,
    const std::function<void(double)>& progress = {});

}  // namespace weft::validation
