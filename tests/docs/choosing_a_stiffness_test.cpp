// The numbers of docs/choosing_a_stiffness.md and docs/fabrics.md. A test that fails prints the lines that belong there.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <weft/custom_forces/membrane_moduli.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/spectrum.hpp>
#include <weft/scenes/format/scene_file.hpp>

#include "tests/docs/page.hpp"

namespace weft::forces {
namespace {

constexpr const char* kPage = "choosing_a_stiffness.md";
constexpr double kBias = 0.78539816339744831;  // 45 degrees [rad]
constexpr int kCells = 24;                     // of the page's sheets, along each side

struct Stencil {
  GridStencil stencil;
  const char* name;
};
constexpr std::array kStencils{Stencil{GridStencil::k8Neighbour, "8 neighbors"},
                               Stencil{GridStencil::k12Neighbour, "12 neighbors"},
                               Stencil{GridStencil::k24Neighbour, "24 neighbors"}};

/// A square sheet of 1 m, 24 x 24 cells, of which an inner node weighs 1 kg, and one of its laws.
ClothMesh sheet(GridStencil stencil) {
  return make_cloth_grid({.nodes = {kCells + 1, kCells + 1},
                          .v_axis = {0, 1, 0},
                          .stencil = stencil,
                          .total_mass = 1.0 * kCells * kCells});
}
const LawSpecification kUnitTension{"tension", {}, {{"stiffness", {1.0}}}};

std::string factors_row(const std::string& name, const MembraneModuli& moduli) {
  const std::string bias = std::abs(moduli.young(kBias) - moduli.young(-kBias)) < 1e-9
                               ? fmt::format("{:.2f}", moduli.young(kBias))
                               : fmt::format("{:.2f} along, {:.2f} across the diagonals",
                                             moduli.young(kBias), moduli.young(-kBias));
  return fmt::format("| {} | {:.2f} | {} | {:.2f} | {:.2f} | {:.3f} | {:.4f} |\n", name,
                     moduli.young(), bias, moduli.shear(), moduli.shear(kBias), moduli.poisson(),
                     1 / moduli.young());
}

TEST(ChoosingAStiffness, TableOfFactors) {
  std::string table =
      "| Springs, all with stiffness k | E h / k along an axis | at 45 degrees | G h / k between "
      "the "
      "axes | at 45 degrees | Poisson's ratio along an axis | k / (E h) |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& [stencil, name] : kStencils) {
    table += factors_row(fmt::format("grid, {}", name), membrane_moduli(stencil));
  }
  struct Lattice {
    TriangleLattice lattice;
    const char* name;
  };
  for (const auto& [lattice, name] :
       {Lattice{TriangleLattice::kEquilateral, "equilateral triangles"},
        {TriangleLattice::kRightAngledUnionJack, "right-angled triangles, union jack"},
        {TriangleLattice::kRightAngledOneWay, "right-angled triangles, one diagonal"}}) {
    table += factors_row(fmt::format("{}: edges", name), membrane_moduli(lattice, {.bend = 0}));
    table += factors_row(fmt::format("{}: edges and bend springs", name), membrane_moduli(lattice));
  }
  docs::expect_lines(kPage, table);
}

/// How the stiffness of a set depends on c and G, which stiffness_from_moduli() is linear in: "c - G".
std::string combination(double of_c, double of_shear) {
  constexpr double kNone = 1e-9;
  const auto term = [](double factor, const char* symbol) {
    if (std::abs(factor - 1) < kNone) return std::string(symbol);
    return fmt::format("{:.4g} {}", factor, symbol);
  };
  if (std::abs(of_c) < kNone) return term(of_shear, "G h");
  std::string text = term(of_c, "c");
  if (std::abs(of_shear) > kNone) text += " - " + term(-of_shear, "G h");
  return text;
}

TEST(ChoosingAStiffness, TableOfEdgeSets) {
  const auto c = [](double young, double shear) {
    return (young + std::sqrt(young * young + 4 * shear * shear)) / 2;
  };
  std::string table =
      "| Grid | `stretch` | `shear` | `bend` | explicit steps, one k: h / sqrt(m / k) below | 24 x "
      "24 "
      "cells, one k: stretch energy with rims |\n"
      "|---|---|---|---|---|---|\n";
  for (const auto& [stencil, name] : kStencils) {
    // Two fabrics determine the two coefficients of each set, a third one checks them.
    const SpringStiffness limp = stiffness_from_moduli(stencil, 1, 0);
    const SpringStiffness firm = stiffness_from_moduli(stencil, 1, 0.5);
    const SpringStiffness third = stiffness_from_moduli(stencil, 3, 0.7);
    std::array<std::string, 3> cells;
    for (std::size_t set = 0; set < 3; ++set) {
      const auto of = [&](const SpringStiffness& k) {
        return std::array{k.stretch, k.shear, k.bend}[set];
      };
      const double of_c = of(limp);
      const double of_shear = (of(firm) - of_c * c(1, 0.5)) / 0.5;
      EXPECT_NEAR(of_c * c(3, 0.7) + of_shear * 0.7, of(third), 1e-12) << name;
      cells[set] = combination(of_c, of_shear);
    }
    if (stencil == GridStencil::k8Neighbour) cells[2] = "-";
    const ClothMesh mesh = sheet(stencil);
    // The energy of a stretch along u, of the whole sheet over that of as much interior.
    constexpr double kStrain = 1e-5;
    Matrix3X<double> positions = mesh.rest_positions;
    positions.row(0) *= 1 + kStrain;
    const Matrix3X<double> still = Matrix3X<double>::Zero(3, positions.cols());
    const double energy =
        make_law<double>(kUnitTension, mesh)->potential_energy({positions, still, mesh.masses});
    const double interior = membrane_moduli(stencil).tensor(0, 0) * kStrain * kStrain / 2;
    table += fmt::format("| {} | {} | {} | {} | {:.2f} | {:+.1f} % |\n", name, cells[0], cells[1],
                         cells[2], critical_time_step(mesh, {kUnitTension}),
                         100 * (energy / interior - 1));
  }
  docs::expect_lines(kPage, table);
}

/// Files of the measurements of Wang, O'Brien and Ramamoorthi 2011: areal density, the first row of
/// "stretching" (the state at rest), and the first value of the first and last row of "bending" (the
/// smallest curvature, at 0 and 90 degrees).
struct Fabric {
  const char* name;
  const char* file;
  double density;                // [kg/m^2]
  double c11, c12, c22, c33;     // [N/m]
  double bending_0, bending_90;  // [1e-6 N m]
  [[nodiscard]] double young_u() const { return c11 - c12 * c12 / c22; }
  [[nodiscard]] double young_v() const { return c22 - c12 * c12 / c11; }
  [[nodiscard]] double young() const { return (young_u() + young_v()) / 2; }
  [[nodiscard]] double shear() const { return c33 / 2; }
  [[nodiscard]] double rigidity() const { return (bending_0 + bending_90) / 2 * 1e-6; }  // [N m]
};
constexpr std::array kFabrics{
    Fabric{"jeans", "11oz-black-denim", 0.324, 205.352005, 10.234077, 1013.88629, 53.387184,
           64.196457, 96.951576},
    Fabric{"trousers", "royal-target", 0.220, 2016.55456, 9.170511, 2034.97644, 104.759674,
           125.409805, 125.409805},
    Fabric{"tablecloth", "white-dots-on-blk", 0.128, 2002.08618, 0.345588, 2027.48559, 19.189022,
           51.713814, 31.282822},
    Fabric{"blanket", "pink-ribbon-brown", 0.228, 151.503906, 106.028160, 244.830673, 30.250183,
           117.070122, 59.774277},
    Fabric{"jacket", "camel-ponte-roma", 0.284, 31.146198, -12.802702, 44.028667, 31.896357,
           36.348366, 37.157593},
    Fabric{"swimsuit", "white-swim-solid", 0.204, 47.971176, 6.834521, 104.615456, 60.773663,
           60.237942, 51.018833},
};

TEST(ChoosingAStiffness, TableOfFabrics) {
  std::string table =
      "| Fabric, file | mass [kg/m^2] | E h along u, v [N/m] | G h [N/m] | D [1e-6 N m] | 8 "
      "neighbors: "
      "`stretch`, `shear` [N/m] | 24 neighbors: `stretch`, `shear` and `bend` [N/m] |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Fabric& fabric : kFabrics) {
    const SpringStiffness k8 =
        stiffness_from_moduli(GridStencil::k8Neighbour, fabric.young(), fabric.shear());
    const SpringStiffness k24 =
        stiffness_from_moduli(GridStencil::k24Neighbour, fabric.young(), fabric.shear());
    table += fmt::format(
        "| {}, `{}` | {:.3f} | {:.0f}, {:.0f} | {:.1f} | {:.0f} | {:.0f}, {:.1f} | "
        "{:.0f}, {:.2f} |\n",
        fabric.name, fabric.file, fabric.density, fabric.young_u(), fabric.young_v(),
        fabric.shear(), 1e6 * fabric.rigidity(), k8.stretch, k8.shear, k24.stretch, k24.shear);
  }
  docs::expect_lines("fabrics.md", table);
}

