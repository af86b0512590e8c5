#include <weft/reference/system.hpp>

#include <cmath>
#include <sstream>

#include <weft/core/error.hpp>

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
  if (body.self_contact || body.mutual_contact) {
    require_positive(where, "self_thickness [m]", body.self_thickness);
  }
}

/// Checks the sizes of a shape; whether it may have a mass.
struct CheckShape {
  bool operator()(const Sphere& sphere) const {
    require_positive(where, "radius [m]", sphere.radius);
    return true;
  }
  bool operator()(const Box& box) const {
    for (const double extent : box.half_extents) {
      require_positive(where, "half extent [m]", extent);
    }
    return true;
  }
  bool operator()(const Plane& /*plane*/) const { return false; }
  bool operator()(const Mesh& mesh) const {
    if (!mesh.surface) refuse(where, "surface", "null", "a mesh surface");
    return false;
  }
  // The centre of mass of a cone is not its origin.
  bool operator()(const Cone& cone) const { return upright(cone) && false; }
  bool operator()(const Capsule& capsule) const { return upright(capsule); }
  bool operator()(const Cylinder& cylinder) const { return upright(cylinder); }

  template <class Upright>
  bool upright(const Upright& shape) const {
    require_positive(where, "radius [m]", shape.radius);
    require_positive(where, "height [m]", shape.height);
    return true;
  }

  const std::string& where;
};

void check_collider(const Collider& collider) {
  const std::string where = "collider '" + collider.name + "'";
  const bool may_have_mass = std::visit(CheckShape{where}, collider.shape);
  if (collider.mass && !may_have_mass) {
    refuse(where, "mass [kg]", *collider.mass, "none for this shape");
  }
  if (collider.mass) require_positive(where, "mass [kg]", *collider.mass);
  require_not_negative(where, "friction [-]", collider.friction);
  // Rotations are composed over many steps; far looser than round-off, far tighter than any
  // mistake.
  constexpr double kUnitTolerance = 1e-6;
  const double norm = collider.orientation.norm();
  if (!(std::abs(norm - 1.0) < kUnitTolerance)) refuse(where, "|orientation| [-]", norm, "1");
}

/// Principal moments of homogeneous solids [kg m^2].
struct Inertia {
  Vector3<double> operator()(const Sphere& sphere) const {
    return Vector3<double>::Constant(0.4 * mass * sphere.radius * sphere.radius);
  }
  Vector3<double> operator()(const Box& box) const {
    const Vector3<double> squared = box.half_extents.cwiseAbs2();
    return mass / 3.0 * (Vector3<double>::Constant(squared.sum()) - squared);
  }
  Vector3<double> operator()(const Cylinder& c) const {
    const double across = mass * (3.0 * c.radius * c.radius + c.height * c.height) / 12.0;
    return {across, 0.5 * mass * c.radius * c.radius, across};
  }
  Vector3<double> operator()(const Capsule& c) const {
    const double r2 = c.radius * c.radius;
    // Volumes over pi r^2: the cylinder, and both caps, which are a sphere.
    const double tube = c.height, caps = 4.0 / 3.0 * c.radius;
    const double m_tube = mass * tube / (tube + caps), m_caps = mass * caps / (tube + caps);
    const double half = 0.5 * c.height;
    // A half ball: 83/320 m r^2 about its own centre, which is 3/8 r from its face.
    const double reach = half + 0.375 * c.radius;
    const double across = m_tube * (3.0 * r2 + c.height * c.height) / 12.0 +
                          m_caps * (83.0 / 320.0 * r2 + reach * reach);
    return {across, 0.5 * m_tube * r2 + 0.4 * m_caps * r2, across};
  }
  template <class Other>
  Vector3<double> operator()(const Other& /*shape*/) const {
    throw InvalidArgument("reference solver: a plane, cone or mesh has no mass");
  }

  double mass;
};

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
  return std::visit(Inertia{collider.mass.value()}, collider.shape);
}

Matrix3<double> world_inertia(const Collider& collider) {
  const Matrix3<double> rotation = collider.orientation.toRotationMatrix();
  return rotation * principal_inertia(collider).asDiagonal() * rotation.transpose();
}

}  // namespace weft::reference
