// Moduli of lattices against the energy of meshes under the laws themselves.
#include <weft/custom_forces/membrane_moduli.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <weft/core/error.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/surface_body.hpp>

namespace weft::forces {
namespace {

using testing::HasSubstr;

constexpr double kBias = std::numbers::pi / 4;
constexpr double kSpacing = 0.05;  ///< of nodes [m]
/// Strain of the measurements. Springs turn by as much, which moves their energy by a like part.
constexpr double kStrain = 1e-4;
/// The second difference of the energy over the strain is even in it: what is left is kStrain^2, and
/// the rounding of lengths over kStrain.
constexpr double kMeasured = 1e-6;
constexpr double kRoundoff = 1e-12;

/// Energy [J] of the mesh under the laws, each node displaced by this strain (e_uu, e_vv, 2 e_uv).
double strain_energy(const ClothMesh& mesh, const std::vector<LawSpecification>& laws,
                     const Eigen::Vector3d& strain) {
  Matrix3X<double> positions = mesh.rest_positions;
  positions.row(0) +=
      strain[0] * mesh.rest_positions.row(0) + strain[2] / 2 * mesh.rest_positions.row(1);
  positions.row(1) +=
      strain[1] * mesh.rest_positions.row(1) + strain[2] / 2 * mesh.rest_positions.row(0);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, positions.cols());
  double energy = 0;
  for (const LawSpecification& law : laws) {
    energy += make_law<double>(law, mesh)->potential_energy({positions, still, mesh.masses});
  }
  return energy;
}

/// Makes a mesh of n x n cells of the size below in the plane z = 0.
using Patch = std::function<ClothMesh(int)>;

/// Energy per area [J/m^2] of the interior. The energy of n x n cells is a n^2 + b n + c, where b
/// belongs to the rims and c to the corners: a second difference over n leaves the interior.
double interior_energy(const Patch& patch, double cell_area,
                       const std::vector<LawSpecification>& laws, const Eigen::Vector3d& strain) {
  constexpr int kCells = 10;
  constexpr int kMore = 2;  // a union jack repeats after two cells
  double second_difference = 0;
  for (const auto& [n, weight] :
       {std::pair{kCells - kMore, 1.0}, {kCells, -2.0}, {kCells + kMore, 1.0}}) {
    second_difference += weight * strain_energy(patch(n), laws, strain);
  }
  return second_difference / (2.0 * kMore * kMore * cell_area);
}

/// d2W/de2 of the interior [N/m], by central differences.
Eigen::Matrix3d measured_tensor(const Patch& patch, double cell_area,
                                const std::vector<LawSpecification>& laws) {
  const auto energy = [&](const Eigen::Vector3d& strain) {
    return (interior_energy(patch, cell_area, laws, strain) +
            interior_energy(patch, cell_area, laws, -strain)) /
           (kStrain * kStrain);
  };
  Eigen::Matrix3d tensor;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d a = kStrain * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d b = kStrain * Eigen::Vector3d::Unit(j);
      tensor(i, j) = (energy(a + b) - energy(a - b)) / 4;
    }
  }
  return tensor;
}

Patch grid_patch(GridStencil stencil, double cell_ratio = 1) {
  return [=](int cells) {
    return make_cloth_grid({.nodes = {cells + 1, cells + 1},
                            .size = {cells * kSpacing, cells * kSpacing * cell_ratio},
                            .v_axis = {0, 1, 0},
                            .stencil = stencil});
  };
}

