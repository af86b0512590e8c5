#pragma once

#include <string_view>
#include <vector>

#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::fast {

/// The implicit springs and dampers. Every edge with nodes i and j has
///
///   tension     k' (l - l0)            k' = stiffness if l >= l0, else compressed_stiffness
///   damper      c (dl/dt)              l the distance of i and j
///
/// Bending is no force of the network, which leaves it to StepForces: w (x_j - x_i), summed over all edges, is the constant
/// positive semidefinite matrix that stands for its stiffness in Newton's method. Single w may be negative.
struct SpringNetwork {
  Edges edges = Edges(2, 0);             ///< 2 x m, first index < second index, each pair once
  VectorX<double> rest_lengths;          ///< l0, m [m], > 0
  VectorX<double> stiffness;             ///< m [N/m], >= 0
  VectorX<double> compressed_stiffness;  ///< m [N/m], 0 to stiffness
  VectorX<double> damping;               ///< c, m [N s/m], >= 0
  VectorX<double> bending;               ///< w, m [N/m]
};

/// Laws of which a network is made; all others are left to be computed elsewhere.
[[nodiscard]] bool is_implicit(const forces::LawSpecification& law);
/// By its id: whether the network has the stiffness of the law, whose forces are StepForces.
[[nodiscard]] bool is_bending(std::string_view law);

/// The network of the tension and spring_damping laws among these, and the bending of the
/// hinge_torsion and torsion laws among them: the trace of each 3 x 3 block of their stiffness matrix
/// at the rest shape. Throws InvalidArgument as forces::make_law().
[[nodiscard]] SpringNetwork make_network(const ClothMesh& mesh,
                                         const std::vector<forces::LawSpecification>& laws);

/// Only the part of that network that has an end among these nodes (flags), in a time that goes by its size.
[[nodiscard]] SpringNetwork make_network_at(const std::vector<char>& is_wanted,
                                            const ClothMesh& mesh,
                                            const std::vector<forces::LawSpecification>& laws);

/// Puts springs in the place of all that have an end among the changed nodes (flags); both by first,
/// then by second node, as make_network() has them.
void replace_springs(const std::vector<char>& is_changed, const SpringNetwork& springs,
                     SpringNetwork& network);

/// Another rest length [m], > 0, of the spring between two nodes, in either order. Does nothing without such a spring.
void set_rest_length(int first, int second, double rest_length, SpringNetwork& network);

}  // namespace weft::fast
