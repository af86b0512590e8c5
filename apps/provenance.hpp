#pragma once

#include <string>
#include <string_view>

#include <weft/scenes/recording/recording.hpp>

namespace weft::app {

/// What made this program: version, source revision, compiler, flags, libraries, processor.
[[nodiscard]] scenes::Provenance build_provenance();

}  // namespace weft::app
