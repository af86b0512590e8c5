#include <weft/validation/cases/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";
constexpr const char* kDouble = "bullet_weft float64";

constexpr std::array kRows = {
    MotionDeparture{"swing", kSingle,
                    "1e+04 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.127},
    MotionDeparture{"swing", kSingle,
                    "1e+05 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.0896},
    MotionDeparture{"swing", kSingle,
                    "1e+06 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.145},
    MotionDeparture{"swing", kSingle,
                    "1e+06 N/m: time of the first turn, share of what is right from 1", 0.189},
    MotionDeparture{"swing", kSingle,
                    "1e+07 N/m: mean kinetic energy, 0 to 1 s, share of what is right from 0.975",
                    0.278},
    MotionDeparture{"swing", kSingle,
                    "1e+07 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.493},
    MotionDeparture{"swing", kSingle,
                    "1e+07 N/m: time of the first turn, share of what is right from 1", 0.175},
    MotionDeparture{"impacts", kSingle, "sheet_on_edge: highest node at 1 s", 0.563},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: ball aside at 15 s", 9.97},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: ball's height at 15 s", 384},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: ball's speed at 15 s", 86.7},
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 2.57},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.25 s", 3.14},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.5 s", 3.16},
    MotionDeparture{"impacts", kSingle, "ball_into_flag: energy gained", 56.4},
    MotionDeparture{"impacts", kSingle, "ball_into_net: ball's velocity at 0.25 s", 22.8},
    MotionDeparture{"impacts", kSingle, "ball_into_net: ball's velocity at 0.5 s", 22.8},
    MotionDeparture{"impacts", kSingle, "ball_into_net: energy gained", 6.45e+04},
    MotionDeparture{"impacts", kSingle, "ball_into_free_sheet: deepest node in the ball", 0.00308},
    MotionDeparture{"impacts", kSingle, "ball_into_free_sheet: energy gained", 1.44e+03},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.127},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.389},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: energy gained", 15.2},
    MotionDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.427},
    MotionDeparture{"impacts", kSingle, "impact_10_to_1_at_10_m_s: energy gained", 1.29},
    MotionDeparture{"impacts", kSingle, "impact_10_to_1_at_50_m_s: energy gained", 7.18},
    MotionDeparture{"impacts", kSingle, "impact_100_to_1_at_10_m_s: energy gained", 0.119},
    MotionDeparture{"impacts", kSingle, "impact_1000_to_1_at_10_m_s: energy gained", 0.0267},
    MotionDeparture{"impacts", kSingle, "bounce: height of the first bounce", 0.221},
    MotionDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball aside at 60 s", 57.8},
    MotionDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball's height at 60 s", 1.42e+04},
    MotionDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball's speed at 60 s", 528},
    MotionDeparture{"rest", kDouble,
                    "sheet_over_narrow_box, 1/60 s: largest force left over / (m g)", 0.055},
    MotionDeparture{"rest", kDouble, "cotton_2mm, 1/60 s: largest force left over / (m g)", 0.0771},
    MotionDeparture{"rest", kDouble, "cotton_2mm, 1/240 s: largest force left over / (m g)",
                    0.0551}};

}  // namespace

std::span<const MotionDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
