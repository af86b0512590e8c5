// This file keeps the promises of regular_file.hpp by the functions of Windows.
// Tested by tests/core/input_file_test.cpp.
#include <algorithm>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include <weft/core/error.hpp>
#include <weft/core/regular_file.hpp>

namespace weft {
namespace {

constexpr DWORD kLetOthersUseIt = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
/// Folders are opened too, so that they can be named as such. The server of a pipe may not act in the name of the caller.
constexpr DWORD kFlags = FILE_FLAG_BACKUP_SEMANTICS | SECURITY_SQOS_PRESENT | SECURITY_ANONYMOUS;

std::error_code last_error() {
  return {static_cast<int>(GetLastError()), std::system_category()};
}

HANDLE handle_of(std::intptr_t number) {
  return reinterpret_cast<HANDLE>(number);
}

[[noreturn]] void fail_read() {
  throw InvalidArgument("cannot be read: " + last_error().message());
}

HANDLE open_for_reading(const std::filesystem::path& path) {
  const HANDLE handle = CreateFileW(path.c_str(), GENERIC_READ, kLetOthersUseIt, nullptr,
                                    OPEN_EXISTING, kFlags, nullptr);
  if (handle != INVALID_HANDLE_VALUE) return handle;
  const std::error_code error = last_error();
  if (error.value() == ERROR_FILE_NOT_FOUND || error.value() == ERROR_PATH_NOT_FOUND ||
      error.value() == ERROR_INVALID_NAME) {
    throw InvalidArgument("no such file");
  }
  throw InvalidArgument("cannot be opened: " + error.message());
}

/// [bytes]
std::uintmax_t regular_size(HANDLE handle) {
  if (GetFileType(handle) != FILE_TYPE_DISK) {
    throw InvalidArgument("is a pipe, a socket or a device, expected a regular file");
  }
  BY_HANDLE_FILE_INFORMATION status{};
  if (!GetFileInformationByHandle(handle, &status)) fail_read();
  if ((status.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0) {
    throw InvalidArgument("is a directory, expected a file");
  }
  return (std::uintmax_t{status.nFileSizeHigh} << 32U) + status.nFileSizeLow;
}

/// Where an open file is, whatever links have led there; empty, with an error, if the system does not say.
std::filesystem::path path_of(HANDLE handle, std::error_code& error) {
  std::wstring path(MAX_PATH, L'\0');
  while (true) {
    // The length without the zero at the end if the path fits, with it if not.
    const DWORD size =
        GetFinalPathNameByHandleW(handle, path.data(), static_cast<DWORD>(path.size()), 0);
    if (size == 0) error = last_error();
    const bool fits = size < path.size();
    path.resize(size);
    if (fits) return path;
  }
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& path, Links links)
    : handle_(reinterpret_cast<std::intptr_t>(open_for_reading(path))) {
  try {
    size_ = regular_size(handle_of(handle_));
    std::error_code error;
    if (links == Links::kRefuse && path_of(handle_of(handle_), error) != path) {
      throw InvalidArgument("cannot be opened: has become a link");
    }
  } catch (...) {
    CloseHandle(handle_of(handle_));
    throw;
  }
}

RegularFile::~RegularFile() {
  CloseHandle(handle_of(handle_));
}

bool RegularFile::read_more(std::size_t size, std::string& bytes) const {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + size);
  DWORD count = 0;
  const auto most = static_cast<DWORD>(std::min<std::size_t>(size, std::size_t{1} << 30U));
  if (!ReadFile(handle_of(handle_), bytes.data() + begin, most, &count, nullptr)) fail_read();
  bytes.resize(begin + count);
  return count > 0;
}

// Not std::filesystem::canonical(), which takes links for folders and files where the standard library is GCC's.
std::filesystem::path real_path(const std::filesystem::path& path, std::error_code& error) {
  const HANDLE handle = CreateFileW(path.c_str(), FILE_READ_ATTRIBUTES, kLetOthersUseIt, nullptr,
                                    OPEN_EXISTING, kFlags, nullptr);
  if (handle == INVALID_HANDLE_VALUE) {
    error = last_error();
    return {};
  }
  error.clear();
  std::filesystem::path found = path_of(handle, error);
  CloseHandle(handle);
  return found;
}

}  // namespace weft
