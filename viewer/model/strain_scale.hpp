#pragma once

// Tested by tests/viewer/model/strain_scale_test.cpp.

#include <weft/playback/rendering/renderer.hpp>

namespace weft::viewer {

/// The range of the strain's colors: round and symmetric. It holds 99 of 100 nodes, so that a few of
/// them do not bleach all others, and becomes smaller only after a while, so that colors do not flicker.
class StrainScale {
 public:
  /// Pictures in a row that must do with a smaller range before it is taken.
  static constexpr int kPatience = 6;

  /// The strains [-] of the next picture.
  void include(const std::vector<Eigen::VectorXd>& strains);
  void reset() { *this = {}; }
  /// Largest strain of the range [-], > 0.
  [[nodiscard]] double limit() const { return limit_ > 0.0 ? limit_ : 0.01; }
  /// The field that the renderer draws, in percent.
  [[nodiscard]] scenes::ScalarField field(const std::vector<Eigen::VectorXd>& strains) const;

 private:
  double limit_ = 0.0;
  int num_small_ = 0;  ///< pictures in a row for which the range is far too large
};

}  // namespace weft::viewer
