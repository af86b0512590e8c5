// Tested by tests/validation/report/html_test.cpp.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include <weft/core/error.hpp>
#include <weft/validation/report/formats/json_text.hpp>
#include <weft/validation/report/page.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {
namespace {

// '<' occurs in JSON only inside strings, where \u003c means the same: no text can end the script
// element
// ("</script") or open a comment ("<!--").
std::string without_markup(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string page_with(const std::string& json) {
  constexpr std::string_view kSlot = "__WEFT_REPORT_JSON__";
  const std::string_view page = page_template();
  const std::size_t at = page.find(kSlot);
  if (at == std::string_view::npos) {
    throw Error(
        "to_html: web/dist/report.html has no slot __WEFT_REPORT_JSON__, expected one; rebuild "
        "web/");
  }
  std::string html(page.substr(0, at));
  html += without_markup(json);
  html += page.substr(at + kSlot.size());
  return html;
}

}  // namespace

std::string html_of_json(const std::string& json, const std::string& file) {
  const auto data = nlohmann::json::parse(json, nullptr, false);
  if (!data.is_object() || !data.contains("schema") || data["schema"] != "weft-report") {
    throw Error(file + ": is not a report, expected JSON with \"schema\": \"weft-report\"");
  }
  const auto version = data.find("schema_version");
  if (version == data.end() || *version != kReportSchemaVersion) {
    throw Error(fmt::format("{}: schema_version is {}, expected {}", file,
                            version == data.end() ? "missing" : version->dump(),
                            kReportSchemaVersion));
  }
  return page_with(json);
}

std::string to_html(const Report& report) {
  return page_with(to_json(report));
}

}  // namespace weft::validation
