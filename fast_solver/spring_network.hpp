#pragma once

#include <vector>

#include <weft/custom_forces/core/cloth_mesh.hpp>
#include <weft/custom_forces/law_info.hpp>

namespace weft::fast {

/// What is solved for implicitly: between the two nodes i and j of every edge
///
///   tension     k' (l - l0)            k' = stiffness if l >= l0, else compressed_stiffness
///   damper      c (dl/dt)              l the distance of i and j
///   stabiliser  w ((x_j - x_i) - (q_j - q_i))  q the places at the start of the step
///
/// The stabiliser is for forces that are computed at the start of the step (bending): it is the change
/// that a constant matrix predicts for them, so that a stiff force needs no small step. It vanishes
/// where nothing moves, so that it changes no equilibrium. Single w may be negative; the sum over all
/// edges is a positive semidefinite matrix.
struct SpringNetwork {
  Edges edges = Edges(2, 0);             ///< 2 x m, first index < second index, each pair once
  VectorX<double> rest_lengths;          ///< l0, m [m], > 0
  VectorX<double> stiffness;             ///< m [N/m], >= 0
  VectorX<double> compressed_stiffness;  ///< m [N/m], 0 to stiffness
  VectorX<double> damping;               ///< c, m [N s/m], >= 0
  VectorX<double> stabiliser;            ///< w, m [N/m]
};

/// Laws of which a network is made; all others are left to be computed at the start of the step.
[[nodiscard]] bool is_implicit(const forces::LawSpecification& law);

/// The network of the tension and spring_damping laws among these, and the stabiliser of the
/// hinge_torsion and torsion laws among them: the trace of each 3 x 3 block of their stiffness matrix
/// at the rest shape. Throws InvalidArgument as forces::make_law().
[[nodiscard]] SpringNetwork make_network(const ClothMesh& mesh,
                                         const std::vector<forces::LawSpecification>& laws);

/// Of that network, only what has an end among these nodes (flags): in time that goes by what it is.
[[nodiscard]] SpringNetwork make_network_at(const std::vector<char>& is_wanted,
                                            const ClothMesh& mesh,
                                            const std::vector<forces::LawSpecification>& laws);

/// Puts springs in the place of all that have an end among the changed nodes (flags); both by first,
/// then by second node, as make_network() has them.
void replace_springs(const std::vector<char>& is_changed, const SpringNetwork& springs,
                     SpringNetwork& network);

}  // namespace weft::fast
