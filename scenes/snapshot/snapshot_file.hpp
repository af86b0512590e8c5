#pragma once

// Tested by tests/scenes/snapshot/snapshot_file_test.cpp.

#include <filesystem>
#include <string>
#include <string_view>

#include <weft/scenes/output/file_kind.hpp>
#include <weft/scenes/snapshot/snapshot.hpp>

namespace weft::scenes {

/// A snapshot in a file: a line "weft-snapshot/1", a line with the XXH3-128 of all that follows, and the snapshot as
/// StateArchive writes it, little-endian. The same snapshot gives the same bytes.
[[nodiscard]] std::string snapshot_bytes(const Snapshot& snapshot);

/// Throws InvalidArgument that names the file for one that is none, is of another version, or was damaged or cut.
[[nodiscard]] Snapshot read_snapshot_file(const std::filesystem::path& path);

[[nodiscard]] bool begins_as_snapshot(std::string_view beginning);
inline constexpr output::FileKind kSnapshotKind{"a snapshot", begins_as_snapshot};

}  // namespace weft::scenes
