#pragma once

#include <span>

#include <weft/core/eigen_alignment.hpp>
#include <weft/mesh/cloth_grid.hpp>

namespace weft::forces {

/// Elastic constants of a sheet in its own plane (plane stress), for small strains. They are membrane
/// constants, per length of a cut through the sheet: Young's modulus times thickness E h, shear
/// modulus times thickness G h [N/m]. Sheets of springs have no thickness, and need none.
///
///   (N_uu, N_vv, N_uv) = tensor (e_uu, e_vv, 2 e_uv)      W = N : e / 2, energy per area [J/m^2]
///
/// Angles [rad] are those of the direction of pull from the u axis. On a grid u and v are warp and
/// weft, and pi / 4 is the bias.
struct MembraneModuli {
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();  ///< symmetric, positive semidefinite [N/m]

  /// E h: the pull over the strain along it, where the sheet contracts freely across it [N/m].
  [[nodiscard]] double young(double angle = 0) const;
  /// Poisson's ratio: the contraction across a pull over the strain along it [-].
  [[nodiscard]] double poisson(double angle = 0) const;
  /// G h: the shear force over the shear angle 2 e_uv between this direction and its normal [N/m].
  [[nodiscard]] double shear(double angle = 0) const;
};

/// A spring of the cell that a lattice repeats.
struct LatticeSpring {
  Eigen::Vector2d span;    ///< from its first to its second node, at rest, not zero [m]
  double stiffness = 1.0;  ///< that of the tension law [N/m]
};

/// Moduli of a lattice of springs, from all springs of one cell and its area [m^2]:
///
///   tensor = d2W/de2 = (1 / area) sum k l^2 m m^T,   m = (n_u^2, n_v^2, n_u n_v),   n = span / l
///
/// the second derivative of the energy of a cell whose nodes all follow one homogeneous strain: a
/// spring of stiffness k stretches by l (n . e n). Only the shape of the cell counts: a lattice that
/// is refined with the same k keeps its moduli. Exact for small strain where each node is a center of
/// symmetry, as on grids, for then no node would move otherwise; an upper bound elsewhere. Springs
/// under compression count alike: the law's compression_ratio is 1.
/// Source   Born and Huang 1954 (lattices of central forces); Ostoja-Starzewski 2002 (triangular and
///          square lattices); Van Gelder 1998 (springs of triangle meshes)
/// Errors   InvalidArgument for an area or a span that is not > 0, and a stiffness that is not >= 0
/// Checked  tests MembraneModuli.*: the energy of meshes under the law itself
[[nodiscard]] MembraneModuli lattice_moduli(std::span<const LatticeSpring> springs,
                                            double cell_area);

/// Stiffness of the tension law on each edge set of a mesh [N/m]. All 1: moduli as multiples of the
/// one stiffness k that a law without edge_sets gives all springs.
struct SpringStiffness {
  double stretch = 1.0;
  double shear = 1.0;  ///< no meaning for triangles, which have no such set
  double bend = 1.0;   ///< no meaning for the stencil of 8 neighbors, which has no such set
};

/// Moduli of the interior of a grid. cell_ratio: spacing along v over spacing along u [-], > 0. Rims
/// differ: they have whole springs on half cells. Throws InvalidArgument as lattice_moduli().
[[nodiscard]] MembraneModuli membrane_moduli(GridStencil stencil,
                                             const SpringStiffness& stiffness = {},
                                             double cell_ratio = 1.0);

/// Regular triangle meshes as make_surface_body() sees them: edges ("stretch") and the far corners
/// of neighboring triangles ("bend").
enum class TriangleLattice {
  kEquilateral,
  kRightAngledOneWay,    ///< squares cut along u + v
  kRightAngledUnionJack  ///< squares cut along diagonals that alternate
};

/// Moduli of the interior of a triangle mesh. Throws InvalidArgument as lattice_moduli().
[[nodiscard]] MembraneModuli membrane_moduli(TriangleLattice lattice,
                                             const SpringStiffness& stiffness = {});

/// Stiffness [N/m] of the one tension law for all springs that gives a sheet the wanted E h [N/m] along
/// this angle [rad]; G h and Poisson's ratio follow from the lattice. of_unit_stiffness: what
/// membrane_moduli() says for stiffness 1. Throws InvalidArgument for young that is not >= 0 and finite,
/// and for a lattice that does not resist a pull along the angle.
[[nodiscard]] double stiffness_from_young(double young, const MembraneModuli& of_unit_stiffness,
                                          double angle = 0.0);

/// Stiffness of each edge set for which a grid of square cells has the wanted E h along u and v and the
/// wanted G h between them [N/m]. Two numbers can be chosen: "bend" is as "stretch" on the stencil of 12
/// neighbors, where its springs too run along the axes, and as "shear" on that of 24. Poisson's ratio
/// follows, as 2 g / (1 + sqrt(1 + 4 g^2)) with g = G / E. Throws InvalidArgument for young that is not
/// > 0, for shear that is not >= 0, and for shear too large for the stencil: above 0.71 young on that of
/// 24 neighbors.
[[nodiscard]] SpringStiffness stiffness_from_moduli(GridStencil stencil, double young,
                                                    double shear);

}  // namespace weft::forces
