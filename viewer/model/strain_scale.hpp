#pragma once

// Tested by tests/viewer/model/strain_scale_test.cpp.

#include <weft/playback/rendering/renderer.hpp>

namespace weft::viewer {

/// The range of the strain's colors: round, symmetric, and only ever wider, so that colors do not
/// flicker.
class StrainScale {
 public:
  /// Widens the range to these strains [-].
  void include(const std::vector<Eigen::VectorXd>& strains);
  void reset() { limit_ = 0.0; }
  /// Largest strain of the range [-], > 0.
  [[nodiscard]] double limit() const { return limit_ > 0.0 ? limit_ : 0.01; }
  /// What the renderer takes, in percent.
  [[nodiscard]] scenes::ScalarField field(const std::vector<Eigen::VectorXd>& strains) const;

 private:
  double limit_ = 0.0;
};

}  // namespace weft::viewer
