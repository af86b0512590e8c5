#pragma once

// Tested by tests/viewer/model/script_test.cpp.

#include <string>
#include <string_view>
#include <vector>

#include <weft/viewer/session.hpp>

namespace weft::viewer {

/// Input from a file in place of keys and mouse, for tests and for films. A line is
///
///   key Ctrl+X                       the key of the input map
///   do wind_x_more                   the action with this id
///   drag rotate 0.5 0.5 0.6 0.5 1    rotate, pan, pull or carry, from and to as parts of the picture, [s]
///   scroll 3                         notches of the wheel
///   wait 0.5                         [s]
///   wait_time 1.5                    until so much is simulated or played [s]
///   screenshot NAME.png
///   quit
///
/// and goes through the same handlers. Empty lines and lines that begin with # do nothing.
class Script {
 public:
  Script() = default;
  /// Throws InvalidArgument with name:line for a line that means nothing.
  Script(std::string_view text, const std::string& name);

  /// Does what is due; to be called for every picture, with the wall time since the last one [s].
  void advance(Session& session, double seconds, double aspect);
  [[nodiscard]] bool is_done() const { return next_ == lines_.size(); }

 private:
  struct Line {
    std::string word;
    std::string text;             ///< key, action, file, kind of drag
    std::vector<double> numbers;  ///< of drag, scroll and wait
  };
  [[nodiscard]] static Line parse(const std::string& line);
  /// True if the line is done.
  [[nodiscard]] bool run(const Line& line, Session& session, double aspect);
  [[nodiscard]] bool drag(const Line& line, Session& session, double aspect);

  std::vector<Line> lines_;
  std::size_t next_ = 0;
  double waited_ = 0.0;  ///< [s] in the present line
};

}  // namespace weft::viewer
