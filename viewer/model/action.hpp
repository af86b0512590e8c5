#pragma once

// Tested by tests/viewer/model/action_test.cpp.

#include <span>
#include <string>
#include <string_view>

namespace weft::viewer {

/// Everything that a key can ask for.
enum class Action {
  kPause,
  kRestart,
  kRestartAsWritten,
  kStepForward,
  kStepBack,
  kTakeBack,
  kFirstFrame,
  kLastFrame,
  kFaster,
  kSlower,
  kLoop,
  kNextStyle,
  kShaded,
  kWireframe,
  kStrain,
  kShadow,
  kWorstNode,
  kContacts,
  kNextGhost,
  kGhosts,
  kNextCloth,
  kPreviousCloth,
  kWindXMore,
  kWindXLess,
  kWindYMore,
  kWindYLess,
  kWindZMore,
  kWindZLess,
  kGravityXMore,
  kGravityXLess,
  kGravityYMore,
  kGravityYLess,
  kGravityZMore,
  kGravityZLess,
  kNextParameter,
  kPreviousParameter,
  kLargerParameter,
  kSmallerParameter,
  kNextEngine,
  kSceneList,
  kListUp,
  kListDown,
  kListOpen,
  kReload,
  kRotateLeft,
  kRotateRight,
  kRotateUp,
  kRotateDown,
  kMoveLeft,
  kMoveRight,
  kMoveUp,
  kMoveDown,
  kZoomIn,
  kZoomOut,
  kResetView,
  kWindowLarger,
  kWindowSmaller,
  kFullScreen,
  kLargerText,
  kSmallerText,
  kPanels,
  kLaws,
  kPlots,
  kHelp,
  kClose,
  kScreenshot,
  kFilm,
  kQuit,
};

/// One row of the input map: the keys that act, the help page and the tooltips come from it.
struct ActionInfo {
  Action action;
  std::string_view id;     ///< in scripts: "wind_x_more"
  std::string_view group;  ///< heading in the help
  std::string_view key;    ///< "Ctrl+Shift+X"; modifiers in the order Ctrl, Shift
  std::string_view help;   ///< half a sentence
};

/// All actions, each once, groups together, in the order of the help.
[[nodiscard]] std::span<const ActionInfo> action_table();

[[nodiscard]] const ActionInfo& info_of(Action action);

/// The action of a key such as "Shift+X", or nullptr.
[[nodiscard]] const ActionInfo* find_key(std::string_view key);
/// The action with this id, or nullptr.
[[nodiscard]] const ActionInfo* find_action(std::string_view id);

/// The text of a tooltip, with the key in brackets.
[[nodiscard]] std::string tooltip(Action action);

}  // namespace weft::viewer
