#include <weft/scenes/output/output_folder.hpp>

#include <unistd.h>

#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/output/output_file.hpp>

namespace weft::output {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

/// Makes one folder; what is there must be one and not a link to one.
void make_one_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directory(path, error);
  const fs::file_status status = fs::symlink_status(path);
  if (fs::is_directory(status)) return;
  if (fs::is_symlink(status))
    throw Error(path.string() + ": is a symbolic link, expected a folder");
  if (fs::exists(status)) throw Error(path.string() + ": is not a folder");
  fail(path, error.message());
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, std::string_view token, const FileKind& kind)
    : path_(std::move(path)) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "report/"
  std::error_code error;
  if (path_.has_parent_path()) fs::create_directories(path_.parent_path(), error);
  if (error) fail(path_, error.message());
  make_one_folder(path_);
  const bool is_empty = fs::is_empty(path_, error);
  if (error) fail(path_, error.message());
  const bool is_ours = fs::is_regular_file(fs::symlink_status(path_ / kFolderMark)) ||
                       is_of_kind(path_ / token, kind);
  if (!is_empty && !is_ours) {
    throw Error(
        fmt::format("{}: holds other files and no {} made by Weft, expected a new or empty "
                    "folder, or that of an earlier run",
                    path_.string(), (path_ / token).string()));
  }
  lock_.emplace(path_ / kFolderMark, path_, OutputLock::AtEnd::kKeep);
}

fs::path OutputFolder::make_folder(const fs::path& relative) const {
  fs::path folder = path_;
  for (const fs::path& part : relative) {
    folder /= part;
    make_one_folder(folder);
  }
  return folder;
}

void OutputFolder::write(const fs::path& relative, std::string_view bytes) const {
  make_folder(relative.parent_path());
  replace_file(path_ / relative, bytes);
}

void replace_file(const fs::path& path, std::string_view bytes) {
  const fs::file_status status = fs::symlink_status(path);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(path.string() + ": is not a plain file, expected a new name or an earlier output");
  }
  const fs::path temporary = write_beside(path, bytes);
  std::error_code error;
  fs::rename(temporary, path, error);
  if (!error) return;
  unlink(temporary.c_str());
  fail(path, error.message());
}

}  // namespace weft::output
