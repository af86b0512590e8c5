#pragma once

// Tested by tests/scenes/recording/round_trip_test.cpp, tests/scenes/recording/content_hash_test.cpp.

#include <concepts>
#include <cstddef>

namespace weft::scenes {

/// Recordings are little-endian on every machine. Compilers turn these loops into one move.
template <std::unsigned_integral Bits>
void store_little_endian(Bits bits, std::byte* to) {
  for (std::size_t i = 0; i < sizeof bits; ++i) {
    to[i] = static_cast<std::byte>(bits >> (8 * i));
  }
}

template <std::unsigned_integral Bits>
[[nodiscard]] Bits load_little_endian(const std::byte* from) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof bits; ++i) {
    bits |= static_cast<Bits>(from[i]) << (8 * i);
  }
  return bits;
}

}  // namespace weft::scenes