/// A body of triangles whose cells have this side as their second one, cut along diagonals in one
/// direction, or in both by turns.
Patch triangle_patch(const Eigen::Vector2d& side, bool alternates) {
  return [=](int cells) {
    Surface surface;
    const int n = cells + 1;
    surface.positions = Matrix3X<double>::Zero(3, n * n);
    std::vector<Eigen::Vector3i> triangles;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = j * n + i;
        surface.positions.col(a).head<2>() = kSpacing * (Eigen::Vector2d(i, 0) + j * side);
        if (i == cells || j == cells) continue;
        // The diagonal from a to a + n + 1 is the short one only where the cell leans the other way.
        const bool is_cut_from_a = side[0] <= 0 && (!alternates || (i + j) % 2 == 0);
        const std::array<int, 4> cell{a, a + 1, a + n + 1, a + n};
        const int first = is_cut_from_a ? 0 : 1;
        const auto corner = [&](int c) { return cell[static_cast<std::size_t>((first + c) % 4)]; };
        triangles.emplace_back(corner(0), corner(1), corner(2));
        triangles.emplace_back(corner(0), corner(2), corner(3));
      }
    }
    surface.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      surface.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
    }
    return make_surface_body(surface, {});
  };
}

Patch triangle_patch(TriangleLattice lattice) {
  if (lattice == TriangleLattice::kEquilateral) {
    return triangle_patch({0.5, std::sqrt(3.0) / 2}, false);
  }
  return triangle_patch({0, 1}, lattice == TriangleLattice::kRightAngledUnionJack);
}

double cell_area(TriangleLattice lattice) {
  const bool is_equilateral = lattice == TriangleLattice::kEquilateral;
  return kSpacing * kSpacing * (is_equilateral ? std::sqrt(3.0) / 2 : 1.0);
}

LawSpecification tension(double stiffness, std::vector<std::string> sets = {}) {
  return {"tension", std::move(sets), {{"stiffness", {stiffness}}}};
}

void expect_tensor(const MembraneModuli& moduli, const Eigen::Matrix3d& measured,
                   const std::string& what) {
  EXPECT_LT((moduli.tensor - measured).cwiseAbs().maxCoeff(), kMeasured * measured.norm())
      << what << "\n"
      << moduli.tensor << "\nmeasured\n"
      << measured;
}

constexpr std::array kStencils{GridStencil::k8Neighbour, GridStencil::k12Neighbour,
                               GridStencil::k24Neighbour};
constexpr std::array kLattices{TriangleLattice::kEquilateral, TriangleLattice::kRightAngledOneWay,
                               TriangleLattice::kRightAngledUnionJack};

TEST(MembraneModuli, AreWhatGridsUnderTheTensionLawHave) {
  constexpr double kStiffness = 700;  // [N/m]
  for (const GridStencil stencil : kStencils) {
    for (const double ratio : {1.0, 0.4}) {
      const Eigen::Matrix3d measured = measured_tensor(
          grid_patch(stencil, ratio), kSpacing * kSpacing * ratio, {tension(kStiffness)});
      expect_tensor(membrane_moduli(stencil, {kStiffness, kStiffness, kStiffness}, ratio), measured,
                    "stencil " + std::to_string(static_cast<int>(stencil)) + ", ratio " +
                        std::to_string(ratio));
    }
  }
}

TEST(MembraneModuli, AddUpOverEdgeSetsOfTheirOwnStiffness) {
  const SpringStiffness stiffness{.stretch = 900, .shear = 50, .bend = 300};
  for (const GridStencil stencil : kStencils) {
    std::vector<LawSpecification> laws = {tension(stiffness.stretch, {"stretch"}),
                                          tension(stiffness.shear, {"shear"})};
    if (stencil != GridStencil::k8Neighbour) laws.push_back(tension(stiffness.bend, {"bend"}));
    expect_tensor(membrane_moduli(stencil, stiffness),
                  measured_tensor(grid_patch(stencil), kSpacing * kSpacing, laws),
                  "stencil " + std::to_string(static_cast<int>(stencil)));
  }
}

TEST(MembraneModuli, AreWhatBodiesOfTrianglesUnderTheTensionLawHave) {
  for (const TriangleLattice lattice : kLattices) {
    const std::string name = "lattice " + std::to_string(static_cast<int>(lattice));
    const Patch patch = triangle_patch(lattice);
    expect_tensor(membrane_moduli(lattice, {.stretch = 1, .bend = 0}),
                  measured_tensor(patch, cell_area(lattice), {tension(1, {"stretch"})}),
                  name + ", edges");
    expect_tensor(membrane_moduli(lattice),
                  measured_tensor(patch, cell_area(lattice), {tension(1)}),
                  name + ", edges and far corners");
  }
}

