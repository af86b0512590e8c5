#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace weft::docs {

/// The text of a page of docs/.
inline std::string page_text(const std::string& name) {
  std::ifstream stream(std::filesystem::path(WEFT_SOURCE_DIR) / "docs" / name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The page has these lines as they stand here. A failure prints them, to be copied into the page.
inline void expect_lines(const std::string& page, const std::string& lines) {
  EXPECT_NE(page_text(page).find("\n" + lines), std::string::npos)
      << "docs/" << page << " has other numbers. The right lines are:\n"
      << lines;
}

}  // namespace weft::docs