/// The scene of the page, with a head that every scene needs.
scenes::Scene example_scene() {
  const std::string page = docs::page_text(kPage);
  const std::string mark = "```toml\n";
  const std::size_t begin = page.find(mark) + mark.size();
  const std::string cloth = page.substr(begin, page.find("```", begin) - begin);
  return scenes::read_scene_text(R"(schema = "weft-scene/1"
name = "example"
summary = "Shows the cloth of the page"
[world]
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
time_step = "1/2400 s"
implicit_time_step = "1/60 s"
duration = "1 s"
frame_interval = "1/60 s"
)" + cloth,
                                 "the example of the page");
}

TEST(ChoosingAStiffness, TheSceneOfTheExampleIsThatFabric) {
  const Fabric& denim = kFabrics[0];
  const scenes::Scene scene = example_scene();
  ASSERT_EQ(scene.cloths.size(), 1U);
  SpringStiffness stiffness{0, 0, 0};
  double rigidity = 0;
  for (const LawSpecification& law : scene.cloths[0].laws) {
    if (law.law == "hinge_torsion") rigidity = law.parameters.at("rigidity")[0];
    if (law.law != "tension") continue;
    for (const std::string& set : law.sets) {
      (set == "stretch" ? stiffness.stretch
       : set == "shear" ? stiffness.shear
                        : stiffness.bend) += law.parameters.at("stiffness")[0];
    }
  }
  constexpr double kPrinted = 5e-3;  // three digits
  const MembraneModuli moduli = membrane_moduli(GridStencil::k24Neighbour, stiffness);
  EXPECT_NEAR(moduli.young(), denim.young(), kPrinted * denim.young());
  EXPECT_NEAR(moduli.shear(), denim.shear(), kPrinted * denim.shear());
  EXPECT_NEAR(rigidity, denim.rigidity(), kPrinted * denim.rigidity());
}

