#include <weft/viewer/session.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <thread>

#include <nlohmann/json.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>

#include "tests/viewer/support.hpp"

namespace weft::viewer {
namespace {

using testing::HasSubstr;

constexpr double kAspect = 1.6;

bool comes(Session& session, const std::function<bool()>& condition) {
  for (int i = 0; i < 6000; ++i) {
    session.update(0.01);
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

Session session_of(std::vector<std::string> files, bool is_running = false) {
  SessionSettings settings;
  settings.files = std::move(files);
  settings.live.is_running = is_running;
  return Session(std::move(settings));
}

nlohmann::json described(Session& session) {
  return nlohmann::json::parse(session.describe());
}

TEST(LiveSessions, WindAndGravityHaveAKeyForEveryDirection) {
  Session session = session_of({"hang"});
  const struct {
    const char* more;
    const char* less;
    int axis;
  } rows[] = {{"X", "Shift+X", 0}, {"Y", "Shift+Y", 1}, {"Z", "Shift+Z", 2}};
  for (const auto& row : rows) {
    const std::string more(row.more);
    EXPECT_TRUE(session.press(more) && session.press(more) && session.press(row.less));
    EXPECT_EQ(described(session)["wind"][row.axis], 0.5) << more;
    const double before = described(session)["gravity"][row.axis];
    EXPECT_TRUE(session.press("Ctrl+" + more) && session.press("Ctrl+" + more));
    EXPECT_EQ(described(session)["gravity"][row.axis], before + 2.0) << more;
    EXPECT_TRUE(session.press("Ctrl+" + std::string(row.less)));
    EXPECT_EQ(described(session)["gravity"][row.axis], before + 1.0) << more;
  }
  session.update(0.01);
  EXPECT_THAT(session.message(), HasSubstr("gravity (1, -8.81, 1) m/s^2"));
  EXPECT_FALSE(session.press("Ctrl+Alt+X"));
}

TEST(LiveSessions, ClothTypesGoRoundAndRestartAsWrittenGivesThemBack) {
  Session session = session_of({"hang"});
  for (const char* name : {"handkerchief", "cotton", "denim", "paper", "as written"}) {
    (void)session.press("C");
    EXPECT_EQ(described(session)["cloth_type"], name);
  }
  (void)session.press("Shift+C");
  EXPECT_EQ(described(session)["cloth_type"], "paper");
  EXPECT_TRUE(described(session)["laws"].contains("cloth hinge_torsion rigidity"));
  (void)session.press("R");
  EXPECT_EQ(described(session)["cloth_type"], "paper");
  (void)session.press("Shift+R");
  EXPECT_EQ(described(session)["cloth_type"], "as written");
  EXPECT_FALSE(described(session)["laws"].contains("cloth hinge_torsion rigidity"));
}

TEST(LiveSessions, RunsPausesStepsAndLooksBack) {
  Session session = session_of({"hang"});
  ASSERT_TRUE(comes(session, [&] { return session.source().shown() != nullptr; }));
  (void)session.press("Right");
  (void)session.press("Right");
  ASSERT_TRUE(comes(session, [&] { return session.source().shown()->step == 2; }));
  (void)session.press("Left");
  EXPECT_EQ(session.source().shown()->step, 1);
  EXPECT_TRUE(described(session)["looks_back"]);
  (void)session.press("Home");
  EXPECT_EQ(session.source().shown()->step, 0);
  (void)session.press("Right");
  EXPECT_EQ(session.source().shown()->step, 1) << "a kept frame, nothing is simulated";
  (void)session.press("End");
  EXPECT_EQ(session.source().shown()->step, 2);
  (void)session.press("Space");
  ASSERT_TRUE(comes(session, [&] { return session.source().shown()->step > 100; }));
  (void)session.press("Left");
  EXPECT_FALSE(session.source().is_playing()) << "looking back pauses";
  (void)session.press("R");
  EXPECT_TRUE(session.source().is_playing());
}

TEST(LiveSessions, AParameterIsChosenAndChangedByKeys) {
  Session session = session_of({"hang"});
  for (int i = 0; i < 3; ++i) (void)session.press("PageDown");
  (void)session.press("Ctrl+PageUp");
  EXPECT_NEAR(described(session)["laws"]["cloth tension stiffness"], 66.0, 1e-9);
  (void)session.press("Ctrl+PageDown");
  (void)session.press("Ctrl+PageDown");
  EXPECT_NEAR(described(session)["laws"]["cloth tension stiffness"], 60.0 / 1.1, 1e-9);
  (void)session.press("PageUp");
  EXPECT_EQ(session.chosen(), 2u);
  // One that is negative becomes larger towards zero, and one that is zero leaves it.
  (void)session.press("PageUp");
  (void)session.press("Ctrl+PageUp");
  EXPECT_NEAR(described(session)["gravity"][1], -9.81 / 1.1, 1e-9);
  (void)session.press("PageUp");
  (void)session.press("Ctrl+PageDown");
  EXPECT_NEAR(described(session)["gravity"][0], -0.1, 1e-12);
}

TEST(LiveSessions, WindAndPaperDoNotBlowUpLightCloth) {
  Session session = session_of({"drape_sphere"}, true);
  session.source().set_speed(1e6);
  for (int i = 0; i < 4; ++i) (void)session.press("X");
  (void)session.press("Shift+C");
  (void)session.press("R");  // the parts of a step count from the first one on
  ASSERT_TRUE(comes(session, [&] {
    const SnapshotPtr shown = session.source().shown();
    return shown && (shown->state.time > 1.5 || shown->blow_up);
  }));
  EXPECT_FALSE(session.source().shown()->blow_up);
  EXPECT_GT(session.source().shown()->num_parts, 1);
}

TEST(LiveSessions, TheMousePullsAtANode) {
  Session session = session_of({"hang"}, true);
  ASSERT_TRUE(comes(session, [&] {
    const SnapshotPtr shown = session.source().shown();
    return shown && shown->step > 10;
  }));
  const scenes::SceneState& state = session.source().shown()->state;
  const auto place = project(session.view().camera, kAspect, state.cloths[0].positions.col(312));
  session.begin_drag(MouseDrag::kPull, *place, kAspect);
  ASSERT_EQ(session.drag(), MouseDrag::kPull);
  session.drag_to({place->x + 0.1, place->y - 0.3}, kAspect);
  EXPECT_TRUE(comes(session, [&] { return described(session)["largest_pull_N"] > 0.1; }));
  session.end_drag();
  EXPECT_FALSE(session.pull());
  EXPECT_TRUE(comes(session, [&] { return session.source().shown()->pull_force == 0.0; }));
  session.begin_drag(MouseDrag::kPull, {0.01, 0.01}, kAspect);
  EXPECT_EQ(session.drag(), MouseDrag::kNone) << "there is no node";
}

TEST(LiveSessions, TheMouseMovesACollider) {
  for (const std::string& engine : {std::string("reference"), std::string("bullet_forces")}) {
    SessionSettings settings;
    settings.files = {"drape_sphere"};
    settings.live.engine = engine;
    settings.live.is_running = true;
    std::optional<Session> opened;
    try {
      opened.emplace(settings);
    } catch (const InvalidArgument&) {
      continue;  // a build without Bullet
    }
    Session& session = *opened;
    ASSERT_TRUE(comes(session, [&] {
      const SnapshotPtr shown = session.source().shown();
      return shown && shown->step > 10;
    }));
    const auto center = [&] { return session.source().shown()->state.rigids[0].position; };
    const Vector3<double> before = center();
    const auto place = project(session.view().camera, kAspect, before);
    session.begin_drag(MouseDrag::kCarry, *place, kAspect);
    ASSERT_EQ(session.drag(), MouseDrag::kCarry) << session.message();
    session.drag_to({place->x + 0.1, place->y}, kAspect);
    const Vector3<double> target = session.carry()->target;
    EXPECT_GT((target - before).norm(), 0.3);
    EXPECT_TRUE(comes(session, [&] { return (center() - target).norm() < 1e-5; })) << engine;
    session.end_drag();
    EXPECT_FALSE(session.carry());
    const int step = session.source().shown()->step;
    EXPECT_TRUE(comes(session, [&] { return session.source().shown()->step > step + 20; }));
    EXPECT_LT((center() - target).norm(), 1e-5) << "it stays where it was let go";
    session.begin_drag(MouseDrag::kCarry, {0.01, 0.01}, kAspect);
    EXPECT_EQ(session.drag(), MouseDrag::kNone) << "there is no collider";
    EXPECT_THAT(session.message(), HasSubstr("no collider under the mouse"));
  }
}

TEST(LiveSessions, ABallWithAMassIsPulledWithAtMostThreeTimesItsWeight) {
  Session session = session_of({"ball_on_cloth"}, true);
  ASSERT_TRUE(comes(session, [&] { return session.source().shown() != nullptr; }));
  const auto ball = [&] { return session.source().shown()->state.rigids[0]; };
  const double mass = *session.source().drawn_scene().colliders[0].mass;
  const auto place = project(session.view().camera, kAspect, ball().position);
  session.begin_drag(MouseDrag::kCarry, *place, kAspect);
  ASSERT_EQ(session.drag(), MouseDrag::kCarry) << session.message();
  session.drag_to({place->x, place->y - 0.5}, kAspect);
  EXPECT_TRUE(comes(session, [&] { return ball().velocity.y() > 0.05; }));
  EXPECT_NEAR(session.source().shown()->pull_force, 3.0 * 9.81 * mass, 1e-6 * mass);
}

TEST(LiveSessions, ContactsAreShownWhereTheEngineTellsThem) {
  Session session = session_of({"drape_sphere"}, true);
  const auto& engines = session.live()->engines();
  if (std::find(engines.begin(), engines.end(), "bullet_forces") == engines.end()) {
    GTEST_SKIP() << "a build without Bullet";
  }
  session.live()->set_engine("reference");
  session.update(0.01);
  ASSERT_TRUE(comes(session, [&] { return session.source().shown() != nullptr; }));
  (void)session.press("A");
  EXPECT_THAT(session.message(), HasSubstr("reference: does not tell its contacts"));
  EXPECT_TRUE(described(session)["contacts_shown"]);
  for (const char* engine : {"bullet_weft", "bullet_forces"}) {
    session.live()->set_engine(engine);
    session.source().set_speed(1e6);
    ASSERT_TRUE(comes(session, [&] { return described(session).value("touches", 0) > 20; }))
        << engine;
    EXPECT_LE(described(session)["sticking"], described(session)["touches"]);
  }
  (void)session.press("A");
  EXPECT_FALSE(described(session)["contacts_shown"]);
}

TEST(LiveSessions, EnginesGoRound) {
  Session session = session_of({"hang"});
  std::set<std::string> seen;
  const std::size_t count = session.live()->engines().size();
  for (std::size_t i = 0; i < count; ++i) {
    seen.insert(session.live()->engine());
    (void)session.press("E");
  }
  EXPECT_EQ(seen.size(), count);
  EXPECT_EQ(session.live()->engine(), "reference");
}

TEST(LiveSessions, TheListOpensOtherScenes) {
  Session session = session_of({"hang"});
  EXPECT_EQ(session.list().size(), scenes::scene_catalog().size());
  (void)session.press("Down");
  EXPECT_TRUE(session.view().shows_list);
  (void)session.press("Enter");
  EXPECT_EQ(session.title(), session.list()[1]);
  EXPECT_FALSE(session.view().shows_list);
  (void)session.press("Up");
  (void)session.press("Enter");
  EXPECT_EQ(session.title(), "hang");
}

TEST(LiveSessions, ASavedSceneIsReadAgainAndAMistakeIsTold) {
  const std::string path = testing::TempDir() + "weft_viewer_scene.toml";
  std::string text(scenes::find_catalog_scene("hang")->text);
  std::ofstream(path) << text;
  Session session = session_of({path});
  session.update(0.01);
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    std::ofstream(path) << text;
  };
  replace("\"60 N/m\"", "\"75.5 N/m\"");
  ASSERT_TRUE(comes(session,
                    [&] { return described(session)["laws"]["cloth tension stiffness"] == 75.5; }));
  replace("\"75.5 N/m\"", "\"75.5 N\"");
  ASSERT_TRUE(comes(session, [&] { return session.message().find("75.5") != std::string::npos; }));
  EXPECT_THAT(session.message(), HasSubstr(path + ":"));
  EXPECT_EQ(described(session)["laws"]["cloth tension stiffness"], 75.5);
}

TEST(RecordedSessions, PlayScrubAndLoop) {
  Session session = session_of({write_recording("play", 1.0, 11).string()});
  EXPECT_FALSE(session.source().is_playing());
  (void)session.press("Space");
  session.update(0.5);
  EXPECT_EQ(session.source().frame(), 5);
  (void)session.press("]");
  EXPECT_EQ(session.source().speed(), 2.0);
  session.update(0.2);
  EXPECT_EQ(session.source().frame(), 9);
  session.update(0.2);
  EXPECT_EQ(session.source().frame(), 0) << "starts again";
  (void)session.press("L");
  session.update(2.0);
  EXPECT_EQ(session.source().frame(), 10) << "stops";
  EXPECT_FALSE(session.source().is_playing());
  (void)session.press("Left");
  EXPECT_EQ(session.source().frame(), 9);
  (void)session.press("Home");
  (void)session.press("Right");
  EXPECT_EQ(session.source().frame(), 1);
  (void)session.press("[");
  (void)session.press("[");
  EXPECT_EQ(session.source().speed(), 0.5);
  session.source().seek(7);
  EXPECT_NEAR(session.source().shown()->state.time, 0.7, 1e-12);
}

TEST(RecordedSessions, ARecordingThatIsWrittenIsFollowedToItsEnd) {
  const std::filesystem::path whole = testing::TempDir() + "weft_viewer_grows.weftrec";
  const std::filesystem::path partial = testing::TempDir() + "weft_viewer_grows.partial.weftrec";
  std::filesystem::remove(whole);
  FallingSheet sheet(partial, 1.0, 200);
  sheet.add_frames(70);
  const int first = sheet.num_committed();
  ASSERT_GT(first, 0);
  Session session = session_of({partial.string()});
  session.update(0.01);
  EXPECT_THAT(session.message(), HasSubstr("new frames are shown as they come"));
  EXPECT_EQ(session.source().num_frames(), first);
  (void)session.press("End");
  sheet.add_frames(70);
  const int second = sheet.num_committed();
  ASSERT_GT(second, first);
  EXPECT_TRUE(comes(session, [&] { return session.source().frame() == second - 1; }));
  EXPECT_NEAR(session.source().shown()->state.time, 0.1 * (second - 1), 1e-12);
  // One who looks at an earlier frame keeps looking at it; one who plays waits at the end and goes on.
  (void)session.press("Home");
  sheet.add_frames(64);
  EXPECT_TRUE(comes(session, [&] { return session.source().num_frames() > second; }));
  EXPECT_EQ(session.source().frame(), 0);
  session.source().seek(session.source().num_frames() - 2);
  (void)session.press("Space");
  session.update(5.0);
  EXPECT_TRUE(session.source().is_playing());
  sheet.finish();
  std::filesystem::rename(partial, whole);
  EXPECT_TRUE(comes(session, [&] { return session.source().num_frames() == 204; }));
  EXPECT_FALSE(described(session)["may_grow"]);
  EXPECT_EQ(described(session)["solid"], whole.filename().string());
  EXPECT_THAT(session.message(), HasSubstr("is whole now"));
  EXPECT_TRUE(comes(session, [&] { return session.source().frame() >= 200; }));
}

TEST(RecordedSessions, GhostsAndTheSolidOneHaveKeys) {
  Session session =
      session_of({write_recording("ga", 1.0, 5).string(), write_recording("gb", 2.0, 5).string()});
  EXPECT_TRUE(session.source().ghosts());
  const auto names = session.source().recordings();
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].name, "weft_viewer_ga.weftrec");
  EXPECT_FALSE(names[0].color);
  EXPECT_TRUE(names[1].color);
  const int version = session.source().version();
  (void)session.press("G");
  EXPECT_FALSE(session.source().ghosts());
  EXPECT_GT(session.source().version(), version);
  (void)session.press("Shift+G");
  EXPECT_EQ(described(session)["solid"], "weft_viewer_gb.weftrec");
}

TEST(RecordedSessions, WhatIsForScenesIsTold) {
  Session session = session_of({write_recording("told", 1.0, 5).string()});
  (void)session.press("X");
  EXPECT_THAT(session.message(), HasSubstr("is for scenes"));
  (void)session.press("PageDown");
  EXPECT_THAT(session.message(), HasSubstr("expected a scene"));
  session.begin_drag(MouseDrag::kPull, {0.5, 0.5}, kAspect);
  EXPECT_THAT(session.message(), HasSubstr("cannot be pulled"));
  (void)session.press("A");
  EXPECT_THAT(session.message(), HasSubstr("a recording has no contacts"));
}

TEST(Sessions, EveryActionDoesSomethingThatIsSeen) {
  for (const bool is_live : {true, false}) {
    Session session =
        is_live ? session_of({"hang"}) : session_of({write_recording("all", 1.0, 5).string()});
    for (const ActionInfo& info : action_table()) {
      EXPECT_NO_THROW(session.perform(info.action)) << info.id;
      session.update(0.001);
    }
    EXPECT_TRUE(session.view().wants_to_quit);
  }
}

TEST(Sessions, FilesThatCannotBeShownAreNamed) {
  EXPECT_THAT(
      [] {
        session_of({"hang", "a.weftrec"});
      },
      testing::ThrowsMessage<Error>(HasSubstr("expected scenes alone")));
  EXPECT_THAT([] { session_of({"hnag"}); }, testing::ThrowsMessage<Error>(HasSubstr("'hnag'")));
  EXPECT_THAT([] { session_of({"missing.weftrec"}); },
              testing::ThrowsMessage<Error>(HasSubstr("missing.weftrec")));
}

}  // namespace
}  // namespace weft::viewer
