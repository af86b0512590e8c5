#include <weft/validation/cases/motion/motion_deviations.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";

constexpr std::array kRows = {
    MotionDeviation{"impacts", kSingle, "ball_on_trampoline: energy gained", 0.0928}};

}  // namespace

std::span<const MotionDeviation> motion_deviations() {
  return kRows;
}

}  // namespace weft::validation
