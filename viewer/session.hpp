#pragma once

// Tested by tests/viewer/session_test.cpp.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <weft/viewer/live/live_source.hpp>
#include <weft/viewer/model/frames/file_watch.hpp>
#include <weft/viewer/model/view_state.hpp>

namespace weft::viewer {

struct SessionSettings {
  std::vector<std::string> files;  ///< scenes, or recordings that are compared
  LiveSettings live;               ///< name is that of the file
  scenes::SurfaceStyle style = scenes::SurfaceStyle::kShaded;
};

/// The effect of a button of the mouse while it is down.
enum class MouseDrag { kNone, kRotate, kPan, kPull, kCarry };

/// Everything behind the window: what is shown and how, and what keys and mouse do with it. Needs no
/// window itself.
class Session {
 public:
  /// Opens the first of the files; recordings are opened together. Throws for files that cannot be
  /// shown.
  explicit Session(SessionSettings settings);

  void perform(Action action);
  /// A key such as "Shift+X"; false if it has no action.
  bool press(const std::string& key);
  /// Wall time [s] has gone by since the last call.
  void update(double seconds);

  // The mouse; width / height of the picture is its aspect.
  void begin_drag(MouseDrag drag, const Place& place, double aspect);
  void drag_to(const Place& place, double aspect);
  void end_drag();
  void scroll(double notches);
  [[nodiscard]] MouseDrag drag() const { return drag_; }
  /// The node that is pulled.
  [[nodiscard]] const std::optional<Pull>& pull() const { return pull_; }
  /// The collider that is moved.
  [[nodiscard]] const std::optional<Carry>& carry() const { return carry_; }

  [[nodiscard]] Source& source() { return *source_; }
  /// The source if it is a live run, else nullptr.
  [[nodiscard]] LiveSource* live() { return live_; }
  [[nodiscard]] ViewState& view() { return view_; }
  /// The entries of the list: the given files, then the catalog.
  [[nodiscard]] const std::vector<std::string>& list() const { return list_; }
  [[nodiscard]] std::size_t row() const { return row_; }
  /// Shows a row of the list; what cannot be opened is told by the message, and all stays.
  void open(std::size_t row);
  [[nodiscard]] const std::string& title() const { return title_; }

  /// Number of the chosen parameter in parameters_of().
  [[nodiscard]] std::size_t chosen() const { return chosen_; }
  void choose(std::size_t parameter) { chosen_ = parameter; }

  /// The last thing to tell, for as long as it is shown; empty if there is nothing.
  [[nodiscard]] const std::string& message() const { return message_; }
  void tell(std::string message);

  /// State for tests and scripts, as JSON.
  [[nodiscard]] std::string describe();

 private:
  void show(const std::string& name);
  bool perform_list(Action action);
  /// What is to be said of contacts that are shown from now on.
  void tell_of_contacts();
  void begin_pull(const Place& place, double aspect);
  void begin_carry(const Place& place, double aspect);
  /// The point under the mouse, as far away as what was grabbed; none without a picture.
  [[nodiscard]] std::optional<Vector3<double>> dragged_to(const Place& place, double aspect);
  bool perform_parameter(Action action);

  SessionSettings settings_;
  std::unique_ptr<Source> source_;
  LiveSource* live_ = nullptr;
  ViewState view_;
  FileWatch watch_;
  std::string title_;
  std::vector<std::string> list_;
  std::size_t row_ = 0;
  std::size_t chosen_ = 0;
  MouseDrag drag_ = MouseDrag::kNone;
  Place last_place_;
  Vector3<double> grabbed_{0, 0, 0};  ///< [m] where the pulled node was
  std::optional<Pull> pull_;
  std::optional<Carry> carry_;
  Vector3<double> carry_offset_{0, 0, 0};  ///< [m] from the grabbed point to the collider's center
  double largest_pull_force_ = 0.0;        ///< [N] so far
  std::string message_;
  double message_age_ = 0.0;  ///< [s]
};

}  // namespace weft::viewer
