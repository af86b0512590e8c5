#pragma once

#include <string>
#include <vector>

#include <weft/scenes/output/file_kind.hpp>

namespace weft::scenes {

/// A recording inside a playback page.
struct PageRecording {
  std::string name;         ///< shown, as "drape.weftrec"
  std::string copy;         ///< bytes of playback_copy()
  std::string poster_jpeg;  ///< shown where there is no WebGL or no script
  std::string poster_text;  ///< what the poster shows
};

/// The playback page with these recordings inside; without any it is the player, into which recordings are dropped.
[[nodiscard]] std::string player_page(const std::vector<PageRecording>& recordings);

/// A page that player_page() made.
extern const output::FileKind kPlayerPageKind;

}  // namespace weft::scenes
