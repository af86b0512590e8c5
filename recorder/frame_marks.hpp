#pragma once

// Tested by tests/recorder/recorder_marks_test.cpp.

#include <map>
#include <span>
#include <string>
#include <vector>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/scenes/recording/mark.hpp>

class btVector3;

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {

/// The points, lines and arrows of one frame, each name in a color of its own.
class FrameMarks {
 public:
  /// Where the marks begin and end [m]; points have no ends. Throws InvalidArgument, which names them, without a name and
  /// for another number of ends than of beginnings.
  void add(scenes::MarkKind kind, const std::string& name, std::span<const btVector3> begins,
           std::span<const btVector3> ends);
  void clear() { marks_.clear(); }
  [[nodiscard]] std::span<const scenes::Mark> marks() const { return marks_; }

 private:
  std::vector<scenes::Mark> marks_;
  std::map<std::string, scenes::Rgb> colors_;  ///< of all names so far
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
