#include <weft/scenes/format/text_guard.hpp>

#include <array>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

// A scene needs 4 levels of brackets and keys of 2 parts. The product bounds the depth of the
// parsed tree.
constexpr std::size_t kMaxBracketDepth = 16;
constexpr int kMaxKeyParts = 16;

/// Length of the UTF-8 character at the start of text, 0 if it is malformed (overlong and
/// surrogates too).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned char second = byte(1);
  if ((first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second > 0x9FU) ||
      (first == 0xF0U && second < 0x90U) || (first == 0xF4U && second > 0x8FU)) {
    return 0;
  }
  return length;
}

/// Follows strings and comments as TOML does and counts brackets and dots outside of them.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  std::optional<TextDefect> scan() {
    while (position_ < text_.size()) {
      const std::size_t length = utf8_length(text_.substr(position_));
      if (length == 0) {
        return defect("is not UTF-8 text, expected a TOML scene file");
      }
      const char c = text_[position_];
      const auto byte = static_cast<unsigned char>(c);
      if ((byte < 0x20U && c != '\t' && c != '\n' && c != '\r') || byte == 0x7FU) {
        return defect(fmt::format("control character 0x{:02x}, expected a TOML scene file", byte));
      }
      if (std::optional<TextDefect> problem = visit(c)) return problem;
      advance(length);
    }
    if (!any_content_) {
      line_ = column_ = 1;
      return defect("is empty, expected a scene that begins with schema = \"weft-scene/1\"");
    }
    return std::nullopt;
  }

 private:
  enum class Mode { kPlain, kComment, kString };

  TextDefect defect(std::string message) const { return {line_, column_, std::move(message)}; }

  void advance(std::size_t bytes) {
    if (text_[position_] == '\n') {
      ++line_;
      column_ = 1;
    } else {
      ++column_;
    }
    position_ += bytes;
  }

  bool starts_with(std::string_view what) const {
    return text_.substr(position_).starts_with(what);
  }

  std::optional<TextDefect> visit(char c) {
    if (mode_ == Mode::kComment) {
      if (c == '\n') {
        mode_ = Mode::kPlain;
        line_start_ = true;
      }
    } else if (mode_ == Mode::kString) {
      visit_string(c);
    } else {
      return visit_plain(c);
    }
    return std::nullopt;
  }

  void visit_string(char c) {
    if (c == '\\' && delimiter_[0] == '"' && position_ + 1 < text_.size()) {
      // The escaped character is skipped unless it ends the line or is not ASCII: the loop looks at
      // those.
      const auto next = static_cast<unsigned char>(text_[position_ + 1]);
      if (next >= 0x20U && next < 0x7FU) advance(1);
    } else if (starts_with(delimiter_) || (c == '\n' && delimiter_.size() == 1)) {
      std::size_t length = delimiter_.size();
      // Up to two quotes just before the closing three belong to the text: """" and """"" close it
      // too.
      for (int extra = 0; extra < 2 && length >= 3; ++extra) {
        if (position_ + length < text_.size() && text_[position_ + length] == delimiter_[0]) {
          ++length;
        }
      }
      position_ += length - 1;
      column_ += static_cast<int>(length) - 1;
      mode_ = Mode::kPlain;
    }
  }

  /// toml++ 3.3 assumes a key after the '[' of a table header without looking: undefined behaviour
  /// in builds without assertions.
  bool is_header_without_key() const {
    const std::size_t key =
        text_.find_first_not_of(" \t", position_ + (starts_with("[[") ? 2U : 1U));
    if (key == std::string_view::npos) return true;
    const char c = text_[key];
    const bool is_bare = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '_' || c == '-';
    return !is_bare && c != '"' && c != '\'';
  }

  std::optional<TextDefect> visit_plain(char c) {
    const bool is_blank = c == ' ' || c == '\t' || c == '\r';
    if (line_start_ && depth_ == 0 && c == '[' && is_header_without_key()) {
      return defect("table header without a name, expected one such as [world] or [[cloth]]");
    }
    line_start_ = c == '\n' || (line_start_ && is_blank);
    any_content_ = any_content_ || !(is_blank || c == '\n' || c == '#');
    if (c == '#') {
      mode_ = Mode::kComment;
    } else if (c == '"' || c == '\'') {
      const std::string_view triple = c == '"' ? R"(""")" : "'''";
      delimiter_ = starts_with(triple) ? triple : triple.substr(0, 1);
      position_ += delimiter_.size() - 1;
      column_ += static_cast<int>(delimiter_.size()) - 1;
      mode_ = Mode::kString;
    } else if (c == '.') {
      if (++num_dots_ >= kMaxKeyParts) return defect("key has too many parts, expected a.b");
    } else if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{') {
      num_dots_ = 0;
    }
    return visit_bracket(c);
  }

  /// A '}' inside '[ ]' is another place where toml++ 3.3 only assumes.
  std::optional<TextDefect> visit_bracket(char c) {
    if (c == '[' || c == '{') {
      if (depth_ == kMaxBracketDepth) {
        return defect(fmt::format("brackets are nested too deep, expected at most {} levels",
                                  kMaxBracketDepth));
      }
      closers_[depth_++] = c == '[' ? ']' : '}';
    } else if ((c == ']' || c == '}') && depth_ > 0) {
      if (closers_[--depth_] != c) {
        return defect(fmt::format("'{}' does not match, expected '{}'", c, closers_[depth_]));
      }
    }
    return std::nullopt;
  }

  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
  int column_ = 1;
  std::array<char, kMaxBracketDepth> closers_{};  ///< what closes each open bracket
  std::size_t depth_ = 0;
  int num_dots_ = 0;
  bool any_content_ = false;
  bool line_start_ = true;
  Mode mode_ = Mode::kPlain;
  std::string_view delimiter_ = "\"";
};

}  // namespace

std::optional<TextDefect> find_text_defect(std::string_view text) {
  if (text.size() > kMaxTextSize) {
    return TextDefect{1, 1,
                      fmt::format("is over {} MB, expected a scene file, which is a few kB",
                                  kMaxTextSize / (1024 * 1024))};
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return Scanner(text).scan();
}

}  // namespace weft::scenes
