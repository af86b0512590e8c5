#pragma once

#include <filesystem>
#include <vector>

#include <weft/scenes/output/output_file.hpp>
#include <weft/scenes/output/output_lock.hpp>

namespace weft::scenes {

/// A recording, finished or partial, told by SQLite's and Weft's numbers at its beginning.
extern const output::FileKind kRecordingKind;

/// Where the recording of one run goes. Its frames are written to a partial recording beside it,
/// "x.partial.weftrec" (or "x.partial-2.weftrec" if there is one already), which gets the name
/// "x.weftrec" when it is whole. A run that ends early leaves the partial recording, and no other
/// run removes it. While this object lives no other run can have the same output.
class RecordingOutput {
 public:
  /// force: a recording that is there may be replaced at the end; until then it stays as it is.
  /// @throws Error or InvalidArgument if the output cannot be had; see OutputFile and OutputLock.
  RecordingOutput(const std::filesystem::path& path, bool force);

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }
  /// Not there yet: for a RecordingWriter.
  [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }
  /// Partial recordings that earlier runs with this output left.
  [[nodiscard]] const std::vector<std::filesystem::path>& earlier() const { return earlier_; }

  /// Gives the finished recording its name. The writer must be gone.
  /// @throws Error that tells where the recording is if it cannot have its name.
  void publish() const;
  /// Removes this run's partial recording, which has no frame that is not elsewhere too. The writer
  /// must be gone.
  void discard() const;

 private:
  output::OutputFile file_;
  output::OutputLock lock_;
  std::filesystem::path partial_;
  std::vector<std::filesystem::path> earlier_;
};

}  // namespace weft::scenes
