#include <weft/validation/cases/motion/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";
constexpr const char* kDouble = "bullet_weft float64";

constexpr std::array kRows = {
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 0.0256},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.25 s", 0.381},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.5 s", 0.381},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.149},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.282},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.229},
    MotionDeparture{"impacts", kSingle, "bounce: height of the first bounce", 0.0602}};

}  // namespace

std::span<const MotionDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
