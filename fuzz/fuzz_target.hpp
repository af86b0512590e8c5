#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

/// What every target defines: reads one input as Weft reads a file from a stranger. Ends the process
/// if the reader breaks a promise; a clear error keeps it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace weft::fuzz {

[[nodiscard]] inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the process, saying why, unless a promise is kept.
void require(bool is_kept, std::string_view promise);

/// A message must be one line that a terminal can show, of at most 2,000 bytes.
void require_clear(std::string_view message);

}  // namespace weft::fuzz
