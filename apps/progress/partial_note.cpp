#include "apps/progress/partial_note.hpp"

#include "apps/terminal.hpp"

namespace weft::app {

void note_if_partial(const scenes::RecordingReader& reader, const std::string& file) {
  if (reader.finished()) return;
  const int frames = reader.num_frames();
  const std::string reached =
      frames > 0 ? fmt::format(", t = {:.6g} s", reader.frame_time(frames - 1)) : "";
  print(stderr,
        "weft: {}: a partial recording, {} frames{}; its run has not ended or was stopped\n", file,
        frames, reached);
}

}  // namespace weft::app
