#pragma once

// Tested by tests/python/test_bodies.py.

#include <memory>
#include <optional>
#include <string>

#include <weft/python/bindings/records.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::python {

/// How a rigid body moves.
struct BodyOptions {
  std::string name;
  Vector3<double> position{0, 0, 0};  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double mass = 0.0;          ///< [kg]; 0: fixed, or moved by the program
  bool is_kinematic = false;  ///< moved by the program, mass 0
  double friction = 0.5;      ///< [-]
  double restitution = 0.0;   ///< [-]
};

/// A body with a shape of scenes/shapes/shapes.hpp, in no world yet. Throws InvalidArgument for values out of their domain, for a
/// kinematic body with a mass, and for a plane, mesh or height field with one.
[[nodiscard]] std::shared_ptr<BodyRecord> make_body(const scenes::Shape& shape,
                                                    const BodyOptions& options);

/// Place and motion as Python sees them: of the shape's own frame.
[[nodiscard]] Vector3<double> position_of(const BodyRecord& body);  ///< [m]
[[nodiscard]] Eigen::Quaterniond orientation_of(const BodyRecord& body);
/// Puts the body there; a kinematic one moves there in the next step, with the velocity that this takes.
void place(BodyRecord& body, const Vector3<double>& position,
           const Eigen::Quaterniond& orientation);

}  // namespace weft::python
