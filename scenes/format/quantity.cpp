#include <weft/scenes/format/quantity.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace weft::scenes {
namespace {

// Whole numbers up to here, and powers of ten up to 10^22, are exact in double precision.
constexpr std::uint64_t kMaxExactInteger = std::uint64_t{1} << 53;
// Decimal digits beyond this do not change a double; the limit keeps hostile text cheap.
constexpr std::size_t kMaxNumberLength = 400;
// Any exponent beyond this is out of range whatever the digits are.
constexpr int kMaxDecimalExponent = 10'000;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::size_t skip_digits(std::string_view text, std::size_t from) {
  while (from < text.size() && is_digit(text[from])) ++from;
  return from;
}

/// A number as written: sign, then a decimal "7.5e3" or a fraction "1/100".
struct Number {
  bool negative = false;
  std::string_view digits;       ///< "7.5" or "1"
  int exponent = 0;              ///< 3
  std::string_view denominator;  ///< "100"; empty for a decimal
};

/// The exponent after the digits, 0 if there is none; nullopt if it is malformed.
std::optional<int> scan_exponent(std::string_view text) {
  if (text.empty()) return 0;
  if (text[0] != 'e' && text[0] != 'E') return std::nullopt;
  const bool negative = text.size() > 1 && text[1] == '-';
  const std::size_t begin = text.size() > 1 && (text[1] == '-' || text[1] == '+') ? 2 : 1;
  if (begin == text.size() || skip_digits(text, begin) != text.size()) return std::nullopt;
  int exponent = 0;
  for (const char c : text.substr(begin)) {
    exponent = std::min(10 * exponent + (c - '0'), kMaxDecimalExponent);
  }
  return negative ? -exponent : exponent;
}

std::optional<Number> scan_number(std::string_view text) {
  Number number;
  if (text.size() > kMaxNumberLength) return std::nullopt;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    number.negative = text[0] == '-';
    text.remove_prefix(1);
  }
  std::size_t end = skip_digits(text, 0);
  if (end == 0) return std::nullopt;
  if (end < text.size() && text[end] == '/') {
    number.digits = text.substr(0, end);
    number.denominator = text.substr(end + 1);
    const bool whole = !number.denominator.empty() &&
                       skip_digits(number.denominator, 0) == number.denominator.size();
    return whole ? std::optional(number) : std::nullopt;
  }
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = end + 1;
    end = skip_digits(text, fraction);
    if (end == fraction) return std::nullopt;
  }
  number.digits = text.substr(0, end);
  const std::optional<int> exponent = scan_exponent(text.substr(end));
  if (!exponent) return std::nullopt;
  number.exponent = *exponent;
  return number;
}

double decimal_value(const Number& number, int decimal_exponent) {
  const std::string text = fmt::format("{}e{}", number.digits, number.exponent + decimal_exponent);
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || !std::isfinite(value)) {
    throw UnitError("is out of the range of double precision, expected a number up to 1e308");
  }
  return value;
}

std::uint64_t whole_number(std::string_view digits) {
  std::uint64_t value = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (result.ec != std::errc() || value > kMaxExactInteger) {
    throw UnitError("fraction has too many digits, expected whole numbers up to 2^53");
  }
  return value;
}

double fraction_value(const Number& number, int decimal_exponent) {
  std::uint64_t over = whole_number(number.digits);
  std::uint64_t under = whole_number(number.denominator);
  if (under == 0) throw UnitError("fraction divides by zero, expected a denominator > 0");
  // The power of ten goes into whichever side keeps it whole: one division then rounds once.
  std::uint64_t& side = decimal_exponent < 0 ? under : over;
  int left = std::abs(decimal_exponent);
  while (left > 0 && side <= kMaxExactInteger / 10) {
    side *= 10;
    --left;
  }
  const double value = static_cast<double>(over) / static_cast<double>(under);
  return left == 0 ? value : value * std::pow(10.0, decimal_exponent < 0 ? -left : left);
}

bool starts_like_number(std::string_view text) {
  return !text.empty() && (is_digit(text[0]) || (text.size() > 1 && is_digit(text[1]) &&
                                                 (text[0] == '-' || text[0] == '+')));
}

/// The shared part of both readers; expected says what goes into messages.
Quantity read(std::string_view text, const std::string& expected, std::string_view unit_hint) {
  const std::size_t space = text.find(' ');
  const std::string_view number_text = text.substr(0, space);
  const std::optional<Number> number = scan_number(number_text);
  if (!number) {
    if (space == std::string_view::npos && starts_like_number(text)) {
      throw UnitError("expected a space between number and unit, " + expected);
    }
    throw UnitError("expected " + expected);
  }
  if (space == std::string_view::npos) {
    const std::string hint =
        unit_hint.empty() ? expected : expected_quantity(unit_hint, number_text);
    throw UnitError("missing unit, expected " + hint);
  }
  Unit unit;
  try {
    unit = parse_unit(text.substr(space + 1));
  } catch (const UnitError& error) {
    if (std::string_view(error.what()).starts_with("ambiguous")) throw;
    throw UnitError(std::string(error.what()) + ", expected " + expected);
  }
  double value = number->denominator.empty() ? decimal_value(*number, unit.decimal_exponent)
                                             : fraction_value(*number, unit.decimal_exponent);
  value = (number->negative ? -value : value) * unit.factor;
  if (!std::isfinite(value)) throw UnitError("is not finite, expected " + expected);
  return {value, unit.dimension};
}

}  // namespace

Quantity parse_quantity(std::string_view text) {
  return read(text, "a number with its unit such as \"7 m\"", {});
}

double parse_quantity(std::string_view text, std::string_view unit) {
  const Quantity quantity = read(text, expected_quantity(unit), unit);
  const Dimension wanted = parse_unit(unit).dimension;
  if (quantity.dimension != wanted) {
    const std::string_view is = dimension_name(quantity.dimension, {});
    const std::string_view expected = dimension_name(wanted, unit);
    throw UnitError(fmt::format("wrong unit, is {}{}[{}], expected {}{}[{}]", is,
                                is.empty() ? "" : " ", base_units(quantity.dimension), expected,
                                expected.empty() ? "" : " ", unit));
  }
  return quantity.value;
}

std::string expected_quantity(std::string_view unit, std::string_view number) {
  if (unit == "rad") return "an angle such as \"30 deg\"";
  const std::string_view name = dimension_name(parse_unit(unit).dimension, unit);
  if (name.empty()) return fmt::format("a quantity such as \"{} {}\"", number, unit);
  const bool vowel = std::string_view("aeiou").find(name[0]) != std::string_view::npos;
  return fmt::format("{} {} such as \"{} {}\"", vowel ? "an" : "a", name, number, unit);
}

std::string format_quantity(double value, std::string_view si_unit) {
  return fmt::format("{} {}", value, si_unit);
}

}  // namespace weft::scenes
