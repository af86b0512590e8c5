#include <weft/validation/cases/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";
constexpr const char* kDouble = "bullet_weft float64";

constexpr std::array kRows = {
    StatedDeparture{"swing", kSingle,
                    "1e+04 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.127},
    StatedDeparture{"swing", kSingle,
                    "1e+05 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.0896},
    StatedDeparture{"swing", kSingle,
                    "1e+06 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.145},
    StatedDeparture{"swing", kSingle,
                    "1e+06 N/m: time of the first turn, share of what is right from 1", 0.189},
    StatedDeparture{"swing", kSingle,
                    "1e+07 N/m: mean kinetic energy, 0 to 1 s, share of what is right from 0.975",
                    0.278},
    StatedDeparture{"swing", kSingle,
                    "1e+07 N/m: mean kinetic energy, 1 to 3 s, share of what is right from 0.975",
                    0.493},
    StatedDeparture{"swing", kSingle,
                    "1e+07 N/m: time of the first turn, share of what is right from 1", 0.175},
    StatedDeparture{"impacts", kSingle, "sheet_on_edge: highest node at 1 s", 0.563},
    StatedDeparture{"impacts", kSingle, "ball_on_trampoline: ball aside at 15 s", 9.97},
    StatedDeparture{"impacts", kSingle, "ball_on_trampoline: ball's height at 15 s", 384},
    StatedDeparture{"impacts", kSingle, "ball_on_trampoline: ball's speed at 15 s", 86.7},
    StatedDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 2.57},
    StatedDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.25 s", 3.14},
    StatedDeparture{"impacts", kSingle, "ball_into_flag: ball's velocity at 0.5 s", 3.16},
    StatedDeparture{"impacts", kSingle, "ball_into_flag: energy gained", 56.4},
    StatedDeparture{"impacts", kSingle, "ball_into_net: ball's velocity at 0.25 s", 22.8},
    StatedDeparture{"impacts", kSingle, "ball_into_net: ball's velocity at 0.5 s", 22.8},
    StatedDeparture{"impacts", kSingle, "ball_into_net: energy gained", 6.45e+04},
    StatedDeparture{"impacts", kSingle, "ball_into_free_sheet: deepest node in the ball", 0.00308},
    StatedDeparture{"impacts", kSingle, "ball_into_free_sheet: energy gained", 1.44e+03},
    StatedDeparture{"impacts", kSingle, "impact_1_to_1_at_1_m_s: ball's exit speed", 0.127},
    StatedDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: ball's exit speed", 0.389},
    StatedDeparture{"impacts", kSingle, "impact_1_to_1_at_10_m_s: energy gained", 15.2},
    StatedDeparture{"impacts", kSingle, "impact_1_to_1_at_50_m_s: ball's exit speed", 0.427},
    StatedDeparture{"impacts", kSingle, "impact_10_to_1_at_10_m_s: energy gained", 1.29},
    StatedDeparture{"impacts", kSingle, "impact_10_to_1_at_50_m_s: energy gained", 7.18},
    StatedDeparture{"impacts", kSingle, "impact_100_to_1_at_10_m_s: energy gained", 0.119},
    StatedDeparture{"impacts", kSingle, "impact_1000_to_1_at_10_m_s: energy gained", 0.0267},
    StatedDeparture{"impacts", kSingle, "bounce: height of the first bounce", 0.221},
    StatedDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball aside at 60 s", 57.8},
    StatedDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball's height at 60 s", 1.42e+04},
    StatedDeparture{"impacts", kSingle, "trampoline_for_a_minute: ball's speed at 60 s", 528},
    StatedDeparture{"rest", kDouble,
                    "sheet_over_narrow_box, 1/60 s: largest force left over / (m g)", 0.055},
    StatedDeparture{"rest", kDouble, "cotton_2mm, 1/60 s: largest force left over / (m g)", 0.0771},
    StatedDeparture{"rest", kDouble, "cotton_2mm, 1/240 s: largest force left over / (m g)",
                    0.0551}};

}  // namespace

std::span<const StatedDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
