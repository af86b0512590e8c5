#pragma once

#include <filesystem>

namespace weft::output {

/// The right to write one output, held by one process at a time: an advisory lock (flock) on a small
/// file that tells who holds it. It ends with the process, however that ends.
class OutputLock {
 public:
  enum class AtEnd { kRemove, kKeep };  ///< what becomes of the file

  /// file: made if it is not there. output: what it stands for, for messages.
  /// @throws Error if another process (or this one) holds it, if something else has that name, or if
  /// the file cannot be made.
  OutputLock(std::filesystem::path file, const std::filesystem::path& output, AtEnd at_end);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::filesystem::path file_;
  AtEnd at_end_;
  int descriptor_ = -1;
};

}  // namespace weft::output
