#include <weft/validation/run/engine_runs.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>

namespace weft::validation {
namespace {

/// A stand-in for the weft command that does what its scene's label asks for.
class EngineRunsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("weft_engine_runs_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream script(folder_ / "fake_weft");
    script << "#!/bin/sh\n"
              "echo \"$@\"\n"
              "case \"$2\" in\n"
              "  *crashes*) kill -SEGV $$ ;;\n"
              "  *explodes*) exit 1 ;;\n"
              "  *refused*) exit 2 ;;\n"
              "  *waits*) echo $$ >\"$(dirname \"$0\")/waiting\"; sleep 60 ;;\n"
              "esac\n";
    script.close();
    std::filesystem::permissions(folder_ / "fake_weft", std::filesystem::perms::owner_all);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] EngineRuns runs(int jobs) const {
    return {folder_ / "fake_weft", folder_ / "runs", jobs};
  }
  [[nodiscard]] static RunRequest request(const std::string& label) {
    return {label, scenes::load_scene("hang"), "reference"};
  }

  std::filesystem::path folder_;
};

TEST_F(EngineRunsTest, EveryWayToEndIsAResult) {
  EngineRuns all = runs(2);
  for (const char* label : {"works", "crashes", "explodes", "refused"}) all.add(request(label));
  all.run_all([](double, const std::string&) {});
  EXPECT_EQ(all.outcome("works").exit_code, 0);
  EXPECT_EQ(all.outcome("explodes").exit_code, 1);
  EXPECT_EQ(all.outcome("refused").exit_code, 2);
  EXPECT_EQ(all.outcome("crashes").exit_code, 128 + SIGSEGV);
}

TEST_F(EngineRunsTest, ARecordingIsARunThatNobodyStarts) {
  EngineRuns all = runs(2);
  all.add_recording("theirs", folder_ / "theirs.weftrec");
  all.add(request("works"));
  std::vector<double> fractions;
  all.run_all([&](double fraction, const std::string&) { fractions.push_back(fraction); });
  EXPECT_EQ(fractions, std::vector<double>{1.0}) << "it is no part of the work";
  EXPECT_EQ(all.outcome("theirs").exit_code, 0);
  EXPECT_EQ(all.outcome("theirs").recording, folder_ / "theirs.weftrec");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "runs" / "theirs.log"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "runs" / "works.log"));
}

TEST_F(EngineRunsTest, TheCommandGetsSceneEngineAndPrecision) {
  EngineRuns all = runs(1);
  RunRequest wanted = request("works");
  wanted.engine = "bullet_forces";
  wanted.precision = scenes::StoredPrecision::kFloat32;
  wanted.threads = 3;
  all.add(wanted);
  all.run_all([](double, const std::string&) {});
  const std::string& log = all.outcome("works").log;
  EXPECT_NE(log.find("--engine bullet_forces --precision float32"), std::string::npos) << log;
  EXPECT_NE(log.find("--threads 3"), std::string::npos) << log;
}

TEST_F(EngineRunsTest, ProgressEndsAtOneAndRunsAreNotRepeated) {
  EngineRuns all = runs(3);
  for (int i = 0; i < 5; ++i) all.add(request("works" + std::to_string(i)));
  all.add(request("works0"));
  int calls = 0;
  double last = 0;
  const auto count = [&](double fraction, const std::string&) {
    ++calls;
    EXPECT_GT(fraction, last);
    last = fraction;
  };
  all.run_all(count);
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(last, 1.0);
  all.run_all(count);
  EXPECT_EQ(calls, 5);
}

/// Until condition holds, or ten seconds have passed.
bool wait_until(const std::function<bool()>& condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) usleep(10000);
  return condition();
}

TEST_F(EngineRunsTest, RunsEndWithAProcessThatIsKilled) {
  const pid_t parent = fork();
  if (parent == 0) {
    EngineRuns all = runs(1);
    all.add(request("waits"));
    all.run_all([](double, const std::string&) {});
    _exit(0);
  }
  pid_t run = 0;
  EXPECT_TRUE(wait_until([&] { return bool(std::ifstream(folder_ / "waiting") >> run); }));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  ASSERT_GT(run, 0);
  // Whoever inherits the orphan may be slow to collect it; a zombie has ended.
  EXPECT_TRUE(wait_until([&] {
    std::string number, name, state;
    std::ifstream status("/proc/" + std::to_string(run) + "/stat");
    return !(status >> number >> name >> state) || state == "Z" || state == "X";
  }));
}

TEST_F(EngineRunsTest, UnknownLabelAndMissingProgramAreErrors) {
  EngineRuns all = runs(1);
  EXPECT_THROW((void)all.outcome("works"), InvalidArgument);
  EngineRuns none(folder_ / "no_such_program", folder_ / "runs", 1);
  none.add(request("works"));
  EXPECT_THROW(none.run_all([](double, const std::string&) {}), Error);
}

}  // namespace
}  // namespace weft::validation
