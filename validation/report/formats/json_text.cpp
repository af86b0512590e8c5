#include <algorithm>

#include <weft/validation/report/formats/json_text.hpp>

namespace weft::validation {
namespace {

using Json = nlohmann::ordered_json;

std::string scalar_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append(std::string& text, const Json& value, std::size_t depth) {
  if (!value.is_structured() || value.empty()) {
    text += scalar_text(value);
    return;
  }
  const bool one_line =
      value.is_array() && std::none_of(value.begin(), value.end(),
                                       [](const Json& item) { return item.is_structured(); });
  const std::string line = one_line ? " " : "\n" + std::string(2 * (depth + 1), ' ');
  text += value.is_array() ? '[' : '{';
  bool first = true;
  for (const auto& [key, item] : value.items()) {
    if (!first) text += ',';
    if (!first || !one_line) text += line;
    first = false;
    if (value.is_object()) text += scalar_text(Json(key)) + ": ";
    append(text, item, depth + 1);
  }
  if (!one_line) text += "\n" + std::string(2 * depth, ' ');
  text += value.is_array() ? ']' : '}';
}

}  // namespace

std::string json_text(const Json& value) {
  std::string text;
  append(text, value, 0);
  text += '\n';
  return text;
}

}  // namespace weft::validation
