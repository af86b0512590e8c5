#include <weft/bridge/link_stiffness.hpp>

#include <cmath>
#include <string>

#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

void check(const LinkContext& context) {
  const auto refuse = [](const std::string& what) {
    throw InvalidArgument("link stiffness: " + what);
  };
  if (!(context.reduced_mass > 0) || !std::isfinite(context.reduced_mass)) {
    refuse("reduced_mass = " + std::to_string(context.reduced_mass) +
           " [kg], expected > 0 and finite");
  }
  if (context.iterations < 1) {
    refuse("iterations = " + std::to_string(context.iterations) + ", expected >= 1");
  }
  if (!(context.time_step > 0) || !std::isfinite(context.time_step)) {
    refuse("time_step = " + std::to_string(context.time_step) + " [s], expected > 0 and finite");
  }
}

}  // namespace

double link_factor_from_stiffness(double stiffness, const LinkContext& context) {
  check(context);
  if (!(stiffness >= 0) || !std::isfinite(stiffness)) {
    throw InvalidArgument("link stiffness: stiffness = " + std::to_string(stiffness) +
                          " [N/m], expected >= 0 and finite");
  }
  const double ratio = stiffness * context.time_step * context.time_step / context.reduced_mass;
  // 1 - (1 + r)^(-1/n) without the cancellation for small r
  return -std::expm1(-std::log1p(ratio) / context.iterations);
}

double stiffness_from_link_factor(double link_factor, const LinkContext& context) {
  check(context);
  if (!(link_factor >= 0 && link_factor < 1)) {
    throw InvalidArgument("link stiffness: link_factor = " + std::to_string(link_factor) +
                          " [1], expected >= 0 and < 1");
  }
  const double ratio = std::expm1(-context.iterations * std::log1p(-link_factor));
  return ratio * context.reduced_mass / (context.time_step * context.time_step);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
