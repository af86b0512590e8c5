#include <weft/scenes/format/scene_text.hpp>

#include <cmath>

#include <fmt/format.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/quantity.hpp>

namespace weft::scenes {

std::string value_text(double value, std::string_view unit) {
  if (!std::isfinite(value)) {
    throw InvalidArgument(
        fmt::format("write_scene: a value = {} [{}], expected finite", value, unit));
  }
  return unit == "1" ? toml_number(value) : "\"" + format_quantity(value, unit) + "\"";
}

std::string vector_text(const Vector3<double>& vector, std::string_view unit) {
  return fmt::format("[{}, {}, {}]", value_text(vector.x(), unit), value_text(vector.y(), unit),
                     value_text(vector.z(), unit));
}

std::string orientation_text(const Eigen::Quaterniond& orientation) {
  return fmt::format("{{ quaternion = [{}, {}, {}, {}] }}", value_text(orientation.w(), "1"),
                     value_text(orientation.x(), "1"), value_text(orientation.y(), "1"),
                     value_text(orientation.z(), "1"));
}

void line(std::string& out, std::string_view key, const std::string& value) {
  out += fmt::format("{} = {}\n", key, value);
}

}  // namespace weft::scenes
