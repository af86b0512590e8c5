#include <weft/viewer/model/law_edit.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::viewer {
namespace {

/// Laws do not act on a cloth that the bones of a character lead.
bool has_laws(const scenes::Cloth& cloth) {
  const auto* skin = std::get_if<scenes::SkinSource>(&cloth.source);
  return skin == nullptr || skin->is_cloth;
}

forces::LawSpecification* find_law(scenes::Cloth& cloth, std::string_view id) {
  for (forces::LawSpecification& law : cloth.laws) {
    if (law.law == id) return &law;
  }
  return nullptr;
}

Vector3<double> vector_of(const forces::LawSpecification& law, std::string_view name) {
  const auto values = forces::checked(law).parameters;
  const std::vector<double>& numbers = values.find(name)->second;
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

void add_to(forces::LawSpecification& law, std::string_view name, const Vector3<double>& change) {
  const Vector3<double> sum = vector_of(law, name) + change;
  law.parameters[std::string(name)] = {sum.x(), sum.y(), sum.z()};
}

/// The next of 1, 2, 5 times a power of ten that is not smaller.
double round_up_to_digit(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (value <= digit * power * (1.0 + 1e-12)) return digit * power;
  }
  return 10.0 * power;
}

}  // namespace

std::vector<Parameter> parameters_of(const scenes::Scene& scene) {
  constexpr std::string_view kAxes = "xyz";
  std::vector<Parameter> list;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const scenes::Cloth& cloth = scene.cloths[c];
    if (!has_laws(cloth)) continue;
    for (std::size_t l = 0; l < cloth.laws.size(); ++l) {
      const forces::LawInfo* info = forces::find_law(cloth.laws[l].law);
      if (info == nullptr) continue;
      const forces::LawSpecification law = forces::checked(cloth.laws[l]);
      for (const forces::ParameterInfo& row : info->parameters) {
        const std::vector<double>& values = law.parameters.find(row.name)->second;
        for (std::size_t k = 0; k < values.size(); ++k) {
          Parameter parameter{
              c, l, std::string(row.name), k, {}, std::string(row.unit), std::string(row.summary)};
          parameter.label = law.law + " " + parameter.name;
          parameter.is_vector = row.size > 1;
          if (parameter.is_vector) parameter.label += std::string(" ") + kAxes[k];
          parameter.value = values[k];
          parameter.minimum = parameter.is_vector ? -1e300 : row.minimum;
          parameter.maximum = row.maximum;
          list.push_back(std::move(parameter));
        }
      }
    }
  }
  return list;
}

void set_parameter(scenes::Scene& scene, const Parameter& parameter, double value) {
  forces::LawSpecification& law = scene.cloths.at(parameter.cloth).laws.at(parameter.law);
  forces::LawSpecification changed = forces::checked(law);
  changed.parameters.at(parameter.name).at(parameter.index) = value;
  law = forces::checked(changed);
}

SliderRange slider_range(const Parameter& parameter) {
  if (parameter.is_vector) {
    const double reach =
        std::max(20.0, round_up_to_digit(std::max(std::abs(parameter.value), 1e-9)));
    return {-reach, reach, false};
  }
  if (parameter.maximum <= 10.0) {
    return {std::max(parameter.minimum, -10.0), parameter.maximum, false};
  }
  if (parameter.value <= 0.0) return {std::max(parameter.minimum, 0.0), 1.0, false};
  const double high = round_up_to_digit(100.0 * parameter.value);
  return {std::max(parameter.minimum, 1e-4 * high), std::min(parameter.maximum, high), true};
}

Vector3<double> wind_of(const scenes::Scene& scene) {
  for (const scenes::Cloth& cloth : scene.cloths) {
    for (const forces::LawSpecification& law : cloth.laws) {
      if (forces::role_of(law.law) == forces::LawRole::kWind) return vector_of(law, "velocity");
    }
  }
  return {0, 0, 0};
}

Vector3<double> gravity_of(const scenes::Scene& scene) {
  for (const scenes::Cloth& cloth : scene.cloths) {
    for (const forces::LawSpecification& law : cloth.laws) {
      if (forces::role_of(law.law) == forces::LawRole::kGravity)
        return vector_of(law, "acceleration");
    }
  }
  return scene.world.gravity;
}

int add_wind(scenes::Scene& scene, const Vector3<double>& velocity) {
  int num_cloths = 0;
  for (scenes::Cloth& cloth : scene.cloths) {
    if (!has_laws(cloth) || std::holds_alternative<Rope>(cloth.source)) continue;
    forces::LawSpecification* law = find_law(cloth, "wind");
    if (law == nullptr) {
      law = &cloth.laws.emplace_back(
          forces::LawSpecification{"wind", {}, {{"velocity", {0.0, 0.0, 0.0}}}});
    }
    add_to(*law, "velocity", velocity);
    ++num_cloths;
  }
  return num_cloths;
}

void add_gravity(scenes::Scene& scene, const Vector3<double>& acceleration) {
  scene.world.gravity += acceleration;
  for (scenes::Cloth& cloth : scene.cloths) {
    if (forces::LawSpecification* law = find_law(cloth, "gravity")) {
      add_to(*law, "acceleration", acceleration);
    }
  }
}

}  // namespace weft::viewer
