#include <weft/custom_forces/membrane_moduli.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/QR>

#include <weft/core/error.hpp>

namespace weft::forces {
namespace {

[[noreturn]] void refuse(const std::string& what, double value, const std::string& expected) {
  throw InvalidArgument("membrane moduli: " + what + " = " + std::to_string(value) + ", expected " +
                        expected);
}

void require_positive(const std::string& what, double value) {
  if (!(value > 0) || !std::isfinite(value)) refuse(what, value, "> 0 and finite");
}

void require_not_negative(const std::string& what, double value) {
  if (!(value >= 0) || !std::isfinite(value)) refuse(what, value, ">= 0 and finite");
}

/// The tensor in axes that are turned by this angle [rad].
Eigen::Matrix3d turned(const Eigen::Matrix3d& tensor, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  // Columns: the strains e_uu, e_vv, 2 e_uv of a unit strain along, across and between the turned
  // axes.
  Eigen::Matrix3d strains;
  strains << c * c, s * s, -c * s,  //
      s * s, c * c, c * s,          //
      2 * c * s, -2 * c * s, c * c - s * s;
  return strains.transpose() * tensor * strains;
}

/// The stiffness that one strain meets while the two others take the values of least energy.
struct Relaxed {
  double modulus;           ///< [N/m]
  Eigen::Vector2d strains;  ///< the two others, in their order, over the one [-]
};

Relaxed relaxed(const Eigen::Matrix3d& tensor, int kept) {
  const int others[2] = {kept == 0 ? 1 : 0, kept == 2 ? 1 : 2};
  Eigen::Matrix2d block;
  Eigen::Vector2d coupling;
  for (int i = 0; i < 2; ++i) {
    coupling[i] = tensor(others[i], kept);
    for (int j = 0; j < 2; ++j) block(i, j) = tensor(others[i], others[j]);
  }
  // A lattice without diagonals does not resist shear: the least solution will do there.
  const Eigen::Vector2d strains = -block.completeOrthogonalDecomposition().solve(coupling);
  return {tensor(kept, kept) + coupling.dot(strains), strains};
}

/// Springs of a cell of unit length, of which the other side is cell_ratio.
void append(std::vector<LatticeSpring>& springs, const std::vector<std::array<int, 2>>& steps,
            double cell_ratio, double stiffness) {
  for (const auto& [i, j] : steps) springs.push_back({{i, j * cell_ratio}, stiffness});
}

}  // namespace

double MembraneModuli::young(double angle) const {
  return relaxed(turned(tensor, angle), 0).modulus;
}

double MembraneModuli::poisson(double angle) const {
  return -relaxed(turned(tensor, angle), 0).strains[0];
}

double MembraneModuli::shear(double angle) const {
  return relaxed(turned(tensor, angle), 2).modulus;
}

MembraneModuli lattice_moduli(std::span<const LatticeSpring> springs, double cell_area) {
  require_positive("cell_area [m^2]", cell_area);
  MembraneModuli moduli;
  for (const LatticeSpring& spring : springs) {
    const double squared_length = spring.span.squaredNorm();
    require_positive("squared span of a spring [m^2]", squared_length);
    require_not_negative("stiffness of a spring [N/m]", spring.stiffness);
    const auto [u, v] = std::array{spring.span[0], spring.span[1]};
    const Eigen::Vector3d stretch(u * u, v * v, u * v);  // l times the spring's, per strain [m^2]
    moduli.tensor +=
        spring.stiffness / (squared_length * cell_area) * (stretch * stretch.transpose());
  }
  return moduli;
}

MembraneModuli membrane_moduli(GridStencil stencil, const SpringStiffness& stiffness,
                               double cell_ratio) {
  require_positive("cell_ratio", cell_ratio);
  std::vector<LatticeSpring> springs;
  for (const GridEdgeSet& set : grid_edge_sets(stencil)) {
    const double k = set.name == "stretch" ? stiffness.stretch
                     : set.name == "shear" ? stiffness.shear
                                           : stiffness.bend;
    append(springs, set.steps, cell_ratio, k);
  }
  return lattice_moduli(springs, cell_ratio);
}

MembraneModuli membrane_moduli(TriangleLattice lattice, const SpringStiffness& stiffness) {
  std::vector<LatticeSpring> springs;
  switch (lattice) {
    case TriangleLattice::kEquilateral: {
      const double height = std::sqrt(3.0) / 2;
      for (const auto& [u, v] : {std::array{1.0, 0.0}, {0.5, height}, {-0.5, height}}) {
        springs.push_back({{u, v}, stiffness.stretch});
      }
      // The far corners over an edge lie two heights apart, at right angles to it.
      for (const auto& [u, v] : {std::array{0.0, 2 * height}, {1.5, height}, {-1.5, height}}) {
        springs.push_back({{u, v}, stiffness.bend});
      }
      return lattice_moduli(springs, height);
    }
    case TriangleLattice::kRightAngledOneWay:
      append(springs, {{1, 0}, {0, 1}, {1, 1}}, 1, stiffness.stretch);
      append(springs, {{-1, 1}, {1, 2}, {2, 1}}, 1, stiffness.bend);
      return lattice_moduli(springs, 1);
    case TriangleLattice::kRightAngledUnionJack:
      // The cell has two nodes: one with eight edges, one with four.
      append(springs, {{1, 0}, {1, 0}, {0, 1}, {0, 1}, {1, 1}, {-1, 1}}, 1, stiffness.stretch);
      append(springs, {{1, 1}, {-1, 1}, {2, 0}, {0, 2}}, 1, stiffness.bend);
      return lattice_moduli(springs, 2);
  }
  throw InvalidArgument("membrane moduli: unknown triangle lattice");
}

double stiffness_from_young(double young, const MembraneModuli& of_unit_stiffness, double angle) {
  require_not_negative("young [N/m]", young);
  const double of_unit = of_unit_stiffness.young(angle);
  require_positive("young of the lattice over its stiffness", of_unit);
  return young / of_unit;
}

SpringStiffness stiffness_from_moduli(GridStencil stencil, double young, double shear) {
  require_positive("young [N/m]", young);
  require_not_negative("shear [N/m]", shear);
  const bool bends_with_shear = stencil == GridStencil::k24Neighbour;
  const double of_stretch =
      membrane_moduli(stencil, {1, 0, bends_with_shear ? 0.0 : 1.0}).tensor(0, 0);
  const MembraneModuli of_shear = membrane_moduli(stencil, {0, 1, bends_with_shear ? 1.0 : 0.0});
  // Springs are alike in both axes and their forces central: C_uu = C_vv = c and C_uv = G, so that
  // E = c - G^2 / c.
  const double c = (young + std::sqrt(young * young + 4 * shear * shear)) / 2;
  const double shear_springs = shear / of_shear.tensor(2, 2);
  const double stretch_springs = (c - shear_springs * of_shear.tensor(0, 0)) / of_stretch;
  if (!(stretch_springs >= 0)) {
    refuse("shear [N/m]", shear,
           "less for this stencil, which cannot have that much over young = " +
               std::to_string(young) + " [N/m]");
  }
  return {stretch_springs, shear_springs, bends_with_shear ? shear_springs : stretch_springs};
}

}  // namespace weft::forces
