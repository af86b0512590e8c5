#include <cmath>
#include <cstdio>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>

#ifdef EXPECTED_SCALAR
#include <LinearMath/btScalar.h>
static_assert(sizeof(btScalar) == sizeof(EXPECTED_SCALAR), "the bridge brings Bullet's precision");
#endif

// The weight of a cloth of 2 kg, through the installed library.
int main() {
  const weft::ClothMesh mesh = weft::make_cloth_grid({.nodes = {4, 4}, .total_mass = 2.0});
  const auto gravity = weft::forces::make_law<double>(
      {.law = "gravity", .sets = {}, .parameters = {{"acceleration", {0, -9.81, 0}}}}, mesh);
  weft::Matrix3X<double> scratch(3, gravity->scratch_columns());
  weft::Matrix3X<double> forces = weft::Matrix3X<double>::Zero(3, mesh.num_nodes());
  gravity->add_forces({mesh.rest_positions, forces, mesh.masses}, scratch, forces);
  const double weight = -forces.row(1).sum();
  std::printf("weight = %.12g N\n", weight);
  // 16 additions and roundings of numbers of the size of the sum.
  constexpr double kRoundoff = 16 * 2.2e-16 * 2.0 * 9.81;
  return std::abs(weight - 2.0 * 9.81) <= kRoundoff ? 0 : 1;
}
