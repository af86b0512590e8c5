#include <weft/validation/cases/motion/motion_departures.hpp>

#include <array>

namespace weft::validation {
namespace {

constexpr const char* kSingle = "bullet_weft float32";

constexpr std::array kRows = {
    MotionDeparture{"impacts", kSingle, "ball_on_trampoline: energy gained", 0.0928}};

}  // namespace

std::span<const MotionDeparture> motion_departures() {
  return kRows;
}

}  // namespace weft::validation
