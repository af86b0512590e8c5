#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft::bench {

/// A table that is written to a CSV file, with the machine, the compiler, its flags and the load in
/// comment lines above, and to the terminal.
class ResultFile {
 public:
  /// columns carry the unit in their name.
  ResultFile(std::string title, std::vector<std::string> columns);
  void add(std::vector<std::string> row);
  /// Throws Error if the file cannot be written.
  void write(const std::filesystem::path& path) const;

 private:
  std::string title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// A number with three significant digits.
[[nodiscard]] std::string three_digits(double value);

}  // namespace weft::bench
