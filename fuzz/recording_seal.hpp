#pragma once

#include <filesystem>

namespace weft::fuzz {

/// Makes the hashes of a changed recording right again, as far as its tables can be read: hashes
/// guard against accidents, and whoever forges a recording computes them too.
void seal_recording(const std::filesystem::path& path);

}  // namespace weft::fuzz
