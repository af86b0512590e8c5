#include <fcntl.h>
#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include <gtest/gtest.h>

#include <weft/scenes/recording/recording.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

using samples::make_scene;
using samples::make_state;
using samples::same_bits;
using samples::TemporaryFolder;

constexpr auto kCrashPrecision = StoredPrecision::kFloat64;
constexpr int kChunkFrames = 8;

/// A process that writes frames without end, and tells the number of committed frames through a
/// pipe.
class WritingProcess {
 public:
  explicit WritingProcess(const std::filesystem::path& path, useconds_t pause = 0) : pause_(pause) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
      throw Error("no pipe");
    }
    child_ = ::fork();
    if (child_ == 0) {
      write_for_ever(path, ends[1]);
    }
    ::close(ends[1]);
    pipe_ = ends[0];
  }
  ~WritingProcess() {
    kill();
    ::close(pipe_);
  }
  WritingProcess(const WritingProcess&) = delete;
  WritingProcess& operator=(const WritingProcess&) = delete;

  /// Waits until so many frames are committed.
  void wait_for(int num_frames) {
    int committed = 0;
    while (committed < num_frames) {
      ASSERT_EQ(::read(pipe_, &committed, sizeof committed),
                static_cast<ssize_t>(sizeof committed));
    }
  }
  void kill() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
      child_ = 0;
    }
  }

 private:
  [[noreturn]] void write_for_ever(const std::filesystem::path& path, int pipe) const {
    const Scene scene = make_scene(12);
    RecordingWriter writer(path, scene, {}, kCrashPrecision, {.frames = kChunkFrames});
    for (int i = 0;; ++i) {
      const SceneState state = make_state(scene, i, kCrashPrecision);
      writer.add_frame(state);
      writer.add_metric("height_m", state.time, i);
      const int committed = (i + 1) / kChunkFrames * kChunkFrames;
      if (committed == i + 1 && ::write(pipe, &committed, sizeof committed) < 0) {
        ::_exit(1);
      }
      ::usleep(pause_);
    }
  }

  useconds_t pause_;  ///< [us] between frames
  pid_t child_ = 0;
  int pipe_ = 0;
};

/// What there is must be a consistent prefix with at least so many frames.
void expect_prefix(const std::filesystem::path& path, int min_frames) {
  const Scene scene = make_scene(12);
  const RecordingReader reader(path);
  EXPECT_FALSE(reader.finished());
  EXPECT_GE(reader.num_frames(), min_frames);
  for (int i = 0; i < reader.num_frames(); ++i) {
    ASSERT_TRUE(same_bits(reader.frame(i), make_state(scene, i, kCrashPrecision))) << i;
  }
  EXPECT_EQ(reader.content_hash().size(), 32U);
  const auto metric = reader.metric("height_m");
  for (std::size_t i = 0; i < metric.size(); ++i) {
    ASSERT_EQ(metric[i].value, static_cast<double>(i));
  }
}

TEST(Crash, KeepsEveryCommittedFrame) {
  const TemporaryFolder folder;
  // The later ones are beyond SQLite's first checkpoints (at 4 MB of log): 1.7 kB x 8 per frame.
  for (const int num_frames :
       {kChunkFrames, 5 * kChunkFrames, 40 * kChunkFrames, 100 * kChunkFrames}) {
    const auto path = folder / std::to_string(num_frames);
    WritingProcess process(path);
    process.wait_for(num_frames);
    process.kill();
    expect_prefix(path, num_frames);
  }
}

/// The killed process's folder with no write permission. As root permissions mean nothing: become
/// nobody.
class ReadOnlyFolder {
 public:
  explicit ReadOnlyFolder(const std::filesystem::path& path)
      : path_(path), was_root_(::geteuid() == 0) {
    namespace fs = std::filesystem;
    fs::permissions(path_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                               fs::perms::group_exec | fs::perms::others_read |
                               fs::perms::others_exec);
    constexpr uid_t kNobody = 65534;
    if (was_root_ && ::seteuid(kNobody) != 0) {
      throw Error("cannot become nobody");
    }
  }
  ~ReadOnlyFolder() {
    if (was_root_ && ::seteuid(0) != 0) {
      std::abort();
    }
    std::filesystem::permissions(path_, std::filesystem::perms::all);
  }
  ReadOnlyFolder(const ReadOnlyFolder&) = delete;
  ReadOnlyFolder& operator=(const ReadOnlyFolder&) = delete;

