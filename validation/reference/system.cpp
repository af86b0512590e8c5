#include <weft/validation/reference/system.hpp>

#include <cmath>
#include <sstream>

#include <weft/custom_forces/core/error.hpp>

namespace weft::reference {
namespace {

template <class Value>
[[noreturn]] void refuse(const std::string& where, const std::string& name, const Value& value,
                         const std::string& expected) {
  std::ostringstream message;
  message << "reference solver, " << where << ": " << name << " = " << value << ", expected "
          << expected;
  throw InvalidArgument(message.str());
}

void require_not_negative(const std::string& where, const std::string& name, double value) {
  if (!(value >= 0.0 && std::isfinite(value))) refuse(where, name, value, ">= 0 and finite");
}

void require_positive(const std::string& where, const std::string& name, double value) {
  if (!(value > 0.0 && std::isfinite(value))) refuse(where, name, value, "> 0 and finite");
}

void check_body(const Body& body) {
  const std::string where = "cloth '" + body.name + "'";
  const Eigen::Index num_nodes = body.mesh.rest_positions.cols();
  if (body.positions.cols() != num_nodes) {
    refuse(where, "positions.cols()", body.positions.cols(), std::to_string(num_nodes));
  }
  if (body.velocities.cols() != num_nodes) {
    refuse(where, "velocities.cols()", body.velocities.cols(), std::to_string(num_nodes));
  }
  if (body.mesh.masses.size() != num_nodes) {
    refuse(where, "masses.size()", body.mesh.masses.size(), std::to_string(num_nodes));
  }
  for (Eigen::Index i = 0; i < num_nodes; ++i) {
    require_positive(where, "mass of node " + std::to_string(i) + " [kg]", body.mesh.masses[i]);
  }
  for (const int node : body.mesh.pinned) {
    if (node < 0 || node >= num_nodes) {
      refuse(where, "pinned node", node, "0 to " + std::to_string(num_nodes - 1));
    }
  }
  const Eigen::Index num_velocities = body.mesh.pinned_velocities.cols();
  const auto num_pinned = static_cast<Eigen::Index>(body.mesh.pinned.size());
  if (num_velocities != 0 && num_velocities != num_pinned) {
    refuse(where, "pinned_velocities.cols()", num_velocities, "0 or " + std::to_string(num_pinned));
  }
  if (!body.mesh.pinned_velocities.allFinite()) {
    refuse(where, "pinned_velocities [m/s]", "not finite", "finite numbers");
  }
  require_not_negative(where, "collision_margin [m]", body.collision_margin);
  require_not_negative(where, "friction [-]", body.friction);
}

void check_collider(const Collider& collider) {
  const std::string where = "collider '" + collider.name + "'";
  if (const auto* sphere = std::get_if<Sphere>(&collider.shape)) {
    require_positive(where, "radius [m]", sphere->radius);
  } else if (const auto* box = std::get_if<Box>(&collider.shape)) {
    for (const double extent : box->half_extents) {
      require_positive(where, "half extent [m]", extent);
    }
  } else if (collider.mass) {
    refuse(where, "mass [kg]", *collider.mass, "none: a plane has no inertia");
  }
  if (collider.mass) require_positive(where, "mass [kg]", *collider.mass);
  require_not_negative(where, "friction [-]", collider.friction);
  // Rotations are composed over many steps; far looser than round-off, far tighter than any
  // mistake.
  constexpr double kUnitTolerance = 1e-6;
  const double norm = collider.orientation.norm();
  if (!(std::abs(norm - 1.0) < kUnitTolerance)) refuse(where, "|orientation| [-]", norm, "1");
}

}  // namespace

void check_system(const System& system) {
  for (const Body& body : system.bodies) check_body(body);
  for (const Collider& collider : system.colliders) check_collider(collider);
}

VectorX<double> inverse_masses(const ClothMesh& mesh) {
  VectorX<double> inverse = mesh.masses.cwiseInverse();
  for (const int node : mesh.pinned) inverse[node] = 0.0;
  return inverse;
}

void set_pinned_velocities(const ClothMesh& mesh, Matrix3XRef<double> velocities) {
  for (std::size_t i = 0; i < mesh.pinned.size(); ++i) {
    velocities.col(mesh.pinned[i]) = mesh.pinned_velocity(i);
  }
}

Vector3<double> principal_inertia(const Collider& collider) {
  const double mass = collider.mass.value();
  if (const auto* sphere = std::get_if<Sphere>(&collider.shape)) {
    return Vector3<double>::Constant(0.4 * mass * sphere->radius * sphere->radius);
  }
  const Vector3<double> squared = std::get<Box>(collider.shape).half_extents.cwiseAbs2();
  return mass / 3.0 * (Vector3<double>::Constant(squared.sum()) - squared);
}

Matrix3<double> world_inertia(const Collider& collider) {
  const Matrix3<double> rotation = collider.orientation.toRotationMatrix();
  return rotation * principal_inertia(collider).asDiagonal() * rotation.transpose();
}

}  // namespace weft::reference
