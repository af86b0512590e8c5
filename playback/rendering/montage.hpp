#pragma once

#include <string>
#include <vector>

#include <weft/playback/rendering/image.hpp>

namespace weft::scenes {

/// Writes a line in the lower left corner of a picture.
void draw_label(Image& image, const std::string& text);

/// Pictures of one size in rows, a thin gap between them. Throws InvalidArgument for none, for
/// several sizes and for columns < 1.
[[nodiscard]] Image filmstrip(const std::vector<Image>& pictures, int columns);

/// A picture with what is written below it.
struct SheetEntry {
  Image picture;
  std::string name;
  std::string text;  ///< broken into lines, at most two; what is longer ends with "..."
};

/// Pictures of one size on a page with names and texts below. Throws as filmstrip().
[[nodiscard]] Image contact_sheet(const std::vector<SheetEntry>& entries, int columns);

/// Breaks a text at spaces into lines that are at most width wide [pixel] in letters of this height;
/// the last of max_lines ends with "..." if something is left out.
[[nodiscard]] std::vector<std::string> wrap_text(const std::string& text, float width, float height,
                                                 std::size_t max_lines);

}  // namespace weft::scenes
