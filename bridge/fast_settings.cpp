#include <weft/bridge/fast_settings.hpp>

#include <cmath>
#include <string>

#include <weft/core/error.hpp>

namespace weft::bridge {
namespace {

[[noreturn]] void refuse(const char* name, const std::string& value, const char* expected) {
  throw InvalidArgument("fast settings: " + std::string(name) + " = " + value + ", expected " +
                        expected);
}

void require_positive(const char* name, int value) {
  if (value < 1) refuse(name, std::to_string(value), ">= 1");
}

void require_not_negative(const char* name, double value, const char* unit) {
  if (std::isfinite(value) && value >= 0) return;
  refuse(name, std::to_string(value) + " [" + unit + "]", ">= 0 and finite");
}

}  // namespace

void check(const FastSettings& settings) {
  require_positive("solver.newton_iterations", settings.solver.newton_iterations);
  require_positive("solver.linear_iterations", settings.solver.linear_iterations);
  require_not_negative("sleep_speed", settings.sleep_speed, "m/s");
  require_not_negative("sleep_time", settings.sleep_time, "s");
}

}  // namespace weft::bridge
