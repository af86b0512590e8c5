#pragma once

// Tested by tests/scenes/recording/round_trip_test.cpp, tests/scenes/recording/damage_test.cpp.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace weft::scenes {

/// Name of the codec below, as in the column chunk.codec.
inline constexpr std::string_view kCodecName = "shuffle+zstd";

/// Compresses scalars of scalar_bytes bytes each: bytes of equal significance side by side, then
/// zstd.
[[nodiscard]] std::vector<std::byte> compress_chunk(std::span<const std::byte> raw,
                                                    std::size_t scalar_bytes);
/// The inverse. Throws Error if data is not raw_bytes compressed bytes.
[[nodiscard]] std::vector<std::byte> decompress_chunk(std::span<const std::byte> data,
                                                      std::size_t raw_bytes,
                                                      std::size_t scalar_bytes);

}  // namespace weft::scenes
