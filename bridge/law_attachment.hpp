#pragma once

#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/precision.hpp>
#include <weft/custom_forces/core/cloth_mesh.hpp>
#include <weft/custom_forces/law_set.hpp>
#include <weft/fast_solver/network_kernel.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Why a body was taken out of the simulation.
struct BodyBlowUp {
  int node = 0;
  std::string reason;  ///< "velocity is not finite", "speed 2.1e+06 m/s is over 1e+06 m/s"
};

/// Speed [m/s] beyond which a node counts as exploded: 3000 times the speed of sound, and still
/// small enough for single-precision squares.
inline constexpr double kBlowUpSpeed = 1e6;

// What the solver of the classic world and the forces of the deformable world share.

/// The laws of a body's mesh. Throws InvalidArgument as forces::make_law().
[[nodiscard]] forces::LawSet<btScalar> make_laws(const ClothMesh& mesh,
                                                 const std::vector<forces::LawSpecification>& laws);

/// Throws InvalidArgument, its text starting with who, for masses [kg] that do not fit the body's
/// nodes and for a body whose m_cfg.timescale is not 1.
void check_attachment(const std::string& who, const btSoftBody& body,
                      const VectorX<btScalar>& masses);

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
