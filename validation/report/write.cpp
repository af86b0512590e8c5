#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include <weft/custom_forces/core/error.hpp>
#include <weft/validation/report/picture_path.hpp>
#include <weft/validation/report/write.hpp>

namespace weft::validation {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, std::string_view what, const std::string& reason) {
  throw Error(fmt::format("write_report: cannot {} {}: {}", what, path.string(), reason));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail(folder, "make folder", error.message());
}

void write_file(const fs::path& path, std::string_view bytes) {
  // The process id keeps two runs that share a folder from writing into each other's file.
  const fs::path part =
      path.parent_path() / fmt::format(".{}.{}.part", path.filename().string(), ::getpid());
  errno = 0;
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code ignored;
  if (!file) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "output error";
    fs::remove(part, ignored);
    fail(path, "write", reason);
  }
  std::error_code error;
  fs::rename(part, path, error);
  if (error) {
    fs::remove(part, ignored);
    fail(path, "write", error.message());
  }
}

void write_pictures(const Report& report, const fs::path& folder) {
  for (std::size_t s = 0; s < report.sections.size(); ++s) {
    const std::vector<PictureRow>& rows = report.sections[s].picture_rows;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t p = 0; p < rows[r].pictures.size(); ++p) {
        const fs::path path = folder / picture_path(report, s, r, p);
        make_folder(path.parent_path());
        write_file(path, rows[r].pictures[p].image);
      }
    }
  }
}

/// A line of RFC 4180; quotes only where they are needed.
std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    if (cell.find_first_of(",\"\r\n") == std::string::npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + '\n';
}

void write_tables(const Report& report, const fs::path& folder) {
  for (std::size_t s = 0; s < report.sections.size(); ++s) {
    for (std::size_t t = 0; t < report.sections[s].tables.size(); ++t) {
      const Table& table = report.sections[s].tables[t];
      std::string text = csv_line(table.columns);
      for (const std::vector<std::string>& row : table.rows) text += csv_line(row);
      const fs::path path = folder / table_path(report, s, t);
      make_folder(path.parent_path());
      write_file(path, text);
    }
  }
}

}  // namespace

void write_report(const Report& report, const fs::path& folder) {
  make_folder(folder);
  write_pictures(report, folder);
  write_tables(report, folder);
  write_file(folder / "report.json", to_json(report));
  write_file(folder / "junit.xml", to_junit(report));
  write_file(folder / "index.html", to_html(report));
}

void render_report(const std::filesystem::path& folder) {
  const fs::path path = folder / "report.json";
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) fail(path, "read", "expected a report.json that weft validate wrote");
  write_file(folder / "index.html", html_of_json(text.str(), path.string()));
}

}  // namespace weft::validation