TEST(ChoosingAStiffness, NumbersOfTheExample) {
  const Fabric& denim = kFabrics[0];
  const SpringStiffness k =
      stiffness_from_moduli(GridStencil::k24Neighbour, denim.young(), denim.shear());
  const MembraneModuli moduli = membrane_moduli(GridStencil::k24Neighbour, k);
  constexpr double kStep = 1 / 60.0;                           // [s]
  constexpr double kGravity = 9.81;                            // [m/s^2]
  const double node_mass = denim.density / (kCells * kCells);  // [kg]
  const double young = denim.young();
  ClothMesh mesh = sheet(GridStencil::k24Neighbour);
  mesh.masses *= node_mass;
  const double explicit_step =
      critical_time_step(mesh, {{"tension", {"stretch"}, {{"stiffness", {k.stretch}}}},
                                {"tension", {"shear", "bend"}, {{"stiffness", {k.shear}}}}});
  docs::expect_lines(
      kPage, fmt::format(
                 "* E h = {:.0f} N/m (the mean of both axes), G h = {:.1f} N/m, D = {:.1f}e-6 N m\n"
                 "* c = {:.1f} N/m, so `stretch` {:.0f} N/m, `shear` and `bend` {:.2f} N/m\n"
                 "* Poisson's ratio {:.3f}; E h on the bias {:.0f} N/m\n"
                 "* an inner node weighs {:.0f} mg, k h^2 / m = {:.0f} at 1/60 s\n"
                 "* explicit steps must stay below {:.1f} ms for its springs\n"
                 "* 1 m of it stretches by {:.2f} % at the top under its own weight; bends over "
                 "lengths of about (D / (rho g))^(1/3) = {:.0f} mm\n",
                 young, denim.shear(), 1e6 * denim.rigidity(), moduli.tensor(0, 0), k.stretch,
                 k.shear, moduli.poisson(), moduli.young(kBias), 1e6 * node_mass,
                 k.stretch * kStep * kStep / node_mass, 1e3 * explicit_step,
                 100 * denim.density * kGravity / young,
                 1e3 * std::cbrt(denim.rigidity() / (denim.density * kGravity))));
}

