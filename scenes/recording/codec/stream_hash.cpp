#include <weft/scenes/recording/codec/stream_hash.hpp>

#include <array>
#include <new>

#include <fmt/core.h>
#include <xxhash.h>

#include <weft/scenes/recording/codec/little_endian.hpp>

namespace weft::scenes {
namespace {

XXH3_state_t* new_state() {
  XXH3_state_t* state = XXH3_createState();
  if (state == nullptr) {
    throw std::bad_alloc();
  }
  return state;
}

}  // namespace

StreamHash::StreamHash() : state_(new_state()) {
  XXH3_128bits_reset(state_.get());
}

StreamHash::StreamHash(const StreamHash& other) : state_(new_state()) {
  XXH3_copyState(state_.get(), other.state_.get());
}

void StreamHash::Free::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

void StreamHash::add(std::span<const std::byte> bytes) {
  XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
}

void StreamHash::add(std::string_view text) {
  add_bits(text.size());
  add(std::as_bytes(std::span(text)));
}

void StreamHash::add_bits(std::uint64_t bits) {
  std::array<std::byte, sizeof bits> bytes{};
  store_little_endian(bits, bytes.data());
  add(bytes);
}

std::string StreamHash::hex() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_.get()));
  std::string text;
  for (const unsigned char digit : canonical.digest) {
    text += fmt::format("{:02x}", digit);
  }
  return text;
}

}  // namespace weft::scenes
