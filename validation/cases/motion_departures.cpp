#include <weft/validation/cases/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";
constexpr const char* kDouble = "bullet_weft float64";

constexpr std::array kRows = {
    MotionDeparture{"swing", kSingle,
                    "1e+05 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.0896},
    MotionDeparture{"swing", kSingle,
                    "1e+06 N/m: time of the first turn, share of what is right from 1", 0.371},
    MotionDeparture{"swing", kSingle,
                    "1e+07 N/m: mean kinetic energy, 0 to 1 s, share of what is right from 0.975",
                    0.278},
    MotionDeparture{"swing", kSingle,
                    "1e+07 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.523},
    MotionDeparture{"swing", kSingle,
                    "1e+07 N/m: time of the first turn, share of what is right from 1", 0.161},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: ball aside at 15 s", 12.4},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: ball's height at 15 s", 400},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: ball's speed at 15 s", 88.5},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 3.35},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.25 s", 3.14},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.5 s", 3.16},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: energy gained", 56.4},
    MotionDeparture{"impacts", kSingle, "ball_into_net: ball's velocity at 0.25 s", 22.8},
    MotionDeparture{"impacts", kSingle, "ball_into_net: ball's velocity at 0.5 s", 22.8},
    MotionDeparture{"impacts", kSingle, "ball_into_net: energy gained", 6.45e+04},
    MotionDeparture{"impacts", kSingle, "ball_into_free_sheet: deepest node in the ball", 0.0108},
    MotionDeparture{"impacts", kSingle, "ball_into_free_sheet: energy gained", 984},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.127},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.389},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: energy gained", 15.2},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.441},
    MotionDeparture{"impacts", kSingle, "impact_10_to_1_at_10_m_s: energy gained", 1.29},
    MotionDeparture{"impacts", kSingle, "impact_10_to_1_at_50_m_s: energy gained", 1.91},
    MotionDeparture{"impacts", kSingle, "impact_100_to_1_at_10_m_s: energy gained", 0.119},
    MotionDeparture{"impacts", kSingle, "impact_1000_to_1_at_10_m_s: energy gained", 0.0266},
    MotionDeparture{"impacts", kSingle, "bounce: height of the first bounce", 0.221},
    MotionDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball aside at 60 s", 71.5},
    MotionDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball's height at 60 s", 1.43e+04},
    MotionDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball's speed at 60 s", 530},
    MotionDeparture{"rest", kDouble,
                    "sheet_over_narrow_box, 1/60 s: largest force left over / (m g)", 0.0648},
    MotionDeparture{"rest", kDouble, "cotton_2mm, 1/60 s: largest force left over / (m g)", 0.0771},
    MotionDeparture{"rest", kDouble, "cotton_2mm, 1/240 s: largest force left over / (m g)",
                    0.0551},
    MotionDeparture{"impacts", kSingle, "ball_into_free_sheet: ball's velocity at 0.3 s", 0.717},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: energy gained", 1.21}};

}  // namespace

std::span<const MotionDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
