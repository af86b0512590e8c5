#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/scenes/format/quantity.hpp>
#include <weft/scenes/format/units.hpp>

namespace weft::scenes {
namespace {

using ::testing::HasSubstr;

struct Row {
  std::string text;
  std::string unit;
  double value;  // the literal is the correctly rounded value: comparisons are exact
};

TEST(Units, QuantitiesHaveTheirSiValue) {
  const std::vector<Row> rows = {{"7 m", "m", 7.0},
                                 {"-9.81 m/s^2", "m/s^2", -9.81},
                                 {"+1.5e3 mm", "m", 1.5},
                                 {"120 g/m^2", "kg/m^2", 0.12},
                                 {"8.0 uN*m", "N*m", 8.0e-6},
                                 {"8.0 \xC2\xB5N*m", "J", 8.0e-6},
                                 {"2 cm", "m", 0.02},
                                 {"0.3 N*s/m", "N*s/m", 0.3},
                                 {"1.5 N/(m*rad)", "N/m", 1.5},
                                 {"2 1/s", "1/s", 2.0},
                                 {"30 Hz", "1/s", 30.0},
                                 {"3 kPa", "N/m^2", 3000.0},
                                 {"4 mW", "N*m/s", 0.004},
                                 {"5 s^-1", "1/s", 5.0},
                                 {"6 cm^2", "m^2", 6e-4},
                                 {"90 km", "m", 90000.0},
                                 {"2 g", "kg", 0.002},
                                 {"12 ms", "s", 0.012},
                                 {"1 (N/m)*s", "kg/s", 1.0}};
  for (const Row& row : rows) {
    EXPECT_EQ(parse_quantity(row.text, row.unit), row.value) << row.text;
  }
}

TEST(Units, FractionsAndPrefixesRoundOnce) {
  EXPECT_EQ(parse_quantity("1/100 s", "s"), 0.01);
  EXPECT_EQ(parse_quantity("1/3 s", "s"), 1.0 / 3.0);
  EXPECT_EQ(parse_quantity("-1/3 km", "m"), -1000.0 / 3.0);
  EXPECT_EQ(parse_quantity("10/7 ms", "s"), 1.0 / 700.0);
  // 7 * 0.01 is 0.07000000000000001 in double precision.
  EXPECT_EQ(parse_quantity("7 cm", "m"), 0.07);
}

TEST(Units, DegreesBecomeRadians) {
  EXPECT_DOUBLE_EQ(parse_quantity("180 deg", "rad"), std::numbers::pi);
  EXPECT_EQ(parse_quantity("0.5 rad", "rad"), 0.5);
  EXPECT_DOUBLE_EQ(parse_quantity("90 deg/s", "rad/s"), std::numbers::pi / 2);
}

TEST(Units, DimensionsAreExponentsOfMetreKilogramSecond) {
  EXPECT_EQ(parse_quantity("1 N").dimension, (Dimension{1, 1, -2}));
  EXPECT_EQ(parse_quantity("1 J").dimension, parse_quantity("1 N*m").dimension);
  EXPECT_EQ(parse_quantity("1 W").dimension, (Dimension{2, 1, -3}));
  EXPECT_EQ(parse_quantity("1 rad").dimension, Dimension{});
  EXPECT_EQ(base_units({1, 1, -2}), "kg m/s^2");
  EXPECT_EQ(base_units({-1, 1, -2}), "kg/(m s^2)");
  EXPECT_EQ(base_units({0, 0, -1}), "1/s");
  EXPECT_EQ(base_units({}), "1");
}

std::string message_of(const std::string& text, const std::string& unit) {
  try {
    const double value = parse_quantity(text, unit);
    return "no error, value " + std::to_string(value);
  } catch (const UnitError& error) {
    return error.what();
  }
}

TEST(Units, ErrorsSayWhatWasExpected) {
  struct Case {
    std::string text, unit, message;
  };
  const std::vector<Case> cases = {
      {"7", "m", "missing unit, expected a length such as \"7 m\""},
      {"7m", "m", "expected a space between number and unit, a length such as \"2 m\""},
      {"", "m", "expected a length such as \"2 m\""},
      {" ", "m", "expected a length such as \"2 m\""},
      {"m", "m", "expected a length such as \"2 m\""},
      {"2 mm/foo", "m", "unknown unit 'mm/foo', expected a length such as \"2 m\""},
      {"1 kg", "m", "wrong unit, is mass [kg], expected length [m]"},
      {"5 N", "N/m", "wrong unit, is force [kg m/s^2], expected stiffness [N/m]"},
      {"1 N/m*s", "kg/s", "ambiguous unit 'N/m*s'"},
      {"nan m", "m", "expected a length"},
      {"inf m", "m", "expected a length"},
      {"0x10 m", "m", "expected a length"},
      {"1. m", "m", "expected a length"},
      {".5 m", "m", "expected a length"},
      {"1e m", "m", "expected a length"},
      {"1/2/3 m", "m", "expected a length"},
      {"1/0 m", "m", "divides by zero"},
      {"1e999 m", "m", "out of the range"},
      {"1e99999999999999999999 m", "m", "out of the range"},
      {"99999999999999999999/3 m", "m", "too many digits"},
      {"2  m", "m", "unknown unit ' m'"},
      {"2 m^0", "m", "unknown unit"},
      {"2 m^", "m", "unknown unit"},
      {"2 (m", "m", "unknown unit"},
      {"2 ((((((m))))))", "m", "unknown unit"},
      {"2 m)", "m", "unknown unit"},
      {"2 kdeg", "rad", "unknown unit 'kdeg', expected an angle such as \"30 deg\""},
      {"2 m", "rad", "wrong unit, is length [m], expected angle [rad]"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(message_of(c.text, c.unit), HasSubstr(c.message)) << "'" << c.text << "'";
  }
}

TEST(Units, WrittenValuesReadBackToTheSameBits) {
  using Limits = std::numeric_limits<double>;
  const std::vector<double> values = {0.01,
                                      1.0 / 3.0,
                                      -9.81,
                                      -0.0,
                                      Limits::max(),
                                      Limits::min(),
                                      1e22,
                                      0.1 + 0.2,
                                      std::numbers::pi,
                                      5e-324,
                                      123456789012345.6,
                                      Limits::epsilon(),
                                      0.07 * 1.0001,
                                      1e-5,
                                      1e16};
  for (const double value : values) {
    const double back = parse_quantity(format_quantity(value, "N/m"), "N/m");
    EXPECT_EQ(std::memcmp(&back, &value, sizeof value), 0) << value;
  }
  EXPECT_EQ(format_quantity(0.01, "s"), "0.01 s");
}

}  // namespace
}  // namespace weft::scenes
