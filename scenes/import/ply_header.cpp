#include <weft/scenes/import/ply_header.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <vector>

namespace weft::import {
namespace {

// A header with a thousand properties is far below each of these.
constexpr std::size_t kMaxHeaderSize = 65'536;
constexpr std::size_t kMaxShownLine = 40;  // of a line, in a message

constexpr std::array<std::string_view, 3> kFormats = {"ascii", "binary_little_endian",
                                                      "binary_big_endian"};
constexpr std::array<std::string_view, 16> kTypes = {
    "char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
    "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};

template <class Words>
bool is_one_of(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

std::string shown(std::string_view line) {
  std::string text(line.substr(0, kMaxShownLine));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 0x20 || c == 0x7F; }, '?');
  return "'" + text + (line.size() > kMaxShownLine ? "...'" : "'");
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : bytes_(bytes) {}

  std::optional<std::string> fault() {
    while (!is_ended_) {
      const std::optional<std::string_view> line = next_line();
      if (!line) return "its header has no line 'end_header'";
      if (is_valid(*line)) continue;
      return "line " + std::to_string(number_) + " of its header is " + shown(*line) +
             (number_ == 1 ? ", expected 'ply'" : ", which is no line of a PLY header");
    }
    if (num_elements_ > bytes_.size() - position_) {
      return "its header names " + std::to_string(num_elements_) + " elements, but only " +
             std::to_string(bytes_.size() - position_) + " bytes follow it";
    }
    return std::nullopt;
  }

 private:
  /// Without its end, which is LF or CR LF; none if the header has no further line.
  std::optional<std::string_view> next_line() {
    const std::size_t end = bytes_.substr(0, kMaxHeaderSize).find('\n', position_);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view line = bytes_.substr(position_, end - position_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    position_ = end + 1;
    ++number_;
    return line;
  }

  bool is_valid(std::string_view line) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty()) return false;
    if (number_ == 1) return words[0] == "ply" && words.size() == 1;
    if (words[0] == "comment" || words[0] == "obj_info") return true;
    if (number_of_format_ == 0) {
      number_of_format_ = number_;
      return words.size() == 3 && words[0] == "format" && is_one_of(kFormats, words[1]) &&
             words[2] == "1.0";
    }
    if (words[0] == "element") return is_element(words);
    if (words[0] == "property") return is_property(words);
    is_ended_ = words[0] == "end_header" && words.size() == 1;
    return is_ended_;
  }

  bool is_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) return false;
    std::uint32_t count = 0;
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, count);
    num_elements_ += count;  // a header of 64 kB cannot make it overflow
    has_element_ = true;
    return error == std::errc() && stop == end;
  }

  [[nodiscard]] bool is_property(const std::vector<std::string_view>& words) const {
    if (!has_element_) return false;
    if (words.size() == 3) return is_one_of(kTypes, words[1]);
    return words.size() == 5 && words[1] == "list" && is_one_of(kTypes, words[2]) &&
           is_one_of(kTypes, words[3]);
  }

  std::string_view bytes_;
  std::size_t position_ = 0;
  int number_ = 0;  ///< of the line, from 1
  int number_of_format_ = 0;
  std::uint64_t num_elements_ = 0;
  bool has_element_ = false;
  bool is_ended_ = false;
};

}  // namespace

std::optional<std::string> ply_header_fault(std::string_view bytes) {
  return HeaderReader(bytes).fault();
}

}  // namespace weft::import
