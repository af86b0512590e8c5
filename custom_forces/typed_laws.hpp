#pragma once

// Tested by tests/custom_forces/typed_laws_test.cpp.

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <weft/custom_forces/law_info.hpp>

/// Every law of the registry as a type, so that a compiler knows the names of its parameters:
///
///   laws::tension({.stiffness = 2000.0})
///
/// tests/custom_forces/typed_laws_test.cpp holds each row against the registry's: names, sizes, defaults. Values are checked
/// where a law is made (forces::checked()). A parameter without a default that is not given is one of its errors.
namespace weft::laws {

using Vector = std::array<double, 3>;
inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
inline constexpr Vector kVectorNotGiven{kNotGiven, kNotGiven, kNotGiven};

namespace detail {
inline std::vector<double> values(double value) {
  return {value};
}
inline std::vector<double> values(const Vector& value) {
  return {value.begin(), value.end()};
}
}  // namespace detail

/// Linear springs along edges.
struct Tension {
  double stiffness = kNotGiven;  ///< [N/m] spring stiffness
  double compression_ratio =
      1.0;  ///< [1] stiffness under compression over stiffness under tension; 0 goes slack
  std::vector<std::string> sets = {};  ///< edge sets; empty: all of the mesh
};
[[nodiscard]] inline forces::LawSpecification tension(const Tension& law) {
  return {"tension",
          law.sets,
          {{"stiffness", detail::values(law.stiffness)},
           {"compression_ratio", detail::values(law.compression_ratio)}}};
}

/// Viscous dampers along edges.
struct SpringDamping {
  double damping = kNotGiven;          ///< [N*s/m] damping along the edge
  std::vector<std::string> sets = {};  ///< edge sets; empty: all of the mesh
};
[[nodiscard]] inline forces::LawSpecification spring_damping(const SpringDamping& law) {
  return {"spring_damping", law.sets, {{"damping", detail::values(law.damping)}}};
}

/// Bending of lines by torsion springs over three points.
struct Torsion {
  double stiffness = kNotGiven;        ///< [N/(m*rad)] force per lever arm and angle
  double side_ratio = 1.0;             ///< [1] stiffness of the second side over that of the first
  std::vector<std::string> sets = {};  ///< line sets; empty: all of the mesh
};
[[nodiscard]] inline forces::LawSpecification torsion(const Torsion& law) {
  return {"torsion",
          law.sets,
          {{"stiffness", detail::values(law.stiffness)},
           {"side_ratio", detail::values(law.side_ratio)}}};
}

/// Bending of a surface by torsion springs in its hinges.
struct HingeTorsion {
  double rigidity = kNotGiven;  ///< [N*m] plate rigidity
  double clamp_factor =
      2.0;  ///< [1] stiffness of a hinge at a clamp over that of others; 2: half a cell is in front
};
[[nodiscard]] inline forces::LawSpecification hinge_torsion(const HingeTorsion& law) {
  return {"hinge_torsion",
          {},
          {{"rigidity", detail::values(law.rigidity)},
           {"clamp_factor", detail::values(law.clamp_factor)}}};
}

/// Far nodes keep their direction in the local frame of a node.
struct NonlocalTorsion {
  double stiffness = kNotGiven;        ///< [N*m/rad] torque per angle
  std::vector<std::string> sets = {};  ///< connection sets; empty: all of the mesh
};
[[nodiscard]] inline forces::LawSpecification nonlocal_torsion(const NonlocalTorsion& law) {
  return {"nonlocal_torsion", law.sets, {{"stiffness", detail::values(law.stiffness)}}};
}

/// Accelerations relative to the centre of mass are divided by 1 + beta.
struct AccelerationDamping {
  double beta = kNotGiven;  ///< [1] added inertia over mass
};
[[nodiscard]] inline forces::LawSpecification acceleration_damping(const AccelerationDamping& law) {
  return {"acceleration_damping", {}, {{"beta", detail::values(law.beta)}}};
}

/// Rotation of the body as a whole decays.
struct RotationDamping {
  double rate = kNotGiven;  ///< [1/s] decay rate of the angular momentum, 1 / time constant
};
[[nodiscard]] inline forces::LawSpecification rotation_damping(const RotationDamping& law) {
  return {"rotation_damping", {}, {{"rate", detail::values(law.rate)}}};
}

/// Swirl about the centre of mass that is not rigid rotation decays.
struct TorsionalRotationDamping {
  double rate = kNotGiven;  ///< [1/s] decay rate of the swirl, 1 / time constant
};
[[nodiscard]] inline forces::LawSpecification torsional_rotation_damping(
    const TorsionalRotationDamping& law) {
  return {"torsional_rotation_damping", {}, {{"rate", detail::values(law.rate)}}};
}

/// Proportional loss of velocity, as in still air without area.
struct VelocityDamping {
  double rate = kNotGiven;  ///< [1/s] decay rate of the velocity
};
[[nodiscard]] inline forces::LawSpecification velocity_damping(const VelocityDamping& law) {
  return {"velocity_damping", {}, {{"rate", detail::values(law.rate)}}};
}

/// Drag of moving air on the faces, and of still air on moving faces.
struct Wind {
  Vector velocity = kVectorNotGiven;  ///< [m/s] velocity of the air
  double air_density = 1.2;           ///< [kg/m^3] density of the air; 1.2: at 20 degrees Celsius
  double normal_drag =
      1.0;  ///< [1] drag across the face; 1: full dynamic pressure, a stiff square plate has 1.2
  double tangential_drag = 0.0;  ///< [1] drag along the face
};
[[nodiscard]] inline forces::LawSpecification wind(const Wind& law) {
  return {"wind",
          {},
          {{"velocity", detail::values(law.velocity)},
           {"air_density", detail::values(law.air_density)},
           {"normal_drag", detail::values(law.normal_drag)},
           {"tangential_drag", detail::values(law.tangential_drag)}}};
}

/// Gas of one temperature in a closed mesh.
struct Pressure {
  double pressure = kNotGiven;    ///< [Pa] pressure of the gas at the rest volume
  double outside_pressure = 0.0;  ///< [Pa] pressure around the mesh
  double reservoir_volume =
      0.0;  ///< [m^3] volume of gas outside the mesh; a very large one keeps the pressure constant
};
[[nodiscard]] inline forces::LawSpecification pressure(const Pressure& law) {
  return {"pressure",
          {},
          {{"pressure", detail::values(law.pressure)},
           {"outside_pressure", detail::values(law.outside_pressure)},
           {"reservoir_volume", detail::values(law.reservoir_volume)}}};
}

/// Uniform gravity.
struct Gravity {
  Vector acceleration = kVectorNotGiven;  ///< [m/s^2] acceleration of free fall
};
[[nodiscard]] inline forces::LawSpecification gravity(const Gravity& law) {
  return {"gravity", {}, {{"acceleration", detail::values(law.acceleration)}}};
}

/// Nodes that follow a given motion, as a hand leads them.
struct Drive {
  double stiffness = kNotGiven;  ///< [N/m] pull of each node towards its target
  double damping = 0.0;  ///< [N*s/m] pull of each node's velocity towards that of its target
  Vector displacement = {0.0, 0.0,
                         0.0};        ///< [m] of the targets from the rest shape, from the start on
  Vector velocity = {0.0, 0.0, 0.0};  ///< [m/s] of the targets
  Vector angular_velocity = {
      0.0, 0.0, 0.0};  ///< [rad/s] of the targets about the mean position of all nodes of the law
  std::vector<std::string> sets = {};  ///< node sets; empty: all of the mesh
};
[[nodiscard]] inline forces::LawSpecification drive(const Drive& law) {
  return {"drive",
          law.sets,
          {{"stiffness", detail::values(law.stiffness)},
           {"damping", detail::values(law.damping)},
           {"displacement", detail::values(law.displacement)},
           {"velocity", detail::values(law.velocity)},
           {"angular_velocity", detail::values(law.angular_velocity)}}};
}

}  // namespace weft::laws
