#include "apps/quantity_option.hpp"

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/quantity.hpp>

namespace weft::app {

double quantity_option(std::string_view option, const std::string& text, std::string_view unit) {
  try {
    return scenes::parse_quantity(text, unit);
  } catch (const scenes::UnitError& error) {
    throw InvalidArgument(fmt::format("{} \"{}\": {}", option, text, error.what()));
  }
}

}  // namespace weft::app
