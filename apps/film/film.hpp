#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::app {

/// A recording, and its file as the user named it.
struct NamedRecording {
  const scenes::RecordingReader& reader;
  std::string file;
};

/// Draws frames of one recording.
class Film {
 public:
  Film(const scenes::RecordingReader& reader, const scenes::RenderOptions& options);

  /// camera: before it moves along with the body that it follows.
  void set_camera(const scenes::Camera& camera) { options_.camera = camera; }
  /// style: "shaded", "wireframe" or "strain".
  [[nodiscard]] scenes::Image draw(int frame, const std::string& style);
  [[nodiscard]] scenes::Image draw(int frame, const scenes::ScalarField& field);

 private:
  const scenes::RecordingReader& reader_;
  scenes::RenderOptions options_;
  scenes::Renderer renderer_;
  std::optional<scenes::ScalarField> strain_;
};

/// The pictures of one moment: one for each style, or of two recordings one each; "difference", of two recordings, colors the first by how far its nodes are from
/// those of the second.
class Shots {
 public:
  /// Throws InvalidArgument for "difference" without a second recording, and Error if the two have not the same cloths, or no common time.
  Shots(NamedRecording first, std::optional<NamedRecording> second, std::vector<std::string> styles,
        const scenes::RenderOptions& options);

  /// Frames of the first recording that can be drawn: all, or for "difference" those of times that the second has too.
  [[nodiscard]] const std::vector<int>& frames() const { return frames_; }
  /// How many pictures draw() gives.
  [[nodiscard]] int num_pictures() const;
  void set_camera(const scenes::Camera& camera);
  /// frame: one of frames(). Pictures of two recordings have names and times.
  [[nodiscard]] std::vector<scenes::Image> draw(int frame);

 private:
  void find_common_frames();
  [[nodiscard]] std::vector<Eigen::VectorXd> distances(int frame) const;
  [[nodiscard]] int partner(int frame) const;
  [[nodiscard]] bool has_difference() const;

  NamedRecording first_;
  std::optional<NamedRecording> second_;
  std::vector<std::string> styles_;
  Film first_film_;
  std::optional<Film> second_film_;
  std::vector<int> frames_;
  std::vector<int> partners_;       ///< frames of the second recording, for difference
  scenes::ScalarField difference_;  ///< [mm], with one scale for all frames
};

/// The frame nearest to a time [s].
[[nodiscard]] int nearest_frame(const scenes::RecordingReader& reader, double time);

}  // namespace weft::app