TEST(MembraneModuli, DoNotDependOnTheSpacing) {
  // Twice the spacing, the same law: k is a force per length of one spring, not of its strain.
  const Patch coarse = [](int cells) {
    return make_cloth_grid({.nodes = {cells + 1, cells + 1},
                            .size = {cells * 2 * kSpacing, cells * 2 * kSpacing},
                            .v_axis = {0, 1, 0}});
  };
  expect_tensor(membrane_moduli(GridStencil::k24Neighbour),
                measured_tensor(coarse, 4 * kSpacing * kSpacing, {tension(1)}), "coarse");
}

/// E h, nu and G h of the square lattices, as fractions by hand: c = C_uu, d = C_uv = C_shear.
TEST(MembraneModuli, OfSquareGridsAreTheFractionsOfTheirTensor) {
  struct Row {
    GridStencil stencil;
    double c, d;
  };
  for (const auto& [stencil, c, d] : {Row{GridStencil::k8Neighbour, 2, 1},
                                      {GridStencil::k12Neighbour, 6, 1},
                                      {GridStencil::k24Neighbour, 16.8, 8.2}}) {
    const MembraneModuli moduli = membrane_moduli(stencil);
    EXPECT_NEAR(moduli.young(), c - d * d / c, kRoundoff * c);
    EXPECT_NEAR(moduli.poisson(), d / c, kRoundoff);
    EXPECT_NEAR(moduli.shear(), d, kRoundoff * c);
    // On the bias a pull is shear and dilation: 1/E = 1 / (4 G) + 1 / (2 (c + d)).
    EXPECT_NEAR(1 / moduli.young(kBias), 1 / (4 * d) + 1 / (2 * (c + d)), kRoundoff);
    EXPECT_NEAR(moduli.shear(kBias), (c - d) / 2, kRoundoff * c);
  }
}

TEST(MembraneModuli, OfIsotropicLatticesAreAlikeInAllDirections) {
  for (const TriangleLattice lattice :
       {TriangleLattice::kEquilateral, TriangleLattice::kRightAngledUnionJack}) {
    const MembraneModuli moduli = membrane_moduli(lattice, {.stretch = 1, .bend = 0});
    for (const double angle : {0.0, 0.3, kBias, 1.2}) {
      EXPECT_NEAR(moduli.young(angle), moduli.young(), kRoundoff);
      EXPECT_NEAR(moduli.poisson(angle), 1 / 3.0, kRoundoff) << "central forces";
      EXPECT_NEAR(moduli.shear(angle), moduli.young() / (2 * (1 + 1 / 3.0)), kRoundoff);
    }
  }
  EXPECT_NEAR(membrane_moduli(TriangleLattice::kEquilateral, {.bend = 0}).young(),
              2 / std::sqrt(3.0), kRoundoff);
}

/// A pull of the measured energy, with no use of the formulas: strain along this angle, the two
/// other strains moved one after the other to where the energy is least.
TEST(MembraneModuli, YoungIsThePullOfASheetThatContractsFreely) {
  for (const double angle : {0.0, 0.35, kBias}) {
    const Patch patch = triangle_patch(TriangleLattice::kRightAngledOneWay);
    const auto energy = [&](const Eigen::Vector3d& along_across_shear) {
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      const auto& [along, across, shear] =
          std::array{along_across_shear[0], along_across_shear[1], along_across_shear[2]};
      return interior_energy(patch, kSpacing * kSpacing, {tension(1)},
                             {c * c * along + s * s * across - c * s * shear,
                              s * s * along + c * c * across + c * s * shear,
                              2 * c * s * (along - across) + (c * c - s * s) * shear});
    };
    Eigen::Vector3d strain(kStrain, 0, 0);
    for (int sweep = 0; sweep < 60; ++sweep) {
      for (const int i : {1, 2}) {  // to the vertex of the parabola through three energies
        const Eigen::Vector3d step = kStrain * Eigen::Vector3d::Unit(i);
        const double less = energy(strain - step);
        const double more = energy(strain + step);
        strain += step * (less - more) / (2 * (less - 2 * energy(strain) + more));
      }
    }
    const MembraneModuli moduli = membrane_moduli(TriangleLattice::kRightAngledOneWay);
    constexpr double kNonlinear = 5 * kStrain;  // the energy has a cubic part
    EXPECT_NEAR(2 * energy(strain) / (kStrain * kStrain), moduli.young(angle), kNonlinear * 5);
    EXPECT_NEAR(-strain[1] / kStrain, moduli.poisson(angle), kNonlinear);
  }
}

