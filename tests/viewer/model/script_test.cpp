#include <weft/viewer/model/script.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::viewer {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kScriptAspect = 1.6;

Session paused_session() {
  SessionSettings settings;
  settings.files = {"hang"};
  settings.live.is_running = false;
  return Session(std::move(settings));
}

TEST(Scripts, LinesThatMeanNothingAreNamed) {
  const auto refuses = [](const char* text, const char* reason) {
    EXPECT_THAT([&] { Script(text, "a.txt"); }, ThrowsMessage<InvalidArgument>(testing::AllOf(
                                                    HasSubstr("a.txt:2"), HasSubstr(reason))))
        << text;
  };
  refuses("wait 1\njump", "'jump', expected key");
  refuses("\nkey Hyper+X", "key 'Hyper+X'");
  refuses("\ndo fly", "action 'fly'");
  refuses("# drag\ndrag pull 0 0 1", "3 numbers, expected 5");
  refuses("\nwait soon", "'soon', expected a number");
  refuses("\ndrag throw 0 0 1 1 1", "drag 'throw'");
  refuses("\nkey", "without a word");
}

TEST(Scripts, KeysAndActionsGoThroughTheHandlers) {
  Session session = paused_session();
  Script script("key X\ndo wind_x_more\nscroll 2\nkey 2\nscreenshot a.png\nquit\n", "a.txt");
  const double before = (session.view().camera.position - session.view().camera.target).norm();
  script.advance(session, 0.01, kScriptAspect);
  EXPECT_EQ(wind_of(session.source().drawn_scene()).x(), 1.0);
  EXPECT_LT((session.view().camera.position - session.view().camera.target).norm(), before);
  EXPECT_EQ(style_name(session.view().style), "wireframe");
  EXPECT_TRUE(session.view().wants_screenshot);
  EXPECT_FALSE(session.view().wants_to_quit) << "the picture comes first";
  session.view().wants_screenshot = false;
  script.advance(session, 0.01, kScriptAspect);
  EXPECT_TRUE(session.view().wants_to_quit);
  EXPECT_TRUE(script.is_done());
}

TEST(Scripts, WaitsAndDragsTakeTheirTime) {
  Session session = paused_session();
  Script script("wait 0.5\ndrag rotate 0.5 0.5 0.7 0.5 1\n", "a.txt");
  const Vector3<double> before = session.view().camera.position;
  script.advance(session, 0.3, kScriptAspect);
  script.advance(session, 0.3, kScriptAspect);  // begins
  EXPECT_EQ(session.drag(), MouseDrag::kRotate);
  script.advance(session, 0.5, kScriptAspect);
  const Vector3<double> halfway = session.view().camera.position;
  EXPECT_NE(halfway, before);
  script.advance(session, 0.6, kScriptAspect);
  EXPECT_NE(session.view().camera.position, halfway);
  EXPECT_EQ(session.drag(), MouseDrag::kNone);
  EXPECT_TRUE(script.is_done());
}

}  // namespace
}  // namespace weft::viewer
