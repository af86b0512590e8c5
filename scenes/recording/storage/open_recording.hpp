#pragma once

// Tested by tests/scenes/recording/damage_test.cpp.

#include <filesystem>

#include <weft/scenes/recording/codec/topologies.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::scenes {

/// Opens a recording of this format for reading, whatever its state: finished, being written, left
/// behind by a crash, in a folder that nobody may write to. Never changes it. Throws Error: no such
/// file, empty, truncated, not a recording, of a newer version.
[[nodiscard]] Database open_recording(const std::filesystem::path& path);

/// What a reader has to know of all chunks.
struct RecordingIndex {
  std::vector<ChunkEntry> chunks;
  std::vector<double> times;          ///< [s] of every frame
  std::vector<std::size_t> chunk_of;  ///< position in chunks of every frame's chunk
  std::vector<std::size_t> offsets;   ///< of every frame in the decoded bytes of its chunk
};

/// A text of table meta. Throws Error that names the file if it is not there.
[[nodiscard]] const std::string& meta_value(const Header& header, const std::string& key,
                                            const std::string& file);
/// Reads and verifies the small tables. Throws Error.
[[nodiscard]] Header read_header(const Database& database, const std::string& file);
/// Reads and verifies tables chunk and frame. Throws Error.
[[nodiscard]] RecordingIndex read_index(const Database& database, const Header& header,
                                        const Topologies& layout, const std::string& file);

}  // namespace weft::scenes
