#include <weft/scenes/recording/frame_times.hpp>

#include <algorithm>
#include <cmath>

namespace weft::scenes {
namespace {

constexpr double kPartOfSpacing = 1e-3;

}  // namespace

double time_tolerance(const RecordingReader& reader) {
  if (reader.num_frames() < 2) return kPartOfSpacing * reader.scene().world.frame_interval;
  double spacing = reader.frame_time(1) - reader.frame_time(0);
  for (int frame = 2; frame < reader.num_frames(); ++frame) {
    spacing = std::min(spacing, reader.frame_time(frame) - reader.frame_time(frame - 1));
  }
  return kPartOfSpacing * spacing;
}

std::vector<int> frames_between(const RecordingReader& reader, double from, double to) {
  const double tolerance = time_tolerance(reader);
  std::vector<int> frames;
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const double time = reader.frame_time(frame);
    if (time >= from - tolerance && time <= to + tolerance) frames.push_back(frame);
  }
  return frames;
}

std::vector<CommonFrame> common_frames(const RecordingReader& a, const RecordingReader& b) {
  const double tolerance = std::min(time_tolerance(a), time_tolerance(b));
  std::vector<CommonFrame> frames;
  CommonFrame next;
  while (next.a < a.num_frames() && next.b < b.num_frames()) {
    const double ahead = a.frame_time(next.a) - b.frame_time(next.b);
    if (std::abs(ahead) <= tolerance) {
      frames.push_back(next);
      ++next.a;
      ++next.b;
    } else if (ahead < 0) {
      ++next.a;
    } else {
      ++next.b;
    }
  }
  return frames;
}

}  // namespace weft::scenes
