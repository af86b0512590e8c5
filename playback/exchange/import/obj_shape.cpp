#include <weft/playback/exchange/import/obj_shape.hpp>

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/spelling.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// Takes the next word off the front of a line; empty at its end.
std::string_view take_word(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(kBlanks), line.size());
  const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

template <class Number>
std::optional<Number> number_of(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : file_(file) {}

  void read(std::string_view line) {
    ++number_;
    const std::string_view kind = take_word(line);
    if (kind == "v") read_point(line);
    if (kind == "f") read_face(line);
  }

  ObjShape finish() {
    if (points_.empty()) throw Error(file_ + ": has no point, expected lines such as \"v 0 1 0\"");
    shape_.points = Eigen::Map<const Matrix3X<double>>(
        points_.data(), 3, static_cast<Eigen::Index>(points_.size() / 3));
    return std::move(shape_);
  }

 private:
  [[noreturn]] void refuse(const std::string& fault) const {
    throw Error(fmt::format("{}:{}: {}", file_, number_, fault));
  }

  void read_point(std::string_view line) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = take_word(line);
      const std::optional<double> value = number_of<double>(word);
      if (!value || !std::isfinite(*value)) {
        refuse(
            fmt::format("coordinate '{}' of a point, expected three finite numbers", shown(word)));
      }
      points_.push_back(*value);
    }
  }

  void read_face(std::string_view line) {
    const auto num_points = static_cast<int>(points_.size() / 3);
    std::vector<int> face;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const std::optional<int> value = number_of<int>(word.substr(0, word.find('/')));
      // Negative numbers count back from the last point so far.
      const int node = !value ? -1 : *value < 0 ? num_points + *value : *value - 1;
      if (node < 0 || node >= num_points) {
        refuse(
            fmt::format("corner '{}' of a face, expected a number from 1 to {}, the points so far",
                        shown(word), num_points));
      }
      face.push_back(node);
    }
    if (face.size() < 3) {
      refuse(fmt::format("a face with {} corners, expected at least 3", face.size()));
    }
    shape_.faces.push_back(std::move(face));
  }

  const std::string& file_;
  int number_ = 0;
  std::vector<double> points_;
  ObjShape shape_;
};

}  // namespace

ObjShape read_obj_shape(std::string_view text, const std::string& file) {
  ObjReader reader(file);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.read(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.finish();
}

}  // namespace weft::scenes
