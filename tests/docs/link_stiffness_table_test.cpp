// What docs/choosing_a_stiffness.md says of Bullet's links. A test that fails prints the lines.
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <weft/bridge/link_stiffness.hpp>

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
  constexpr double kStretch = 559;  // [N/m], of the page's denim
  docs::expect_lines(kPage,
                     fmt::format("For the example's 559 N/m `kLST` is {:.3f} at 10 iterations a "
                                 "step and {:.3f} at 50, with "
                                 "k h^2 / mu = {:.0f};\n",
                                 link_factor_from_stiffness(kStretch, {kReducedMass, 10, kStep}),
                                 link_factor_from_stiffness(kStretch, {kReducedMass, 50, kStep}),
                                 kStretch * kStep * kStep / kReducedMass));
}

}  // namespace
}  // namespace weft::bridge
