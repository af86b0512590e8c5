#include <weft/playback/exchange/unfit_recording.hpp>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

constexpr const char* kExpected = "expected finite ones (weft trim --to keeps the frames before)";

bool is_finite(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return values.cast<float>().allFinite();
}

}  // namespace

void check_finite(const SceneState& state, int frame) {
  for (const ClothState& cloth : state.cloths) {
    for (Eigen::Index i = 0; i < cloth.positions.cols(); ++i) {
      if (is_finite(cloth.positions.col(i))) continue;
      throw UnfitRecording(fmt::format(
          "frame {}, t = {:.6g} s: position of node {} of cloth '{}' is not finite in single "
          "precision, {}",
          frame, state.time, i, cloth.name, kExpected));
    }
  }
  for (const RigidState& rigid : state.rigids) {
    const bool has_orientation =
        is_finite(rigid.orientation.coeffs()) && rigid.orientation.norm() > 0.0;
    if (is_finite(rigid.position) && has_orientation) continue;
    throw UnfitRecording(fmt::format(
        "frame {}, t = {:.6g} s: {} of rigid body '{}' is not finite in single precision, {}",
        frame, state.time, has_orientation ? "position" : "orientation", rigid.name, kExpected));
  }
}

}  // namespace weft::scenes
