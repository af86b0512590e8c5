#include <weft/scenes/recording/recording_output.hpp>

#include <array>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::scenes {
namespace {

namespace fs = std::filesystem;

/// Files that SQLite keeps beside a database while it is open, and after a crash.
constexpr std::array<const char*, 3> kCompanions = {"-wal", "-shm", "-journal"};

/// SQLite file format, section 1.3: magic text, and application_id at byte 68, most significant byte
/// first.
bool begins_as_recording(std::string_view beginning) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  constexpr std::size_t kIdPlace = 68;
  if (!beginning.starts_with(kMagic) || beginning.size() < kIdPlace + 4) return false;
  std::int64_t id = 0;
  for (const char byte : beginning.substr(kIdPlace, 4)) {
    id = id << 8 | static_cast<unsigned char>(byte);
  }
  return id == kApplicationId;
}

fs::path companion(const fs::path& path, const char* suffix) {
  return path.string() + suffix;
}

void remove_companions(const fs::path& path) {
  std::error_code ignored;
  for (const char* suffix : kCompanions) fs::remove(companion(path, suffix), ignored);
}

bool is_there(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::none) {
    throw Error(fmt::format("{}: cannot be looked at: {}", path.string(), error.message()));
  }
  return fs::exists(status);
}

bool has_companion(const fs::path& path) {
  for (const char* suffix : kCompanions) {
    if (is_there(companion(path, suffix))) return true;
  }
  return false;
}

fs::path partial_name(const fs::path& path, int number) {
  const fs::path name =
      path.parent_path() / (path.stem().string() + ".partial" + path.extension().string());
  return number == 1 ? name : output::numbered(name, number);
}

}  // namespace

const output::FileKind kRecordingKind{"a recording", begins_as_recording, true};

RecordingOutput::RecordingOutput(const fs::path& path, bool force)
    : file_(path, kRecordingKind, force),
      lock_(path.string() + ".lock", path, output::OutputLock::AtEnd::kRemove) {
  // Again, for the run that held the lock until now may have finished since the first look.
  file_ = output::OutputFile(path, kRecordingKind, force);
  if (!file_.replaces() && has_companion(path)) {
    throw InvalidArgument(
        fmt::format("{0}: is not there, but a file {0}-wal, -shm or -journal that belongs to a "
                    "recording of this "
                    "name is, expected a new name",
                    path.string()));
  }
  for (int number = 1;; ++number) {
    partial_ = partial_name(path, number);
    if (!is_there(partial_) && !has_companion(partial_)) return;
    if (is_there(partial_)) earlier_.push_back(partial_);
  }
}

void RecordingOutput::publish() const {
  std::error_code none;
  const std::uintmax_t log = fs::file_size(companion(partial_, "-wal"), none);
  if (!none && log > 0) {
    throw Error(
        fmt::format("{}: the run is complete, but another program has its recording open; it "
                    "stays in {} and the -wal file beside it",
                    path().string(), partial_.string()));
  }
  remove_companions(partial_);
  // SQLite would take the log of the recording that goes for one of that which comes.
  if (file_.replaces()) remove_companions(path());
  try {
    file_.publish(partial_);
  } catch (const Error& error) {
    if (!is_there(partial_)) throw;  // it has got another name, and the message says which
    throw Error(
        fmt::format("{}; the recording is complete in {}", error.what(), partial_.string()));
  }
}

void RecordingOutput::discard() const {
  std::error_code ignored;
  fs::remove(partial_, ignored);
  remove_companions(partial_);
}

}  // namespace weft::scenes
