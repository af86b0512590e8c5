#include <weft/validation/cases/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";
constexpr const char* kDouble = "bullet_weft float64";

constexpr std::array kRows = {
    MotionDeparture{"swing", kSingle,
                    "1e+06 N/m: time of the first turn, share of what is right from 1", 0.102},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 0.0256},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.25 s", 0.42},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.5 s", 0.42},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.0658},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.297},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.238},
    MotionDeparture{"impacts", kSingle, "bounce: height of the first bounce", 0.0602},
    MotionDeparture{"rest", kDouble, "cotton_2mm, 1/60 s: largest force left over / (m g)", 0.0637},
    MotionDeparture{"rest", kDouble, "cotton_2mm, 1/240 s: largest force left over / (m g)", 0.133},
    MotionDeparture{"swing", kSingle,
                    "1e+04 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.11},
    MotionDeparture{"swing", kSingle,
                    "1e+06 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.128}};

}  // namespace

std::span<const MotionDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