TEST(ChoosingAStiffness, RangeOfTheTablecloth) {
  const Fabric& cloth = kFabrics[2];
  const double stretch =
      stiffness_from_moduli(GridStencil::k24Neighbour, cloth.young(), cloth.shear()).stretch;
  const auto ratio = [&](double cells_per_meter) {
    return stretch / 3600 / (cloth.density / (cells_per_meter * cells_per_meter));
  };
  docs::expect_lines(kPage, fmt::format("  The tablecloth of fabrics.md is at {:.1e} with 24 cells "
                                        "to the meter, and at {:.1e} with 100.\n",
                                        ratio(kCells), ratio(100)));
}

/// The rigidity of a grid whose lines u have torsion springs, k = D / d^2: energy of a cylinder.
TEST(ChoosingAStiffness, LinesOfTorsionSpringsHaveTheRigidityThatThePageSays) {
  constexpr double kRigidity = 3e-5;   // [N m]
  constexpr double kCurvature = 0.02;  // [1/m]
  double second_difference = 0;        // over the number of cells: the interior's, without rims
  constexpr double kSpacing = 0.01;    // [m]
  for (const auto& [cells, weight] : {std::pair{9, 1.0}, {10, -2.0}, {11, 1.0}}) {
    const ClothMesh mesh = make_cloth_grid({.nodes = {cells + 1, cells + 1},
                                            .size = {cells * kSpacing, cells * kSpacing},
                                            .v_axis = {0, 1, 0}});
    Matrix3X<double> positions = mesh.rest_positions;
    for (Eigen::Index n = 0; n < positions.cols(); ++n) {
      const double angle = kCurvature * positions(0, n);
      positions(0, n) = std::sin(angle) / kCurvature;
      positions(2, n) = (1 - std::cos(angle)) / kCurvature;
    }
    const Matrix3X<double> still = Matrix3X<double>::Zero(3, positions.cols());
    const LawSpecification torsion{
        "torsion", {}, {{"stiffness", {kRigidity / (kSpacing * kSpacing)}}}};
    second_difference +=
        weight * make_law<double>(torsion, mesh)->potential_energy({positions, still, mesh.masses});
  }
  const double expected = kRigidity * kCurvature * kCurvature / 2;
  EXPECT_NEAR(second_difference / (2 * kSpacing * kSpacing), expected, 1e-5 * expected);
}

}  // namespace
}  // namespace weft::forces
