#include <weft/viewer/model/frames/file_watch.hpp>

#include <system_error>
#include <utility>

namespace weft::viewer {

FileWatch::FileWatch(std::filesystem::path path) : path_(std::move(path)), known_(stamp()) {
  last_ = known_;
}

std::optional<FileWatch::Stamp> FileWatch::stamp() const {
  if (path_.empty()) return std::nullopt;
  std::error_code error;
  Stamp stamp;
  stamp.time = std::filesystem::last_write_time(path_, error);
  if (error) return std::nullopt;
  stamp.size = std::filesystem::file_size(path_, error);
  if (error) return std::nullopt;
  return stamp;
}

bool FileWatch::was_saved() {
  const std::optional<Stamp> now = stamp();
  const bool keeps_still = now == last_;
  last_ = now;
  if (!now || now == known_ || !keeps_still) return false;
  known_ = now;
  return true;
}

}  // namespace weft::viewer
