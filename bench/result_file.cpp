#include "bench/result_file.hpp"

#include <cstdlib>
#include <fstream>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <weft/core/error.hpp>

namespace weft::bench {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

ResultFile::ResultFile(std::string title, std::vector<std::string> columns)
    : title_(std::move(title)), columns_(std::move(columns)) {}

void ResultFile::add(std::vector<std::string> row) {
  if (row.size() != columns_.size()) {
    throw Error(fmt::format("bench: a row of {} values, expected {}", row.size(), columns_.size()));
  }
  fmt::print("{}\n", fmt::join(row, "  "));
  rows_.push_back(std::move(row));
}

void ResultFile::write(const std::filesystem::path& path) const {
  double load[3] = {0, 0, 0};
  (void)getloadavg(load, 3);
  std::ofstream file(path);
  file << "# " << title_ << "\n# machine: " << processor() << ", "
       << std::thread::hardware_concurrency() << " threads; load average at the end "
       << fmt::format("{:.1f}", load[0]) << "\n# compiler: " << WEFT_COMPILER
       << "\n# flags: " << WEFT_FLAGS << '\n'
       << fmt::format("{}\n", fmt::join(columns_, ","));
  for (const auto& row : rows_) file << fmt::format("{}\n", fmt::join(row, ","));
  file.close();
  if (!file) throw Error(path.string() + ": cannot be written");
  fmt::print("-> {}\n", path.string());
}

std::string three_digits(double value) {
  return fmt::format("{:.3g}", value);
}

}  // namespace weft::bench
