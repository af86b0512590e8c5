#pragma once

// Tested by tests/bridge/solver_checks_test.cpp, tests/bridge/classic/body_life_test.cpp.

#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/fast_solver/network/network_kernel.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Why a body was taken out of the simulation.
struct BodyBlowUp {
  int node = 0;  ///< -1: no single one
  /// "velocity is not finite", "speed 2.1e+06 m/s is over 1e+06 m/s"; what a law or a contact of the body has thrown
  std::string reason;
};

/// Speed [m/s] beyond which a node counts as exploded: 3000 times the speed of sound, and still
/// small enough for single-precision squares.
inline constexpr double kBlowUpSpeed = 1e6;

// What the solver of the classic world and the forces of the deformable world share.

/// The laws of a body's mesh. Throws InvalidArgument as forces::make_law().
[[nodiscard]] forces::LawSet<btScalar> make_laws(const ClothMesh& mesh,
                                                 const std::vector<forces::LawSpecification>& laws);

/// Throws InvalidArgument, its text starting with who, for masses [kg] that are not those of the body's
/// nodes (to 1e-4; a pinned node of Bullet's has none), and for a body whose m_cfg.timescale is not 1.
void check_attachment(const std::string& who, const btSoftBody& body,
                      const VectorX<btScalar>& masses);
/// Likewise, and as check_mesh(), for a mesh with triangles that are not the body's faces, in whatever order. A mesh without
/// triangles fits every body with its number of nodes, and a body without faces every such mesh.
void check_topology(const std::string& who, const btSoftBody& body, const ClothMesh& mesh);

/// The masses of a body's nodes, which a program may change at any time (setMass(), setTotalMass(), m_im).
class FollowedMasses {
 public:
  FollowedMasses() = default;
  /// masses: n [kg], those of pinned nodes too.
  FollowedMasses(const btSoftBody& body, VectorX<btScalar> masses);

  /// [kg] n. A node that is pinned keeps the mass that it had.
  [[nodiscard]] const VectorX<btScalar>& values() const { return masses_; }
  /// Before each step. Which nodes have another mass now: the first of them, or -1. A body with another
  /// number of nodes is left alone.
  int follow(const btSoftBody& body);
  void serialize(StateArchive& archive);

 private:
  VectorX<btScalar> masses_;
  std::vector<btScalar> inverse_masses_;  ///< m_im when it was looked at last [1/kg]
};

/// Bullet's own pressure (m_cfg.kPR) in a body whose volume is next to nothing, an open sheet that lies flat, makes velocities
/// that are infinite or not a number.
[[nodiscard]] std::optional<BodyBlowUp> blow_up_by_pressure(const btSoftBody& body,
                                                            btScalar time_step, double max_speed);

/// The first node whose position or velocity is not finite, or -1.
[[nodiscard]] int first_non_finite_node(const btSoftBody& body);

/// The first of some nodes whose speed [m/s] after time_step [s] under forces [N] is not finite or over
/// max_speed [m/s]; pinned nodes count with the velocity they have.
[[nodiscard]] std::optional<BodyBlowUp> predicted_blow_up(const btSoftBody& body,
                                                          const Matrix3X<btScalar>& velocities,
                                                          const Matrix3X<btScalar>& forces,
                                                          btScalar time_step, double max_speed,
                                                          fast::NodeRange nodes);
/// The same for all nodes.
[[nodiscard]] std::optional<BodyBlowUp> predicted_blow_up(const btSoftBody& body,
                                                          const Matrix3X<btScalar>& velocities,
                                                          const Matrix3X<btScalar>& forces,
                                                          btScalar time_step, double max_speed);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
