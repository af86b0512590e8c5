// What is known to fail, by cause. tools/state_deviations.py prints the rows of a report; causes are written by hand.
// Tested by tests/validation/known_deviations_test.cpp.
#include <weft/validation/deviations/known_deviations.hpp>

namespace weft::validation {
namespace {

const KnownDeviation kTurningSprings{
    "bullet_weft",
    "A stiff spring that turns far in a step: period and energy of BDF2 are off by 1.3 to 3 times "
    "what is allowed a second-order method",
    {
        {"spring_pendulum", "bullet_weft float32, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.0548},
        {"spring_pendulum", "bullet_weft float32, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0421},
        {"spring_pendulum", "bullet_weft float32, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 60 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0153},
        {"spring_pendulum", "bullet_weft float32, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.00918},
        {"spring_pendulum", "bullet_weft float32, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0073},
        {"spring_pendulum", "bullet_weft float64, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.0548},
        {"spring_pendulum", "bullet_weft float64, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0421},
        {"spring_pendulum", "bullet_weft float64, 1/30 s",
         "in the engine: a stiff pendulum, amplitude 60 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0153},
        {"spring_pendulum", "bullet_weft float64, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, has its period",
         "relative error of its period", 0.00918},
        {"spring_pendulum", "bullet_weft float64, 1/60 s",
         "in the engine: a stiff pendulum, amplitude 120 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0073},
    }};

const KnownDeviation kSinglePrecision{
    "bullet_forces",
    "In single precision a node cannot move by less than the rounding of its place in a step: a "
    "chain that comes to rest, and a slow swing, stall",
    {
        {"hanging_chain", "bullet_forces float32",
         "in the engine: a chain of 10 masses hangs as theory says",
         "relative error of the tip's drop", 0.00267},
        {"hanging_chain", "bullet_forces float32",
         "in the engine: a chain of 30 masses hangs as theory says",
         "relative error of the tip's drop", 0.00777},
        {"spring_pendulum", "bullet_forces float32",
         "in the engine: a stiff pendulum, amplitude 60 degrees, keeps its energy",
         "relative error of the energy left after one period, from 5 of them", 0.0024},
    }};

}  // namespace

std::span<const KnownDeviation> known_deviations() {
  static const std::vector<KnownDeviation> kTable = {kTurningSprings, kSinglePrecision};
  return kTable;
}

}  // namespace weft::validation
