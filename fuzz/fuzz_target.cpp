#include "fuzz/fuzz_target.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace weft::fuzz {

void require(bool is_kept, std::string_view promise) {
  if (is_kept) return;
  std::fprintf(stderr, "broken promise: %s\n", std::string(promise).c_str());
  std::abort();
}

void require_clear(std::string_view message) {
  constexpr std::size_t kMaxMessage = 2000;
  const bool is_plain = std::none_of(message.begin(), message.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20U || c == 0x7F;
  });
  require(is_plain && !message.empty() && message.size() <= kMaxMessage,
          "an error is one line of at most 2,000 bytes, not: " + std::string(message));
}

}  // namespace weft::fuzz
