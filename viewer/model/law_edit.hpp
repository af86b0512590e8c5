#pragma once

// Tested by tests/viewer/model/law_edit_test.cpp.

#include <string>
#include <string_view>
#include <vector>

#include <weft/scenes/scene.hpp>

namespace weft::viewer {

/// Changes of the laws of a scene, as plain data.

/// One number of a law of a cloth, as a slider shows it.
struct Parameter {
  std::size_t cloth = 0;
  std::size_t law = 0;
  std::string name;       ///< "stiffness"
  std::size_t index = 0;  ///< of a vector's three numbers
  std::string label;      ///< "tension stiffness", "wind velocity x"
  std::string unit;       ///< "N/m"; "1" for a dimensionless number
  std::string summary;    ///< half a sentence
  double value = 0.0;
  double minimum = 0.0;  ///< that the law accepts
  double maximum = 0.0;
  bool is_vector = false;
};

/// Every number of every law of the cloths that are simulated, defaults filled in.
[[nodiscard]] std::vector<Parameter> parameters_of(const scenes::Scene& scene);

/// Sets one of them. Throws InvalidArgument as forces::checked(); nothing has changed then.
void set_parameter(scenes::Scene& scene, const Parameter& parameter, double value);

/// The range of a slider around a value that the scene has: round numbers, within what the law accepts.
struct SliderRange {
  double low = 0.0;
  double high = 1.0;
  bool is_logarithmic = false;
};
[[nodiscard]] SliderRange slider_range(const Parameter& parameter);

/// The wind [m/s] and the gravity [m/s^2] of a scene: those of the first cloth that has the law, else none and the world's.
[[nodiscard]] Vector3<double> wind_of(const scenes::Scene& scene);
[[nodiscard]] Vector3<double> gravity_of(const scenes::Scene& scene);

/// Adds to the velocity of the wind [m/s] of every cloth with triangles; one without wind gets the law.
/// Returns how many cloths feel it.
int add_wind(scenes::Scene& scene, const Vector3<double>& velocity);

/// Adds to the gravity [m/s^2] of every cloth that has the law, and of the rigid bodies.
void add_gravity(scenes::Scene& scene, const Vector3<double>& acceleration);

}  // namespace weft::viewer