TEST(MembraneModuli, ASheetWithoutDiagonalsHasNoShearAndNoPullOnTheBias) {
  const MembraneModuli moduli = membrane_moduli(GridStencil::k8Neighbour, {.shear = 0});
  EXPECT_NEAR(moduli.young(), 1, kRoundoff);
  EXPECT_NEAR(moduli.shear(), 0, kRoundoff);
  EXPECT_NEAR(moduli.young(kBias), 0, kRoundoff);
}

TEST(StiffnessFromYoung, GivesTheLatticeThatModulus) {
  for (const GridStencil stencil : kStencils) {
    for (const double angle : {0.0, kBias}) {
      const double k = stiffness_from_young(1234, membrane_moduli(stencil), angle);
      EXPECT_NEAR(membrane_moduli(stencil, {k, k, k}).young(angle), 1234, 1234 * kRoundoff);
    }
  }
}

TEST(StiffnessFromModuli, GivesGridsBothModuli) {
  constexpr double kYoung = 800;  // [N/m]
  for (const GridStencil stencil : kStencils) {
    for (const double shear : {0.0, 5.0, 60.0, 0.7 * kYoung}) {
      const SpringStiffness k = stiffness_from_moduli(stencil, kYoung, shear);
      const MembraneModuli moduli = membrane_moduli(stencil, k);
      EXPECT_NEAR(moduli.young(), kYoung, kYoung * kRoundoff);
      EXPECT_NEAR(moduli.young(2 * kBias), kYoung, kYoung * kRoundoff);
      EXPECT_NEAR(moduli.shear(), shear, kYoung * kRoundoff);
      const double g = shear / kYoung;
      EXPECT_NEAR(moduli.poisson(), 2 * g / (1 + std::sqrt(1 + 4 * g * g)), kRoundoff);
      EXPECT_GE(k.stretch, 0);
    }
  }
}

/// How much longer a square sheet of 1 m gets under its own weight [-], held by its upper row: the
/// equations of the law at rest, solved by conjugate gradients.
double elongation_under_weight(GridStencil stencil, const SpringStiffness& k, int cells) {
  constexpr double kGravity = 9.81;  // [m/s^2]
  const ClothMesh mesh = make_cloth_grid({.nodes = {cells + 1, cells + 1},
                                          .v_axis = {0, 1, 0},
                                          .stencil = stencil,
                                          .total_mass = 0.3});
  const Eigen::Index width = cells + 1;  // the last row is the upper one
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, mesh.num_nodes());
  std::vector<std::unique_ptr<ForceLaw<double>>> laws;
  laws.push_back(make_law<double>(tension(k.stretch, {"stretch"}), mesh));
  laws.push_back(make_law<double>(tension(k.shear, {"shear"}), mesh));
  if (mesh.has_edge_set("bend")) {
    laws.push_back(make_law<double>(tension(k.bend, {"bend"}), mesh));
  }
  const auto resistance = [&](const Matrix3X<double>& displacements) {
    Matrix3X<double> product = still;
    for (const auto& law : laws) {
      Matrix3X<double> scratch(3, law->scratch_columns());
      law->add_stiffness_product({mesh.rest_positions, still, mesh.masses}, displacements, scratch,
                                 product);
    }
    product.rightCols(width).setZero();
    return Matrix3X<double>(-product);
  };
  Matrix3X<double> residual = still;
  residual.row(1) = -kGravity * mesh.masses.transpose();
  residual.rightCols(width).setZero();
  Matrix3X<double> displacements = still;
  Matrix3X<double> direction = residual;
  double squared = residual.squaredNorm();
  const double enough = 1e-20 * squared;
  for (int iteration = 0; squared > enough && iteration < 5000; ++iteration) {
    const Matrix3X<double> change = resistance(direction);
    const double alpha = squared / direction.cwiseProduct(change).sum();
    displacements += alpha * direction;
    residual -= alpha * change;
    const double beta = residual.squaredNorm() / squared;
    squared *= beta;
    direction = residual + beta * direction;
  }
  return -displacements.row(1).head(width).mean();
}

