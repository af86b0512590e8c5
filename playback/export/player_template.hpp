#pragma once

// Tested by tests/playback/export/player_page_test.cpp.

#include <string_view>

namespace weft::scenes {

/// The playback page without a recording: the bytes of web/dist/player.html.
[[nodiscard]] std::string_view player_template();

}  // namespace weft::scenes
