#include <fstream>
#include <sstream>
#include <string_view>

#include <weft/core/error.hpp>
#include <weft/validation/report/picture_path.hpp>
#include <weft/validation/report/write.hpp>

namespace weft::validation {
namespace {

namespace fs = std::filesystem;

bool begins_as_report(std::string_view beginning) {
  // "schema" is the first key, whatever the white space.
  constexpr std::size_t kFirstKeys = 100;
  return beginning.starts_with('{') &&
         beginning.substr(0, kFirstKeys).find("\"weft-report\"") != std::string_view::npos;
}

void write_pictures(const Report& report, const output::OutputFolder& folder) {
  for (std::size_t s = 0; s < report.sections.size(); ++s) {
    const std::vector<PictureRow>& rows = report.sections[s].picture_rows;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t p = 0; p < rows[r].pictures.size(); ++p) {
        folder.write(picture_path(report, s, r, p), rows[r].pictures[p].image);
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

void write_tables(const Report& report, const output::OutputFolder& folder) {
  for (std::size_t s = 0; s < report.sections.size(); ++s) {
    for (std::size_t t = 0; t < report.sections[s].tables.size(); ++t) {
      const Table& table = report.sections[s].tables[t];
      std::string text = csv_line(table.columns);
      for (const std::vector<std::string>& row : table.rows) text += csv_line(row);
      folder.write(table_path(report, s, t), text);
    }
  }
}

}  // namespace

output::OutputFolder report_folder(const fs::path& path) {
  return {path, "report.json", {"a report", begins_as_report}};
}

void write_report(const Report& report, const output::OutputFolder& folder) {
  write_pictures(report, folder);
  write_tables(report, folder);
  folder.write("report.json", to_json(report));
  folder.write("junit.xml", to_junit(report));
  folder.write("index.html", to_html(report));
}

void write_report(const Report& report, const fs::path& folder) {
  write_report(report, report_folder(folder));
}

void render_report(const std::filesystem::path& folder) {
  const fs::path path = folder / "report.json";
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    throw Error(path.string() +
                ": cannot be read, expected a report.json that weft validate wrote");
  }
  const std::string page = html_of_json(text.str(), path.string());
  report_folder(folder).write("index.html", page);
}

}  // namespace weft::validation
