#pragma once

#include <string_view>

namespace weft::scenes {

/// The playback page without a recording: the bytes of web/dist/player.html.
[[nodiscard]] std::string_view player_template();

}  // namespace weft::scenes
