#include <weft/validation/cases/motion/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";

constexpr std::array kRows = {
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 0.0833},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.0991},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: momentum changed", 1.41e-4},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.0677},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.0519},
    MotionDeparture{"impacts", kSingle, "bounce: height of the first bounce", 0.0154}};

}  // namespace

std::span<const MotionDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
