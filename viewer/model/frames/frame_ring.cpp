#include <weft/viewer/model/frames/frame_ring.hpp>

#include <utility>

namespace weft::viewer {
namespace {

std::size_t bytes_of(const Snapshot& frame) {
  std::size_t bytes = sizeof(Snapshot) + frame.state.rigids.size() * sizeof(scenes::RigidState);
  for (const scenes::ClothState& cloth : frame.state.cloths) {
    const Eigen::Index numbers = cloth.positions.size() + cloth.velocities.size();
    bytes += sizeof(cloth) + static_cast<std::size_t>(numbers) * sizeof(double);
  }
  if (frame.touches) bytes += frame.touches->size() * sizeof(scenes::NodeTouch);
  return bytes;
}

}  // namespace

FrameRing::FrameRing(std::size_t max_frames, std::size_t max_bytes)
    : max_frames_(max_frames), max_bytes_(max_bytes) {}

void FrameRing::add(SnapshotPtr frame) {
  bytes_ += bytes_of(*frame);
  frames_.push_back(std::move(frame));
  while (frames_.size() > 1 && (frames_.size() > max_frames_ || bytes_ > max_bytes_)) {
    bytes_ -= bytes_of(*frames_.front());
    frames_.pop_front();
  }
}

void FrameRing::drop_after(int step) {
  while (!frames_.empty() && frames_.back()->step > step) {
    bytes_ -= bytes_of(*frames_.back());
    frames_.pop_back();
  }
}

void FrameRing::clear() {
  frames_.clear();
  bytes_ = 0;
}

}  // namespace weft::viewer
