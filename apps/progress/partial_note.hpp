#pragma once

#include <string>

#include <weft/scenes/recording/recording.hpp>

namespace weft::app {

/// Says on standard error that a recording is not the whole of its run, if so.
void note_if_partial(const scenes::RecordingReader& reader, const std::string& file);

}  // namespace weft::app
