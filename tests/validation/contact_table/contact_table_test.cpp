#include <weft/validation/contact_table/contact_table.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <weft/engines/engine_table.hpp>

namespace weft::validation {
namespace {

constexpr double kSlow = 1.0 / 240.0;  // [s]

ContactTarget target(const std::string& name) {
  for (const ContactTarget& one : contact_targets()) {
    if (one.name == name) return one;
  }
  throw std::out_of_range(name);
}

ContactRow measure(const std::string& name, double time_step, double speed,
                   const ContactSabotage& sabotage = {}) {
  const auto engine = scenes::find_engine("bullet_soft", scenes::StoredPrecision::kFloat32)->make();
  return measure_contact(*engine, target(name), time_step, speed, sabotage);
}

/// The committed row of a target, time step and speed; deepest [m] and tunnelled.
std::pair<double, int> committed(const std::string& name, double time_step, double speed) {
  std::ifstream file(std::string(WEFT_SOURCE_DIR) + "/bench/results/contact_table.csv");
  std::ostringstream start;
  start.precision(6);
  start << '"' << name << "\"," << std::fixed << time_step << ',' << std::defaultfloat << speed
        << ',';
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(start.str())) continue;
    std::istringstream rest(line.substr(start.str().size()));
    double nodes = 0;
    double deepest = 0;
    double at_end = 0;
    double tunnelled = 0;
    char comma = 0;
    rest >> nodes >> comma >> deepest >> comma >> at_end >> comma >> tunnelled;
    return {1e-3 * deepest, static_cast<int>(tunnelled)};
  }
  ADD_FAILURE() << "no committed row " << start.str();
  return {0, 0};
}

TEST(ContactTable, CommittedNumbersAreThoseOfThisProgram) {
  // Other processors round differently, and folds amplify it: the same order of magnitude.
  constexpr double kFactor = 2.0;
  constexpr double kSmall = 0.005;  // [m] a quarter of the margin
  for (const char* name : {"sphere", "box", "compound", "sphere, kinematic"}) {
    for (const double speed : {1.0, 20.0}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(speed));
      const ContactRow row = measure(name, kSlow, speed);
      const auto [deepest, tunnelled] = committed(name, kSlow, speed);
      EXPECT_LE(row.deepest, kFactor * deepest + kSmall);
      EXPECT_GE(row.deepest, deepest / kFactor - kSmall);
      EXPECT_LE(row.num_tunnelled, 2 * tunnelled + 10);
      EXPECT_GE(row.num_tunnelled, tunnelled / 2 - 10);
    }
  }
}

TEST(ContactTable, ASlowClothStaysOutsideEveryConvexShape) {
  for (const char* name : {"plane", "sphere", "box", "capsule", "cylinder"}) {
    const ContactRow row = measure(name, kSlow, 1.0);
    EXPECT_FALSE(row.blew_up) << name;
    EXPECT_EQ(row.num_tunnelled, 0) << name;
    EXPECT_LT(row.deepest, 0.01) << name;
  }
}

TEST(ContactTable, TheFastSolverKeepsAFastClothOutside) {
  const auto engine = scenes::find_engine("bullet_weft", scenes::StoredPrecision::kFloat32)->make();
  for (const ContactTarget& one : contact_targets()) {
    const ContactRow row = measure_contact(*engine, one, 1.0 / 60, 20.0);
    EXPECT_FALSE(row.blew_up) << one.name;
    EXPECT_EQ(row.num_tunnelled, 0) << one.name;
    EXPECT_LT(row.deepest, 0.002) << one.name;  // [m] a tenth of the margin; measured 0
  }
}

TEST(ContactTable, ColliderOutOfReachIsNoticed) {
  const ContactRow row = measure("sphere", kSlow, 5.0, {.no_contact = true});
  EXPECT_GT(row.num_tunnelled, 50);
  EXPECT_GT(row.deepest, 0.1);
}

TEST(ContactTable, AMissingMarginIsNoticed) {
  EXPECT_GT(measure("box", kSlow, 1.0, {.no_margin = true}).deepest,
            measure("box", kSlow, 1.0).deepest + 0.002);
}

}  // namespace
}  // namespace weft::validation
