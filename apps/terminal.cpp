#include "apps/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <iostream>

#include "apps/app.hpp"

namespace weft::app {
namespace {

struct Character {
  char32_t value = 0;
  std::size_t length = 0;  ///< [byte]; 0: no UTF-8
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {byte(0), 1};
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) return {};
  char32_t value = byte(0) & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {};
    value = value << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < kSmallest.at(length) || value > 0x10FFFF || is_surrogate) return {};
  return {value, length};
}

bool is_harmless(char32_t value) {
  if (value == '\n' || value == '\t') return true;
  const bool is_control = value < 0x20 || (value >= 0x7F && value < 0xA0);
  const bool turns_direction =
      (value >= 0x202A && value <= 0x202E) || (value >= 0x2066 && value <= 0x2069);
  return !is_control && !turns_direction;
}

/// Why the first write failed, for finish_output(): later ones may fail for another reason.
int first_failure = 0;

void write_bytes(std::FILE* stream, std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size()) return;
  if (stream == stdout && first_failure == 0) first_failure = errno;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character next = first_character(text);
    const std::size_t length = next.length > 0 ? next.length : 1;
    if (next.length > 0 && is_harmless(next.value)) {
      shown += text.substr(0, length);
    } else {
      for (const char c : text.substr(0, length)) {
        shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
      }
    }
    text.remove_prefix(length);
  }
  return shown;
}

void write_text(std::FILE* stream, std::string_view text) {
  write_bytes(stream, printable(text));
}

void write_data(std::FILE* stream, std::string_view data) {
  if (isatty(fileno(stream)) == 1) {
    write_text(stream, data);
  } else {
    write_bytes(stream, data);
  }
}

void prepare_output() {
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(standard, F_GETFD) >= 0) continue;
    // The wrong way round, so that reading or writing fails as it would have.
    (void)open("/dev/null", standard == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

int finish_output(int code) {
  std::cout.flush();
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  const int reason = first_failure != 0 ? first_failure : errno;
  if (flushed && std::ferror(stdout) == 0) return code;
  print(stderr, "weft: standard output cannot be written{}{}\n", reason != 0 ? ": " : "",
        reason != 0 ? std::strerror(reason) : "");
  return code == kOk ? kBadInput : code;
}

}  // namespace weft::app
