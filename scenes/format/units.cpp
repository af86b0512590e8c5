#include <weft/scenes/format/units.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

namespace weft::scenes {
namespace {

struct Symbol {
  std::string_view name;
  Unit unit;
  bool prefixable;
};

// The gram carries 10^-3, so that kg comes out as 10^0 with its prefix.
constexpr std::array<Symbol, 11> kSymbols = {{
    {"m", {{1, 0, 0}, 0, 1.0}, true},
    {"g", {{0, 1, 0}, -3, 1.0}, true},
    {"s", {{0, 0, 1}, 0, 1.0}, true},
    {"N", {{1, 1, -2}, 0, 1.0}, true},
    {"J", {{2, 1, -2}, 0, 1.0}, true},
    {"W", {{2, 1, -3}, 0, 1.0}, true},
    {"Pa", {{-1, 1, -2}, 0, 1.0}, true},
    {"Hz", {{0, 0, -1}, 0, 1.0}, true},
    {"rad", {{0, 0, 0}, 0, 1.0}, true},
    {"deg", {{0, 0, 0}, 0, std::numbers::pi / 180.0}, false},
    {"1", {{0, 0, 0}, 0, 1.0}, false},
}};

struct Prefix {
  std::string_view name;
  int exponent;
};
// Both spellings of micro: the sign on most keyboards (U+00B5) and the letter u.
constexpr std::array<Prefix, 14> kPrefixes = {{{"T", 12},
                                               {"G", 9},
                                               {"M", 6},
                                               {"k", 3},
                                               {"h", 2},
                                               {"da", 1},
                                               {"d", -1},
                                               {"c", -2},
                                               {"m", -3},
                                               {"u", -6},
                                               {"\xC2\xB5", -6},
                                               {"n", -9},
                                               {"p", -12},
                                               {"f", -15}}};

struct NamedDimension {
  std::string_view name;
  Dimension dimension;
};
constexpr std::array<NamedDimension, 17> kNames = {{
    {"number", {0, 0, 0}},
    {"length", {1, 0, 0}},
    {"area", {2, 0, 0}},
    {"mass", {0, 1, 0}},
    {"time", {0, 0, 1}},
    {"rate", {0, 0, -1}},
    {"velocity", {1, 0, -1}},
    {"acceleration", {1, 0, -2}},
    {"force", {1, 1, -2}},
    {"stiffness", {0, 1, -2}},
    {"damping", {0, 1, -1}},
    {"energy or torque", {2, 1, -2}},
    {"power", {2, 1, -3}},
    {"pressure", {-1, 1, -2}},
    {"areal density", {-2, 1, 0}},
    {"density", {-3, 1, 0}},
    {"viscosity", {-1, 1, -1}},
}};

std::optional<Unit> find_symbol(std::string_view text) {
  for (const Symbol& symbol : kSymbols) {
    if (symbol.name == text) return symbol.unit;
  }
  for (const Symbol& symbol : kSymbols) {
    if (!symbol.prefixable || !text.ends_with(symbol.name)) continue;
    const std::string_view prefix_name = text.substr(0, text.size() - symbol.name.size());
    for (const Prefix& prefix : kPrefixes) {
      if (prefix.name != prefix_name) continue;
      Unit unit = symbol.unit;
      unit.decimal_exponent += prefix.exponent;
      return unit;
    }
  }
  return std::nullopt;
}

// Longer units and deeper nesting are nonsense; the limits keep hostile text cheap.
constexpr std::size_t kMaxUnitLength = 64;
constexpr int kMaxParentheses = 4;
constexpr int kMaxExponent = 9;

class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  Unit parse() {
    if (text_.empty() || text_.size() > kMaxUnitLength) unknown();
    const Unit unit = product(0);
    if (position_ != text_.size()) unknown();
    return unit;
  }

 private:
  [[noreturn]] void unknown() const {
    throw UnitError("unknown unit '" + std::string(text_.substr(0, kMaxUnitLength)) + "'");
  }

  bool take(char c) {
    if (position_ == text_.size() || text_[position_] != c) return false;
    ++position_;
    return true;
  }

  static void multiply(Unit& unit, const Unit& by, int power) {
    unit.dimension.length += power * by.dimension.length;
    unit.dimension.mass += power * by.dimension.mass;
    unit.dimension.time += power * by.dimension.time;
    unit.decimal_exponent += power * by.decimal_exponent;
    unit.factor *= std::pow(by.factor, power);
  }

  Unit product(int depth) {
    Unit unit;
    multiply(unit, factor(depth), 1);
    bool divided = false;
    while (position_ < text_.size() && text_[position_] != ')') {
      const bool divide = text_[position_] == '/';
      if (!divide && text_[position_] != '*') unknown();
      if (divided) {
        throw UnitError("ambiguous unit '" + std::string(text_) +
                        "', expected parentheses after '/' such as 'N/(m*rad)'");
      }
      ++position_;
      divided = divide;
      multiply(unit, factor(depth), divide ? -1 : 1);
    }
    return unit;
  }

  Unit factor(int depth) {
    Unit base;
    if (take('(')) {
      if (depth == kMaxParentheses) unknown();
      base = product(depth + 1);
      if (!take(')')) unknown();
    } else {
      const std::size_t end = text_.find_first_of("*/^()", position_);
      const std::string_view name = text_.substr(position_, end - position_);
      const std::optional<Unit> unit = find_symbol(name);
      if (!unit) unknown();
      base = *unit;
      position_ += name.size();
    }
    if (!take('^')) return base;
    Unit power;
    multiply(power, base, exponent());
    return power;
  }

  int exponent() {
    const int sign = take('-') ? -1 : 1;
    if (position_ == text_.size()) unknown();
    const int digit = text_[position_++] - '0';
    if (digit < 1 || digit > kMaxExponent) unknown();
    return sign * digit;
  }

  std::string_view text_;
  std::size_t position_ = 0;
};

void append_power(std::string& text, std::string_view symbol, int exponent) {
  if (exponent == 0) return;
  if (!text.empty() && text.back() != '/') text += ' ';
  text += symbol;
  if (exponent != 1) text += "^" + std::to_string(exponent);
}

}  // namespace

Unit parse_unit(std::string_view text) {
  return UnitParser(text).parse();
}

std::string_view dimension_name(const Dimension& dimension, std::string_view unit) {
  if (unit == "rad") return "angle";
  if (unit == "rad/s") return "angular velocity";
  for (const NamedDimension& named : kNames) {
    if (named.dimension == dimension) return named.name;
  }
  return {};
}

std::string base_units(const Dimension& dimension) {
  const std::array<std::pair<std::string_view, int>, 3> parts = {
      {{"kg", dimension.mass}, {"m", dimension.length}, {"s", dimension.time}}};
  std::string over;
  std::string under;
  int num_under = 0;
  for (const auto& [symbol, exponent] : parts) {
    append_power(over, symbol, exponent > 0 ? exponent : 0);
    append_power(under, symbol, exponent < 0 ? -exponent : 0);
    num_under += exponent < 0 ? 1 : 0;
  }
  if (over.empty()) over = "1";
  if (under.empty()) return over;
  return over + "/" + (num_under > 1 ? "(" + under + ")" : under);
}

}  // namespace weft::scenes
