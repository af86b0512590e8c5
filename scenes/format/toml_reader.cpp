#include <weft/scenes/format/toml_reader.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/format/spelling.hpp>

namespace weft::scenes {
namespace {

constexpr std::size_t kMaxIdentifierLength = 64;

SceneError error_at(const std::string& file, const toml::source_region& source,
                    const std::string& message) {
  const toml::source_position& begin = source.begin;
  return {file, std::max(1, static_cast<int>(begin.line)),
          std::max(1, static_cast<int>(begin.column)), message};
}

/// The value as it goes into messages; arrays and tables only by their brackets.
std::string shown_value(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "\"" + shown(node.as_string()->get()) + "\"";
    case toml::node_type::integer:
      return fmt::format("{}", node.as_integer()->get());
    case toml::node_type::floating_point:
      return fmt::format("{}", node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    case toml::node_type::array:
      return "[...]";
    case toml::node_type::table:
      return "{...}";
    default:
      return "date";
  }
}

std::string expected_of(std::string_view unit) {
  return unit == "1" ? std::string("a number without unit such as 0.5") : expected_quantity(unit);
}

std::string_view article(std::string_view name) {
  return std::string_view("aeiou").find(name[0]) != std::string_view::npos ? "an" : "a";
}

/// "a mass > 0" for a bound on a quantity.
std::string bounded(std::string_view unit, std::string_view bound) {
  const std::string expected = expected_of(unit);
  const std::string name = expected.substr(0, expected.find(" such as"));
  return fmt::format("expected {} {}", unit == "1" ? "a number" : name, bound);
}

bool is_identifier(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !text.empty() && text.size() <= kMaxIdentifierLength &&
         std::all_of(text.begin(), text.end(), allowed);
}

}  // namespace

void TomlValue::fail(const std::string& message) const {
  throw error_at(source_->name, node_->source(),
                 fmt::format("{} = {}: {}", path_, shown_value(*node_), message));
}

std::string TomlValue::named_file(std::string_view expected) const {
  const std::string name = text();
  std::optional<std::string> bytes;
  try {
    if (source_->files) bytes = source_->files(name);
  } catch (const InvalidArgument& error) {
    fail(error.what());
  }
  if (!bytes) fail(fmt::format("no such file, expected {} beside the scene file", expected));
  return std::move(*bytes);
}

double TomlValue::quantity(std::string_view unit) const {
  if (unit == "1") {
    const std::optional<double> number =
        node_->is_number() ? node_->value<double>() : std::optional<double>();
    if (!number) fail("expected " + expected_of(unit));
    if (!std::isfinite(*number)) fail("expected a finite number");
    return *number;
  }
  if (const auto* text = node_->as_string()) {
    try {
      return parse_quantity(text->get(), unit);
    } catch (const UnitError& error) {
      fail(error.what());
    }
  }
  if (node_->is_number()) {
    const double number = node_->value<double>().value_or(0.0);
    if (!std::isfinite(number))
      fail("expected a finite number with its unit, " + expected_of(unit));
    const std::string shown_number = fmt::format("{}", number);
    fail("missing unit, expected " + expected_quantity(unit, shown_number));
  }
  fail("expected " + expected_of(unit));
}

double TomlValue::positive(std::string_view unit) const {
  const double value = quantity(unit);
  if (!(value > 0)) fail(bounded(unit, "> 0"));
  return value;
}

double TomlValue::non_negative(std::string_view unit) const {
  const double value = quantity(unit);
  if (!(value >= 0)) fail(bounded(unit, ">= 0"));
  return value;
}

int TomlValue::integer(int minimum, int maximum) const {
  const auto* number = node_->as_integer();
  if (number == nullptr || number->get() < minimum || number->get() > maximum) {
    fail(fmt::format("expected a whole number from {} to {}", minimum, maximum));
  }
  return static_cast<int>(number->get());
}

bool TomlValue::boolean() const {
  const auto* value = node_->as_boolean();
  if (value == nullptr) fail("expected true or false");
  return value->get();
}

std::string TomlValue::text() const {
  const auto* text = node_->as_string();
  if (text == nullptr) fail("expected a text in quotes");
  const std::string& value = text->get();
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; };
  if (std::any_of(value.begin(), value.end(), is_control)) {
    fail("expected one line without control characters");
  }
  return value;
}