 private:
  std::filesystem::path path_;
  bool was_root_;
};

TEST(ReadOnlyFolder, OfACrashedRecordingLosesNothing) {
  const TemporaryFolder folder;
  const auto path = folder / "a.weftrec";
  const auto log = folder / "a.weftrec-wal";
  WritingProcess process(path);
  process.wait_for(5 * kChunkFrames);
  process.kill();
  const auto log_size = std::filesystem::file_size(log);
  for (const bool with_shared_memory : {true, false}) {
    if (!with_shared_memory) {
      std::filesystem::remove(folder / "a.weftrec-shm");  // as after copying the file and its log
    }
    const ReadOnlyFolder read_only(folder.path());
    expect_prefix(path, 5 * kChunkFrames);
    EXPECT_EQ(std::filesystem::file_size(log), log_size);
  }
}

TEST(ReadOnlyFolder, OfAFinishedOrUnfinishedRecordingIsReadable) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  samples::write_sample(folder / "finished", scene, kCrashPrecision, 3);
  {
    RecordingWriter writer(folder / "unfinished", scene, {}, kCrashPrecision);
    writer.add_frame(make_state(scene, 0, kCrashPrecision));
  }
  const ReadOnlyFolder read_only(folder.path());
  EXPECT_EQ(RecordingReader(folder / "finished").frame(2).cloths.size(), 2U);
  EXPECT_TRUE(same_bits(RecordingReader(folder / "unfinished").frame(0),
                        make_state(scene, 0, kCrashPrecision)));
  EXPECT_THROW(RecordingWriter(folder / "new", scene, {}, kCrashPrecision), Error);
}

TEST(ReadOnlyFolder, ThatCannotBeEnteredIsAnError) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "closed");
  samples::write_sample(folder / "closed/a", make_scene(), kCrashPrecision, 1);
  std::filesystem::permissions(folder / "closed", std::filesystem::perms::none);
  {
    const ReadOnlyFolder read_only(folder.path());
    EXPECT_THROW(RecordingReader(folder / "closed/a"), Error);
  }
  std::filesystem::permissions(folder / "closed", std::filesystem::perms::all);
}

TEST(Reader, SeesAGrowingRecordingOfAnotherProcess) {
  const TemporaryFolder folder;
  const auto path = folder / "a.weftrec";
  WritingProcess process(path, 2000);  // 500 frames per second
  process.wait_for(kChunkFrames);
  int last = 0;
  constexpr int kLooks = 20;
  for (int look = 1; look <= kLooks; ++look) {
    process.wait_for(look * kChunkFrames);
    expect_prefix(path, std::max(last, look * kChunkFrames));
    last = RecordingReader(path).num_frames();
  }
}

TEST(Reader, DoesNotKeepTheWriterFromFinishing) {
  const TemporaryFolder folder;
  const Scene scene = make_scene();
  const auto path = folder / "a.weftrec";
  RecordingWriter writer(path, scene, {}, kCrashPrecision, {.frames = 1});
  writer.add_frame(make_state(scene, 0, kCrashPrecision));
  const RecordingReader reader(path);
  EXPECT_EQ(reader.num_frames(), 1);
  writer.add_frame(make_state(scene, 1, kCrashPrecision));
  writer.finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "a.weftrec-wal"));
  EXPECT_TRUE(same_bits(reader.frame(0), make_state(scene, 0, kCrashPrecision)));
  EXPECT_EQ(reader.num_frames(), 1);  // what was there when it was opened
  EXPECT_EQ(RecordingReader(path).num_frames(), 2);
}

}  // namespace
}  // namespace weft::scenes
