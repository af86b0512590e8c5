#pragma once

#include <vector>

#include <weft/custom_forces/law_info.hpp>
#include <weft/fast_solver/network/sparse_matrix.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::fast {

/// The trace of each 3 x 3 block (i, j), i < j, of -df/dx at the rest shape, summed over the laws
/// [N/m]. A hinge has the energy k (sum of g_i . x_i)^2 / 2 there, with gradients g along the normal;
/// the matrix k g_i . g_j of scalars that this gives bounds it from above in every direction, however
/// the cloth turns. Rows sum to zero, because the laws are invariant to translation.
/// Only for laws that reach no farther: hinge_torsion, torsion.
[[nodiscard]] std::vector<MatrixPart> rest_stiffness(
    const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws);

}  // namespace weft::fast
