#pragma once

// Tested by tests/validation/report/write_test.cpp.

#include <cstddef>
#include <string>

#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// What the bytes of a picture's file are: JPEG if they begin as one, else PNG.
struct PictureType {
  const char* mime;       ///< "image/jpeg"
  const char* extension;  ///< "jpg"
};
[[nodiscard]] PictureType picture_type(const std::string& image);

/// Where a picture's file is, relative to the report's folder:
/// "pictures/2-drape_sphere/1-3-bullet_soft.png". Indices start at 0 and are valid ones; they keep
/// names unique whatever the titles are. Only [a-z0-9_-] occurs.
[[nodiscard]] std::string picture_path(const Report& report, std::size_t section, std::size_t row,
                                       std::size_t picture);

/// The same for a table: "tables/2-drape_sphere/1-at_the_end.csv".
[[nodiscard]] std::string table_path(const Report& report, std::size_t section, std::size_t table);

}  // namespace weft::validation
