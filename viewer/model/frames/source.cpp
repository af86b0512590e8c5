#include <weft/viewer/model/frames/source.hpp>

#include <algorithm>
#include <array>

namespace weft::viewer {
namespace {

constexpr std::array kSpeeds = {0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0};

}  // namespace

double next_speed(double speed, int direction) {
  if (direction > 0) {
    const auto* next = std::upper_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1.0 + 1e-9));
    return next == kSpeeds.end() ? kSpeeds.back() : *next;
  }
  const auto* next = std::lower_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1.0 - 1e-9));
  return next == kSpeeds.begin() ? kSpeeds.front() : *(next - 1);
}

}  // namespace weft::viewer
