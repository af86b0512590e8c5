#pragma once

// Tested by tests/scenes/recording/content_hash_test.cpp.

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct XXH3_state_s;

namespace weft::scenes {

/// XXH3-128 of a stream of values, each written little-endian; a text is its length (u64) and its
/// bytes.
class StreamHash {
 public:
  StreamHash();
  StreamHash(const StreamHash& other);
  StreamHash& operator=(const StreamHash&) = delete;

  void add(std::span<const std::byte> bytes);
  void add(std::string_view text);
  void add(std::integral auto value) {
    add_bits(static_cast<std::uint64_t>(value));
  }  ///< as 64 bits
  void add(double value) { add_bits(std::bit_cast<std::uint64_t>(value)); }

  /// 32 hexadecimal digits, as the xxh128sum command prints them. The stream may go on afterwards.
  [[nodiscard]] std::string hex() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  void add_bits(std::uint64_t bits);
  std::unique_ptr<XXH3_state_s, Free> state_;
};

}  // namespace weft::scenes
