#pragma once

// Tested by tests/scenes/format/units_test.cpp.

#include <string>
#include <string_view>

#include <weft/scenes/format/units.hpp>

namespace weft::scenes {

/// A value in SI units (rad for angles) with its dimension.
struct Quantity {
  double value;
  Dimension dimension;
};

/// Reads "7 m", "1/100 s", "-9.81 m/s^2", "35 deg". Decimals and fractions of whole numbers are
/// rounded once, also with a prefix: "1/100 s" is 0.01 and "7 cm" is 0.07. Only degrees take a
/// second rounding. Throws UnitError; NaN, infinity and values out of the range of double are
/// errors.
[[nodiscard]] Quantity parse_quantity(std::string_view text);

/// The SI value of a quantity that must have the dimension of unit, "N/m" say. Throws UnitError.
[[nodiscard]] double parse_quantity(std::string_view text, std::string_view unit);

/// "a length such as \"2 m\"", for messages.
[[nodiscard]] std::string expected_quantity(std::string_view unit, std::string_view number = "2");

/// "0.01 s" for an SI value. Shortest text that parse_quantity reads back to the same bits.
[[nodiscard]] std::string format_quantity(double value, std::string_view si_unit);

}  // namespace weft::scenes
