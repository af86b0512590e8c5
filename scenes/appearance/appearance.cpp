#include <weft/scenes/appearance/appearance.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

struct NamedColor {
  std::string_view name;
  Rgb color;
};

/// Dyes rather than the pure corners of the colour cube: under a light those look like plastic.
constexpr NamedColor kNamedColors[] = {
    {"beige", {226, 208, 176}}, {"black", {34, 35, 38}},    {"blue", {58, 116, 186}},
    {"brown", {122, 82, 54}},   {"cream", {244, 234, 208}}, {"gold", {212, 164, 58}},
    {"gray", {138, 140, 144}},  {"green", {62, 140, 86}},   {"navy", {36, 54, 104}},
    {"olive", {124, 126, 64}},  {"orange", {226, 128, 52}}, {"pink", {226, 146, 166}},
    {"purple", {116, 88, 160}}, {"red", {186, 52, 48}},     {"sky", {136, 184, 220}},
    {"teal", {44, 134, 136}},   {"white", {242, 242, 240}}, {"yellow", {236, 202, 78}},
};

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<Rgb> parse_color(std::string_view text) {
  for (const NamedColor& entry : kNamedColors) {
    if (entry.name == text) return entry.color;
  }
  constexpr std::size_t kLength = 7;
  if (text.size() != kLength || text.front() != '#') return std::nullopt;
  Rgb color{};
  for (std::size_t c = 0; c < color.size(); ++c) {
    const int high = hex_digit(text[1 + 2 * c]);
    const int low = hex_digit(text[2 + 2 * c]);
    if (high < 0 || low < 0) return std::nullopt;
    color[c] = static_cast<std::uint8_t>(16 * high + low);
  }
  return color;
}

std::string format_color(const Rgb& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

std::vector<std::string_view> color_names() {
  std::vector<std::string_view> names;
  for (const NamedColor& entry : kNamedColors) names.push_back(entry.name);
  return names;
}

}  // namespace weft::scenes
