#include <cstddef>
#include <cstdint>

#include <weft/validation/report/formats/xml_text.hpp>

namespace weft::validation {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

// How many bytes the UTF-8 character at the front has; 0 if it is malformed or XML 1.0 forbids it.
std::size_t valid_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80U) return lead >= 0x20U || lead == '\n' || lead == '\t' || lead == '\r' ? 1 : 0;
  const std::size_t length = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < length) return 0;
  std::uint32_t code = lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
  const bool forbidden = code == 0xFFFEU || code == 0xFFFFU || code > 0x10FFFFU;
  return code < kSmallest[length] || surrogate || forbidden ? 0 : length;
}

std::string_view escape(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\n':
      return "&#10;";
    case '\t':
      return "&#9;";
    case '\r':
      return "&#13;";
    default:
      return "";
  }
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string xml;
  while (!text.empty()) {
    const std::size_t length = valid_character(text);
    if (length == 0) {
      xml += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    const std::string_view escaped = escape(text.front());
    xml += escaped.empty() ? text.substr(0, length) : escaped;
    text.remove_prefix(length);
  }
  return xml;
}

}  // namespace weft::validation
