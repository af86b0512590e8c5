#include <weft/playback/rendering/montage.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/playback/rendering/paint/text.hpp>

namespace weft::scenes {
namespace {

constexpr Rgb kCaptionInk = {38, 44, 54};
constexpr Rgb kGrayInk = {104, 112, 124};
constexpr Rgb kPaper = {255, 255, 255};
constexpr double kDark = 120;  // of 255: what is darker gets white letters
constexpr const char* kEllipsis = "...";

Image blank(int width, int height) {
  Image image{width, height, {}};
  image.rgb.reserve(std::size_t{3} * static_cast<std::size_t>(width) *
                    static_cast<std::size_t>(height));
  for (int i = 0; i < width * height; ++i) {
    image.rgb.insert(image.rgb.end(), kPaper.begin(), kPaper.end());
  }
  return image;
}

void paste(Image& page, const Image& picture, int left, int top) {
  const std::ptrdiff_t row_size = std::ptrdiff_t{3} * picture.width;
  for (int row = 0; row < picture.height; ++row) {
    std::copy_n(picture.rgb.begin() + row_size * row, row_size,
                page.rgb.begin() + std::ptrdiff_t{3} * ((top + row) * page.width + left));
  }
}

void check(std::size_t count, int columns) {
  if (count == 0) throw InvalidArgument("montage: no picture, expected at least one");
  if (columns < 1) {
    throw InvalidArgument(fmt::format("montage: columns = {}, expected >= 1", columns));
  }
}

void check_same_size(const Image& first, const Image& other) {
  if (first.width == other.width && first.height == other.height) return;
  throw InvalidArgument(
      fmt::format("montage: a picture has {} x {} pixels, expected {} x {} as the first",
                  other.width, other.height, first.width, first.height));
}

/// Mean of all colours in a rectangle.
double mean_of(const Image& image, float left, float right, float top, float bottom) {
  const auto row_at = [&](float y) { return std::clamp(static_cast<int>(y), 0, image.height); };
  const auto column_at = [&](float x) { return std::clamp(static_cast<int>(x), 0, image.width); };
  double sum = 0;
  double count = 0;
  for (int row = row_at(top); row < row_at(bottom); ++row) {
    for (int k = 3 * column_at(left); k < 3 * column_at(right); ++k) {
      sum += image.rgb[static_cast<std::size_t>(row) * 3 * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(k)];
      ++count;
    }
  }
  return count > 0 ? sum / count : 255.0;
}

/// Longest head of a line that leaves room for the ellipsis.
std::string cut(std::string line, float width, float height) {
  while (!line.empty() && text_width(line + kEllipsis, height) > width) line.pop_back();
  return line + kEllipsis;
}

}  // namespace

void draw_label(Image& image, const std::string& text) {
  const float height = std::max(11.0f, static_cast<float>(image.height) / 22.0f);
  const float left = 0.7f * height;
  const float base = static_cast<float>(image.height) - 0.7f * height;
  const bool is_dark =
      mean_of(image, left, left + text_width(text, height), base - height, base) < kDark;
  draw_text(image, text, left, base, height, is_dark ? kPaper : kCaptionInk);
}

Image filmstrip(const std::vector<Image>& pictures, int columns) {
  check(pictures.size(), columns);
  const Image& first = pictures.front();
  const int count = static_cast<int>(pictures.size());
  const int across = std::min(columns, count);
  const int rows = (count + across - 1) / across;
  const int gap = 2 * std::max(1, first.height / 180);  // even, because films have even sizes
  Image page = blank(across * (first.width + gap) - gap, rows * (first.height + gap) - gap);
  for (int i = 0; i < count; ++i) {
    const Image& picture = pictures[static_cast<std::size_t>(i)];
    check_same_size(first, picture);
    paste(page, picture, i % across * (first.width + gap), i / across * (first.height + gap));
  }
  return page;
}

std::vector<std::string> wrap_text(const std::string& text, float width, float height,
                                   std::size_t max_lines) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    at = std::min(end + 1, text.size());
    const std::string longer = line.empty() ? word : line + " " + word;
    if (line.empty() || text_width(longer, height) <= width) {
      line = longer;
      continue;
    }
    if (lines.size() + 1 == max_lines) {
      lines.push_back(cut(longer, width, height));
      return lines;
    }
    lines.push_back(line);
    line = word;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

Image contact_sheet(const std::vector<SheetEntry>& entries, int columns) {
  check(entries.size(), columns);
  const Image& first = entries.front().picture;
  const int count = static_cast<int>(entries.size());
  const int across = std::min(columns, count);
  const int rows = (count + across - 1) / across;
  const float name_height = static_cast<float>(first.width) / 22.0f;
  const float text_height = static_cast<float>(first.width) / 29.0f;
  constexpr std::size_t kLines = 2;
  const int margin = first.width / 16;
  const int caption = static_cast<int>(1.5f * name_height + (1.3f * kLines + 0.9f) * text_height);
  Image page =
      blank(across * (first.width + margin) + margin, rows * (first.height + caption) + 2 * margin);
  for (int i = 0; i < count; ++i) {
    const SheetEntry& entry = entries[static_cast<std::size_t>(i)];
    check_same_size(first, entry.picture);
    const int left = margin + i % across * (first.width + margin);
    const int top = margin + i / across * (first.height + caption);
    paste(page, entry.picture, left, top);
    const auto x = static_cast<float>(left);
    float y = static_cast<float>(top + first.height) + 1.25f * name_height;
    draw_text(page, entry.name, x, y, name_height, kCaptionInk);
    for (const std::string& line :
         wrap_text(entry.text, static_cast<float>(first.width), text_height, kLines)) {
      y += 1.3f * text_height;
      draw_text(page, line, x, y, text_height, kGrayInk);
    }
  }
  return page;
}

}  // namespace weft::scenes
