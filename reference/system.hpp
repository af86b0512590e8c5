#pragma once

// Tested by tests/reference/solver_test.cpp.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <weft/core/eigen_alignment.hpp>

#include <Eigen/Geometry>

#include <weft/custom_forces/law_set.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::reference {

/// One cloth: mass points with force laws.
struct Body {
  std::string name;
  ClothMesh mesh;  ///< pinned nodes feel no force and have the velocities that it gives them
  forces::LawSet<double> laws;  ///< everything that acts on the cloth, gravity too
  Matrix3X<double> positions;   ///< 3 x n [m]
  Matrix3X<double> velocities;  ///< 3 x n [m/s]
  /// Forces beside the laws', 3 x n [N], that inertia-level laws do not redistribute. Empty: none.
  Matrix3X<double> external_forces = {};
  double collision_margin = 0.0;  ///< [m] distance from a surface at which a node rests, >= 0
  double friction = 0.0;          ///< Coulomb coefficient [-], >= 0; with a collider: the product
  /// Triangles meet colliders too, not nodes alone: for a cloth that is coarser than they are.
  bool face_contact = false;
  bool self_contact = false;     ///< layers of the cloth keep self_thickness and never cross
  bool mutual_contact = false;   ///< the same with other bodies that have it set
  double self_thickness = 0.01;  ///< [m] distance that layers keep, > 0; of two bodies: the mean
};

struct Sphere {
  double radius;  ///< [m], > 0
};
struct Box {
  Vector3<double> half_extents;  ///< [m], > 0
};
/// The half space below the plane through the collider's position with its local y axis as normal.
struct Plane {};
/// Capsule, cylinder and cone stand along the y axis, their middle at the origin.
struct Capsule {
  double radius;  ///< [m], > 0
  double height;  ///< [m], > 0, of the cylinder between the caps
};
struct Cylinder {
  double radius;  ///< [m], > 0
  double height;  ///< [m], > 0
};
/// Base at y = -height / 2, tip at height / 2.
struct Cone {
  double radius;  ///< [m] of the base, > 0
  double height;  ///< [m], > 0
};
class MeshSurface;
/// A closed surface of triangles, solid inside (contact/mesh_surface.hpp).
struct Mesh {
  std::shared_ptr<const MeshSurface> surface;  ///< not null
};
using Shape = std::variant<Sphere, Box, Plane, Capsule, Cylinder, Cone, Mesh>;

/// A rigid body that touches cloth, and cloth only: colliders do not meet each other.
/// Without a mass nothing moves it but its own given velocities; with a mass the cloth pushes back.
struct Collider {
  std::string name;
  Shape shape;
  Vector3<double> position{0, 0, 0};  ///< centre of mass [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double friction = 1.0;                      ///< [-], >= 0
  std::optional<double> mass{};               ///< [kg], > 0; homogeneous; not a plane, cone or mesh
  Vector3<double> velocity{0, 0, 0};          ///< [m/s]
  Vector3<double> angular_velocity{0, 0, 0};  ///< world frame [rad/s]
};

/// Everything that the solver moves.
struct System {
  std::vector<Body> bodies;
  std::vector<Collider> colliders;
  Vector3<double> gravity{0, 0,
                          0};  ///< [m/s^2], of colliders with a mass; cloth has its gravity law
};

/// Throws InvalidArgument for sizes that do not match and for values out of their domain.
void check_system(const System& system);

/// 1/m per node [1/kg], 0 for pinned nodes.
[[nodiscard]] VectorX<double> inverse_masses(const ClothMesh& mesh);

/// Gives the pinned nodes their velocities [m/s].
void set_pinned_velocities(const ClothMesh& mesh, Matrix3XRef<double> velocities);

/// Principal moments of inertia of a collider with a mass, body frame [kg m^2].
[[nodiscard]] Vector3<double> principal_inertia(const Collider& collider);

/// Inertia of a collider with a mass about its centre, world frame [kg m^2].
[[nodiscard]] Matrix3<double> world_inertia(const Collider& collider);

}  // namespace weft::reference
