#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/validation/report/formats/base64.hpp>
#include <weft/validation/report/formats/distance_view_json.hpp>
#include <weft/validation/report/formats/quantized.hpp>

#include "tests/validation/report/sample_distance_view.hpp"

namespace weft::validation {
namespace {

double back(const Quantized& values, std::size_t i) {
  const auto byte = [&](std::size_t at) {
    return static_cast<unsigned>(static_cast<unsigned char>(values.bytes[at]));
  };
  const unsigned step = byte(2 * i) | byte(2 * i + 1) << 8U;
  return step == 65535U ? std::nan("")
                        : values.lowest + step * (values.highest - values.lowest) / 65534.0;
}

TEST(Quantized, ComesBackWithinHalfAStep) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(-3.0 + 7.0 * std::sin(0.37 * i));
  const Quantized small = quantize(values);
  ASSERT_EQ(small.bytes.size(), 2000U);
  // Half a step, and the rounding of the two operations that bring it back.
  const double half = 0.5 * (small.highest - small.lowest) / 65534.0 * (1 + 1e-9);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(back(small, i), values[i], half);
}

TEST(Quantized, EndsOfTheRangeAreExact) {
  const Quantized small = quantize(std::vector<double>{2.5, -1.25, 0.0});
  EXPECT_EQ(back(small, 0), 2.5);
  EXPECT_EQ(back(small, 1), -1.25);
}

TEST(Quantized, NumbersThatAreNotFiniteStayMarked) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Quantized small = quantize(std::vector<double>{1.0, std::nan(""), infinity, 2.0});
  EXPECT_EQ(small.highest, 2.0);
  EXPECT_TRUE(std::isnan(back(small, 1)));
  EXPECT_TRUE(std::isnan(back(small, 2)));
  EXPECT_EQ(back(small, 3), 2.0);
}

TEST(Quantized, EqualNumbersComeBack) {
  EXPECT_EQ(back(quantize(std::vector<double>{0.3, 0.3}), 1), 0.3);
  EXPECT_EQ(quantize(std::vector<double>{}).bytes, "");
}

TEST(Quantized, ValuesBeyondAGivenRangeTakeItsEnd) {
  const Quantized small = quantize(std::vector<double>{-1.0, 9.0}, 0.0, 4.0);
  EXPECT_EQ(back(small, 0), 0.0);
  EXPECT_EQ(back(small, 1), 4.0);
  EXPECT_THROW((void)quantize(std::vector<double>{1.0}, 1.0, 0.0), InvalidArgument);
}

TEST(DistanceViewJson, HoldsEveryFrameOfEveryEngine) {
  const DistanceView view = tests::sample_distance_view();
  const nlohmann::ordered_json json = distance_view_json(view);
  EXPECT_EQ(json["simulated_nodes"], 2401);
  ASSERT_EQ(json["positions"].size(), view.times.size());
  EXPECT_EQ(json["positions"][3]["steps_base64"], to_base64(view.positions[3].bytes));
  EXPECT_EQ(json["positions"][3]["highest"].get<double>(), view.positions[3].highest);
  ASSERT_EQ(json["engines"].size(), 2U);
  EXPECT_EQ(json["engines"][0]["largest"][2].get<double>(), view.engines[0].largest[2]);
  EXPECT_EQ(json["engines"][0]["distances"][2]["steps_base64"],
            to_base64(view.engines[0].distances[2].bytes));
  EXPECT_EQ(json["engines"][1]["largest"].back(), "NaN");
  EXPECT_EQ(json["engines"][1]["distances"].back()["steps_base64"], "");
  EXPECT_EQ(json["bodies"][0]["shape"], "sphere");
  EXPECT_EQ(json["bodies"][1]["poses"][5][1].get<double>(), -0.5);
  // Node 25 is the second corner of the first triangle.
  EXPECT_EQ(json["triangles_base64"].get<std::string>().substr(0, 8),
            to_base64(std::string("\0\0\x19\0\1\0", 6)));
}

}  // namespace
}  // namespace weft::validation
