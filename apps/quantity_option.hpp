#pragma once

#include <string>
#include <string_view>

namespace weft::app {

/// The SI value of what an option was given, such as "0.5 s" for a time; unit: "s", "m" ...
/// @throws InvalidArgument that names the option, its text and what was expected.
[[nodiscard]] double quantity_option(std::string_view option, const std::string& text,
                                     std::string_view unit);

}  // namespace weft::app