std::string TomlValue::identifier() const {
  const std::string value = text();
  if (!is_identifier(value)) {
    fail(fmt::format("expected a name of 1 to {} letters, digits, '_' and '-'",
                     kMaxIdentifierLength));
  }
  return value;
}

std::size_t TomlValue::choice(Keys choices, std::string_view what) const {
  const auto* text = node_->as_string();
  if (text == nullptr) fail(fmt::format("expected one of {}", fmt::join(choices, ", ")));
  const auto found = std::find(choices.begin(), choices.end(), text->get());
  if (found == choices.end())
    fail(fmt::format("unknown {}{}", what, suggestion(text->get(), choices)));
  return static_cast<std::size_t>(found - choices.begin());
}

Vector3<double> TomlValue::vector(std::string_view unit) const {
  const std::string entry = unit == "1" ? "1" : fmt::format("\"1 {}\"", unit);
  const std::string expected = fmt::format("an array of 3 such as [{0}, {0}, {0}]", entry);
  const std::vector<TomlValue> entries = items(expected, 3);
  return {entries[0].quantity(unit), entries[1].quantity(unit), entries[2].quantity(unit)};
}

std::vector<TomlValue> TomlValue::items(std::string_view expected,
                                        std::optional<std::size_t> count) const {
  const toml::array* array = node_->as_array();
  if (array == nullptr) fail(fmt::format("expected {}", expected));
  if (count && array->size() != *count) {
    fail(fmt::format("has {} entries, expected {}", array->size(), expected));
  }
  std::vector<TomlValue> values;
  values.reserve(array->size());
  for (const toml::node& entry : *array) {
    values.emplace_back(*source_, fmt::format("{}[{}]", path_, values.size()), entry);
  }
  return values;
}

TomlTable TomlValue::table(std::string_view expected) const {
  const toml::table* table = node_->as_table();
  if (table == nullptr) fail(fmt::format("expected {}", expected));
  return {*source_, path_, *table};
}

void TomlTable::fail(const std::string& message) const {
  throw error_at(source_->name, table_->source(), path_.empty() ? message : path_ + ": " + message);
}

void TomlTable::allow(Keys keys) const {
  // In the order of the text, not of the alphabet: people fix the first mistake first.
  const toml::key* unknown = nullptr;
  for (const auto& [key, node] : *table_) {
    if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
    const toml::source_position& place = key.source().begin;
    if (unknown == nullptr || place < unknown->source().begin) unknown = &key;
  }
  if (unknown == nullptr) return;
  throw error_at(source_->name, unknown->source(),
                 fmt::format("{}: unknown key{}", child_path(unknown->str()),
                             suggestion(unknown->str(), keys)));
}

std::optional<TomlValue> TomlTable::find(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  return TomlValue(*source_, child_path(key), *node);
}

TomlValue TomlTable::require(std::string_view key, const std::string& expected) const {
  std::optional<TomlValue> value = find(key);
  if (!value) fail(fmt::format("missing key '{}', expected {}", key, expected));
  return *value;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  std::vector<TomlTable> result;
  const toml::node* node = table_->get(key);
  if (node == nullptr) return result;
  const std::string path = child_path(key);
  const std::string expected = fmt::format("{} {} written [[{}]]", article(key), key, path);
  const TomlValue value(*source_, path, *node);
  for (const TomlValue& entry : value.items(expected)) {
    result.push_back(entry.table(expected));
    result.back().path_ = path;
  }
  return result;
}

std::string TomlTable::child_path(std::string_view key) const {
  const std::string name = shown(key);
  return path_.empty() ? name : path_ + "." + name;
}

}  // namespace weft::scenes
