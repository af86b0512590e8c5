#include <weft/scenes/format/spelling.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

constexpr std::size_t kMaxNameLength = 64;  // nothing longer is a slip of the keyboard

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Insertions, deletions, replacements and swaps of neighbors that turn a into b, upper case
/// ignored.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + replace});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1])) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string suggestion(std::string_view name, std::span<const std::string_view> candidates) {
  std::string_view best;
  std::size_t best_distance = kMaxNameLength;
  if (name.size() <= kMaxNameLength) {
    for (const std::string_view candidate : candidates) {
      const std::size_t distance = edit_distance(name, candidate);
      if (distance < best_distance) {
        best = candidate;
        best_distance = distance;
      }
    }
  }
  // A third of the letters: "tensoin" finds "tension", "foo" does not find "box".
  if (!best.empty() && 3 * best_distance <= std::max(name.size(), best.size())) {
    return fmt::format(", did you mean '{}'?", best);
  }
  return candidates.empty() ? std::string(", expected none")
                            : fmt::format(", expected one of {}", fmt::join(candidates, ", "));
}

std::string shown(std::string_view text, std::size_t max_length) {
  std::size_t end = std::min(text.size(), max_length);
  const auto is_continuation = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (end > 0 && end < text.size() && is_continuation(end)) --end;
  std::string result;
  for (const char c : text.substr(0, end)) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      result += c;
    }
  }
  return end < text.size() ? result + "..." : result;
}

}  // namespace weft::scenes
