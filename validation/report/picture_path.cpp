#include <fmt/format.h>

#include <string_view>

#include <weft/validation/report/picture_path.hpp>

namespace weft::validation {
namespace {

// Titles are free text; a file name must not leave the folder or depend on the file system's
// alphabet.
std::string file_name_part(std::string_view title) {
  constexpr std::size_t kLongest = 48;
  std::string name;
  for (const char c : title.substr(0, kLongest)) {
    if (c >= 'A' && c <= 'Z') {
      name += static_cast<char>(c - 'A' + 'a');
    } else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-') {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name.empty() ? "untitled" : name;
}

}  // namespace

PictureType picture_type(const std::string& image) {
  if (image.starts_with("\xff\xd8\xff")) return {"image/jpeg", "jpg"};
  return {"image/png", "png"};
}

std::string picture_path(const Report& report, std::size_t section, std::size_t row,
                         std::size_t picture) {
  const Section& of = report.sections.at(section);
  const Picture& shown = of.picture_rows.at(row).pictures.at(picture);
  return fmt::format("pictures/{}-{}/{}-{}-{}.{}", section + 1, file_name_part(of.id), row + 1,
                     picture + 1, file_name_part(shown.title), picture_type(shown.image).extension);
}

std::string table_path(const Report& report, std::size_t section, std::size_t table) {
  const Section& of = report.sections.at(section);
  return fmt::format("tables/{}-{}/{}-{}.csv", section + 1, file_name_part(of.id), table + 1,
                     file_name_part(of.tables.at(table).title));
}

}  // namespace weft::validation