TEST(StiffnessFromModuli, ASheetThatHangsGetsLongerAsTheModulusSays) {
  constexpr double kYoung = 800;                         // [N/m]
  constexpr double kLonger = 0.3 * 9.81 / (2 * kYoung);  // m g L / (2 E h w)
  for (const GridStencil stencil : kStencils) {
    const SpringStiffness k = stiffness_from_moduli(stencil, kYoung, 60);
    // The rims count by 1 / cells, which the difference of two sheets takes out.
    const double longer =
        2 * elongation_under_weight(stencil, k, 24) - elongation_under_weight(stencil, k, 12);
    constexpr double kSecondOrder =
        0.005;  // 1 / cells^2, and the held row, which does not contract
    EXPECT_NEAR(longer / kLonger, 1, kSecondOrder) << static_cast<int>(stencil);
  }
}

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "no error";
}

TEST(StiffnessFromModuli, RefusesShearThatTheStencilCannotHave) {
  EXPECT_EQ(error_of([] { (void)stiffness_from_moduli(GridStencil::k24Neighbour, 100, 71); }),
            "no error");
  EXPECT_THAT(error_of([] { (void)stiffness_from_moduli(GridStencil::k24Neighbour, 100, 72); }),
              HasSubstr("shear [N/m] = 72.000000, expected less for this stencil"));
  EXPECT_EQ(error_of([] { (void)stiffness_from_moduli(GridStencil::k8Neighbour, 100, 900); }),
            "no error");
}

TEST(MembraneModuli, ValuesOutOfTheirDomainAreRefusedByName) {
  const GridStencil stencil = GridStencil::k8Neighbour;
  EXPECT_THAT(error_of([&] { (void)membrane_moduli(stencil, {}, 0); }),
              HasSubstr("cell_ratio = 0.000000, expected > 0 and finite"));
  EXPECT_THAT(error_of([&] { (void)membrane_moduli(stencil, {.shear = -1}); }),
              HasSubstr("stiffness of a spring [N/m] = -1.000000"));
  EXPECT_THAT(error_of([] { (void)lattice_moduli({}, 0); }), HasSubstr("cell_area [m^2]"));
  const LatticeSpring none{Eigen::Vector2d::Zero()};
  EXPECT_THAT(error_of([&] { (void)lattice_moduli({&none, 1}, 1); }), HasSubstr("squared span"));
  EXPECT_THAT(error_of([&] { (void)stiffness_from_moduli(stencil, 0, 1); }),
              HasSubstr("young [N/m] = 0.000000"));
  EXPECT_THAT(error_of([&] { (void)stiffness_from_moduli(stencil, 1, -1); }),
              HasSubstr("shear [N/m] = -1.000000"));
  EXPECT_THAT(error_of([] { (void)stiffness_from_young(-1, {}); }), HasSubstr("young [N/m] = -1"));
  EXPECT_THAT(error_of([] { (void)stiffness_from_young(1, {}); }),
              HasSubstr("young of the lattice over its stiffness = 0"));
}

}  // namespace
}  // namespace weft::forces
