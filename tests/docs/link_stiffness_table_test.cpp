// What docs/choosing_a_stiffness.md says of Bullet's links. A test that fails prints the lines.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/link_stiffness.hpp>
#include <weft/bridge/soft_world.hpp>

#include "tests/docs/page.hpp"

namespace weft::bridge {
namespace {

constexpr const char* kPage = "choosing_a_stiffness.md";
constexpr double kStep = 1 / 60.0;  // [s]
/// Two inner nodes of the page's sheet: 0.324 kg/m^2, 24 x 24 cells on 1 m^2.
constexpr double kReducedMass = 0.324 / (24 * 24) / 2;  // [kg]

TEST(ChoosingAStiffness, TableOfLinkFactors) {
  std::string table =
      "| `kLST` | 1 iteration | 4 | 10 | 50 |\n"
      "|---|---|---|---|---|\n";
  for (const double factor : {0.1, 0.5, 0.9}) {
    table += fmt::format("| {} |", factor);
    for (const int iterations : {1, 4, 10, 50}) {
      table += fmt::format(" {:.2g} |",
                           stiffness_from_link_factor(factor, {kReducedMass, iterations, kStep}));
    }
    table += "\n";
  }
  docs::expect_lines(kPage, table);
}

TEST(ChoosingAStiffness, LinksOfTheExample) {
  constexpr double kStretch = 559;  // [N/m], of the page's jeans
  docs::expect_lines(
      kPage,
      fmt::format(
          "The example's 559 N/m are `kLST` = {:.3f} at 10 iterations a step and {:.3f} at 50.\n",
          link_factor_from_stiffness(kStretch, {kReducedMass, 10, kStep}),
          link_factor_from_stiffness(kStretch, {kReducedMass, 50, kStep})));
}

enum class Springs { kImplicit, kLinks };

/// The example's sheet, held by its upper row and come to rest: how much longer it is over what its E h says, m g L
/// / (2 E h w). The steps are 1 / parts of 1/60 s, links have this many iterations in each.
double relative_elongation(Springs springs, int parts, int iterations = 10) {
  constexpr int kCells = 24;
  constexpr double kMass = 0.324;   // [kg]
  constexpr double kYoung = 609;    // [N/m]
  constexpr double kStretch = 559;  // [N/m]
  constexpr double kShear = 3.26;   // [N/m], also of the bend springs
  constexpr double kDamping = 6;    // [1/s]
  constexpr int kFrames = 180;      // of 1/60 s, in which motion decays to e^-9
  ClothMesh mesh = make_cloth_grid(
      {.nodes = {kCells + 1, kCells + 1}, .v_axis = {0, 1, 0}, .total_mass = kMass});
  for (int i = 0; i <= kCells; ++i) mesh.pinned.push_back(kCells * (kCells + 1) + i);
  std::vector<forces::LawSpecification> laws = {
      {"gravity", {}, {{"acceleration", {0.0, -9.81, 0.0}}}},
      {"velocity_damping", {}, {{"rate", {kDamping}}}}};
  SoftWorld world({});
  ClothSettings settings{.position_iterations = iterations, .time_step = kStep / parts};
  if (springs == Springs::kLinks) {
    settings.links = {{{"stretch"}, kStretch}, {{"shear", "bend"}, kShear}};
  } else {
    laws.push_back({"tension", {"stretch"}, {{"stiffness", {kStretch}}}});
    laws.push_back({"tension", {"shear", "bend"}, {{"stiffness", {kShear}}}});
  }
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, settings));
  if (springs == Springs::kLinks) {
    world.solver().attach(body, mesh, laws);
  } else {
    EXPECT_FALSE(world.solver().attach_fast(body, mesh, laws));
  }
  for (int step = 0; step < kFrames * parts; ++step) world.step(kStep / parts);
  double height = 0;
  for (int i = 0; i <= kCells; ++i) height += static_cast<double>(body.m_nodes[i].m_x.y());
  return (-0.5 - height / (kCells + 1)) / (kMass * 9.81 / (2 * kYoung));
}

TEST(ChoosingAStiffness, TableOfElongations) {
  struct Row {
    int parts;
    double implicit, links;  // as the page says
  };
  std::string table =
      "| Step | k h^2 / mu | elongation over that of E h: `bullet_weft` | Bullet's links, 10 "
      "iterations "
      "|\n"
      "|---|---|---|---|\n";
  for (const auto& [parts, implicit, links] :
       {Row{1, 0.97, 22.5}, Row{4, 0.97, 5.9}, Row{16, 0.97, 1.7}}) {
    constexpr double kPrinted = 0.03;  // two digits
    EXPECT_NEAR(relative_elongation(Springs::kImplicit, parts), implicit, kPrinted * implicit);
    EXPECT_NEAR(relative_elongation(Springs::kLinks, parts), links, kPrinted * links);
    table += fmt::format("| 1/{} s | {:.2g} | {} times | {} times |\n", 60 * parts,
                         559 * kStep * kStep / (parts * parts) / kReducedMass, implicit, links);
  }
  docs::expect_lines(kPage, table);
  constexpr double kAtFifty = 22;  // as the page says
  EXPECT_NEAR(relative_elongation(Springs::kLinks, 1, 50), kAtFifty, 0.03 * kAtFifty);
}

}  // namespace
}  // namespace weft::bridge
