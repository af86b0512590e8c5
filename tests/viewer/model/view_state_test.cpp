#include <weft/viewer/model/view_state.hpp>

#include <gtest/gtest.h>

namespace weft::viewer {
namespace {

TEST(ViewStates, StylesGoRound) {
  ViewState view;
  EXPECT_EQ(style_name(view.style), "shaded");
  for (const char* name : {"wireframe", "strain", "shaded"}) {
    EXPECT_TRUE(perform(view, Action::kNextStyle, {}));
    EXPECT_EQ(style_name(view.style), name);
  }
  (void)perform(view, Action::kStrain, {});
  EXPECT_EQ(style_name(view.style), "strain");
}

TEST(ViewStates, EveryFlagHasItsKey) {
  ViewState view;
  const auto toggles = [&](Action action, bool ViewState::*flag) {
    const bool before = view.*flag;
    EXPECT_TRUE(perform(view, action, {}));
    EXPECT_NE(view.*flag, before) << info_of(action).id;
  };
  toggles(Action::kShadow, &ViewState::has_shadow);
  toggles(Action::kWorstNode, &ViewState::shows_worst);
  toggles(Action::kPanels, &ViewState::shows_panels);
  toggles(Action::kLaws, &ViewState::shows_laws);
  toggles(Action::kPlots, &ViewState::shows_plots);
  toggles(Action::kHelp, &ViewState::shows_help);
  toggles(Action::kSceneList, &ViewState::shows_list);
  toggles(Action::kFullScreen, &ViewState::is_full_screen);
  toggles(Action::kScreenshot, &ViewState::wants_screenshot);
  toggles(Action::kQuit, &ViewState::wants_to_quit);
}

TEST(ViewStates, EscapeClosesWhatIsOverThePicture) {
  ViewState view;
  view.shows_help = view.shows_list = true;
  EXPECT_TRUE(perform(view, Action::kClose, {}));
  EXPECT_FALSE(view.shows_help || view.shows_list);
}

TEST(ViewStates, SizesGoThroughTheListAndStopAtItsEnds) {
  ViewState view;
  view.size = {1300, 700};  // as a user has drawn it
  (void)perform(view, Action::kWindowLarger, {});
  EXPECT_EQ(view.size.width, 1600);
  for (int i = 0; i < 9; ++i) (void)perform(view, Action::kWindowLarger, {});
  EXPECT_EQ(view.size.width, 1920);
  (void)perform(view, Action::kWindowSmaller, {});
  EXPECT_EQ(view.size.width, 1600);
  for (int i = 0; i < 9; ++i) (void)perform(view, Action::kWindowSmaller, {});
  EXPECT_EQ(view.size.width, 800);
}

TEST(ViewStates, TheCameraMovesAndComesHome) {
  ViewState view;
  const scenes::Camera home = view.camera;
  for (const Action action :
       {Action::kRotateLeft, Action::kRotateUp, Action::kMoveRight, Action::kZoomIn}) {
    const Vector3<double> before = view.camera.position;
    EXPECT_TRUE(perform(view, action, home));
    EXPECT_NE(view.camera.position, before) << info_of(action).id;
  }
  (void)perform(view, Action::kResetView, home);
  EXPECT_EQ(view.camera.position, home.position);
}

TEST(ViewStates, OtherActionsAreLeftToOthers) {
  ViewState view;
  EXPECT_FALSE(perform(view, Action::kPause, {}));
  EXPECT_FALSE(perform(view, Action::kWindXMore, {}));
}

}  // namespace
}  // namespace weft::viewer
