#include <weft/validation/cases/motion/motion_deviations.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";

constexpr std::array kRows = {
    MotionDeviation{"impacts", kSingle, "ball_on_trampoline: energy gained", 0.0833},
    MotionDeviation{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.0991},
    MotionDeviation{"impacts", kSingle, "impact_1_to_1_at_1_m_s: momentum changed", 1.41e-4},
    MotionDeviation{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.0677},
    MotionDeviation{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.0519},
    MotionDeviation{"impacts", kSingle, "bounce: height of the first bounce", 0.0154}};

}  // namespace

std::span<const MotionDeviation> motion_deviations() {
  return kRows;
}

}  // namespace weft::validation
