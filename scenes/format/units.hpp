#pragma once

#include <string>
#include <string_view>

#include <weft/core/error.hpp>

namespace weft::scenes {

/// Exponents of metre, kilogram and second. Angles have no dimension.
struct Dimension {
  int length = 0;
  int mass = 0;
  int time = 0;
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// A unit: a number in it has the SI value number * 10^decimal_exponent * factor.
/// The power of ten is kept apart so that "7 cm" becomes 0.07 with one rounding.
struct Unit {
  Dimension dimension;
  int decimal_exponent = 0;
  double factor = 1.0;  ///< 1 but for degrees
};

/// A quantity or unit that cannot be used. what() says what was expected, not where.
class UnitError : public InvalidArgument {
 public:
  using InvalidArgument::InvalidArgument;
};

/// Reads "N*s/m", "1/s", "g/m^2", "N/(m*rad)": symbols m g s N J W Pa Hz rad deg 1, SI prefixes f
/// to T, * / ^ and parentheses. "N/m*s" is refused because people read it in two ways. Throws
/// UnitError.
[[nodiscard]] Unit parse_unit(std::string_view text);

/// "length", "stiffness"; empty if the dimension has no name here. unit tells "angle" from a plain
/// number.
[[nodiscard]] std::string_view dimension_name(const Dimension& dimension, std::string_view unit);

/// "kg m/s^2"; "1" without dimension.
[[nodiscard]] std::string base_units(const Dimension& dimension);

}  // namespace weft::scenes
