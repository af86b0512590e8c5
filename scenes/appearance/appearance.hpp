#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::scenes {

/// 8-bit sRGB.
using Rgb = std::array<std::uint8_t, 3>;

/// Patterns that are made in code, see playback/pattern.hpp.
enum class Pattern { kPlain, kChecks, kStripes, kDots, kTartan, kCarpet, kEyeball };

/// How a body is drawn. No engine looks at it.
struct Appearance {
  std::optional<Rgb> color = {};       ///< of the front, ground of a pattern; none: the palette's
  std::optional<Rgb> back_color = {};  ///< cloth only; none: the palette's, or the pattern, paler
  std::optional<Rgb> pattern_color = {};  ///< of the pattern's figures; none: the pattern's own
  Pattern pattern = Pattern::kPlain;
  std::string image = {};  ///< name of a SceneFile that is drawn in place of a pattern; empty: none
  std::array<double, 2> texture_repeat = {1, 1};  ///< how often along u and v [-], > 0
  bool smooth = true;                             ///< false: every triangle is flat
  bool visible = true;                            ///< false: neither drawn nor casting a shadow
};

/// A file that a scene names and takes along, so that a recording plays elsewhere.
struct SceneFile {
  std::string name;   ///< as the scene spells it
  std::string bytes;  ///< whole content
};

/// Reads "#rrggbb" or one of color_names(); none for anything else.
[[nodiscard]] std::optional<Rgb> parse_color(std::string_view text);
/// "#rrggbb".
[[nodiscard]] std::string format_color(const Rgb& color);
[[nodiscard]] std::vector<std::string_view> color_names();

}  // namespace weft::scenes
