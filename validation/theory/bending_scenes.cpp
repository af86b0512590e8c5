// Heavy strips clamped at one end, of which the elastica knows the shape: one of the catalog, and strips of fabrics, paper and
// leather on meshes as one makes them.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <weft/scenes/catalog.hpp>
#include <weft/validation/cases/analytic/bending/elastica.hpp>
#include <weft/validation/cases/support/parameters.hpp>
#include <weft/validation/cases/support/small_systems.hpp>
#include <weft/validation/theory/bending_scenes.hpp>
#include <weft/validation/theory/scene_parts.hpp>
#include <weft/validation/theory/theory_scenes.hpp>

namespace weft::validation {

namespace {

/// H and W of the free end [m], mean over its nodes.
std::array<double, 2> tip_of(const Frames& frames, const ClothGrid& grid) {
  double drop = 0;
  double reach = 0;
  for (int row = 0; row < grid.nodes[1]; ++row) {
    const Vector3<double> tip = frames.back().cloths[0].positions.col(grid_node(grid, -1, row));
    drop -= tip.y();
    reach += tip.x();
  }
  return {drop / grid.nodes[1], reach / grid.nodes[1]};
}

TheoryBound elastica_bound(const std::string& what, double gamma, double length,
                           const ClothGrid& grid, int cells) {
  const HeavyElastica exact = solve_heavy_elastica(gamma);
  TheoryBound bound;
  bound.claim = fmt::format("in the engine: {} hangs as the elastica", what);
  bound.metric = fmt::format("relative error of H / W, Gamma = {:.4g}, N = {}", gamma, cells);
  bound.formula = "theta'' + Gamma (1 - s) cos(theta) = 0, theta(0) = 0, theta'(1) = 0";
  bound.source = "heavy elastica, solved on the spot";
  bound.values = [=](const Frames& frames) -> std::vector<ComparedValue> {
    const auto [drop, reach] = tip_of(frames, grid);
    return {{"H / W", drop / reach, exact.drop / exact.reach, "1"},
            {"drop of the tip", drop, exact.drop * length, "m"}};
  };
  bound.tolerance = [gamma, cells](double) {
    const double enough = std::max(40.0, std::ceil(4 * std::sqrt(gamma)));
    return Tolerance{0.01 * std::max(1.0, std::pow(enough / cells, 2)), Basis::kTruncation,
                     "1 % with cells enough for the layer of bending at the clamp, second order in "
                     "the cells; no step has a say in an equilibrium"};
  };
  bound.sabotages = {law_scaled("rigidity +50 %", "hinge_torsion", "rigidity", 1.5)};
  return bound;
}

}  // namespace

ClothGrid strip_grid(const StripScene& strip) {
  const double cell = strip.length / strip.cells;
  ClothGrid grid;
  grid.nodes = {strip.cells + 2, strip.rows};
  grid.size = {strip.length + cell, cell * (strip.rows - 1)};
  grid.center = {0.5 * (strip.length - cell), 0, 0};
  grid.stencil = GridStencil::k8Neighbour;
  grid.total_mass = strip.area_density * grid.size[0] * grid.size[1];
  return grid;
}

scenes::Cloth strip_cloth(const StripScene& strip) {
  scenes::Cloth cloth;
  cloth.name = "strip";
  const ClothGrid grid = strip_grid(strip);
  cloth.source = grid;
  cloth.collision_margin = 1e-3;
  scenes::NodePin clamp;
  for (int row = 0; row < strip.rows; ++row) {
    for (const int column : {0, 1}) clamp.nodes.push_back(grid_node(grid, column, row));
  }
  cloth.pins = {clamp};
  forces::LawSpecification tension = tension_law(strip.stiffness);
  tension.sets = {"stretch", "shear"};
  cloth.laws = {tension, {"hinge_torsion", {}, {{"rigidity", {strip.rigidity}}}}};
  if (strip.has_gravity) cloth.laws.push_back(gravity_law({0, -kTheoryGravity, 0}));
  if (strip.rate > 0) cloth.laws.push_back(velocity_damping_law(strip.rate));
  return cloth;
}

double strip_step(const StripScene& strip) {
  const double cell = strip.length / strip.cells;
  const double node_mass = strip.area_density * cell * cell / 2;  // at the sides
  const double squared = 16 * strip.stiffness / node_mass +
                         64 * strip.rigidity / (strip.area_density * std::pow(cell, 4));
  return 1.4 / std::sqrt(squared);
}

namespace {

TheoryScene strip_scene(const std::string& id, const std::string& what, StripScene strip) {
  const double weight = strip.area_density * kTheoryGravity * strip.length;  // per width [N/m]
  constexpr double kStrain = 1e-3;  // of the springs under the whole weight
  strip.stiffness = weight / kStrain;
  strip.has_gravity = true;
  const double gamma = weight * strip.length * strip.length / strip.rigidity;
  const double bending =
      3.52 * std::sqrt(strip.rigidity / (strip.area_density * std::pow(strip.length, 4)));
  const double swinging = 1.2 * std::sqrt(kTheoryGravity / strip.length);
  strip.rate = 2 * std::max(bending, swinging);  // near-critical: the fastest way to rest
  const scenes::World world = theory_world(30 / strip.rate + 0.5, strip_step(strip), 3);
  return {id,
          theory_scene("strip", world, strip_cloth(strip), true),
          {elastica_bound(what, gamma, strip.length, strip_grid(strip), strip.cells)}};
}

}  // namespace

std::vector<TheoryScene> cantilever_scenes(const CaseInfo& info, const CaseOptions& options) {
  const auto of = [](double gamma, int cells) {
    StripScene strip;
    strip.length = 0.2;
    strip.cells = cells;
    strip.area_density = 0.2;
    strip.rigidity = strip.area_density * kTheoryGravity * std::pow(strip.length, 3) / gamma;
    return strip_scene(fmt::format("gamma_{:.0f}_{}", 100 * gamma, cells),
                       fmt::format("a heavy strip, Gamma = {:.4g}, {} cells,", gamma, cells),
                       strip);
  };
  if (asks_for_point(options)) {
    refuse_values(info, options, {"angle", "tilt"});
    const double gamma = value_of(info, options, "gamma");
    return {of(gamma, static_cast<int>(value_or(options, "nodes", 16)))};
  }
  scenes::Scene heavy = scenes::load_scene("heavy_strip");
  heavy.world = theory_world(heavy.world.duration, heavy.world.time_step, 3);
  const ClothGrid grid = heavy.cloths[0].grid();
  std::vector<TheoryScene> list{
      {"heavy_strip",
       heavy,
       {elastica_bound("the catalog's heavy_strip", 5.0, 0.2, grid, grid.nodes[0] - 2)}}};
  // 16 cells as in the catalog: 2.5 of the tolerance that 40 have is what second order leaves.
  list.push_back(of(1.0, 20));
  list.push_back(of(30.0, 20));
  return list;
}

std::vector<TheoryScene> fabric_scenes(const CaseInfo&, const CaseOptions&) {
  struct Fabric {
    const char* id;
    const char* what;
    double area_density;  ///< [kg/m^2]
    double rigidity;      ///< [N m]
    double length;        ///< [m]
    int cells;
  };
  // D / (rho dx^4), what an explicit bending force asks of a step: 1.6e6, 4e5, 4e5, 6e6, 2.2e5 1/s^2.
  constexpr Fabric kFabrics[] = {
      {"limp", "300 g/m^2, 0.3 mN m, cells of 5 mm", 0.3, 3e-4, 0.3, 60},
      {"cotton", "cotton of 150 g/m^2, 2.34 uN m, cells of 2.5 mm", 0.15, 2.34e-6, 0.1, 40},
      {"denim", "denim of 400 g/m^2, 0.1 mN m, cells of 5 mm", 0.4, 1e-4, 0.2, 40},
      {"paper", "paper of 80 g/m^2, 0.3 mN m, cells of 5 mm", 0.08, 3e-4, 0.2, 40},
      {"leather", "leather of 900 g/m^2, 2 mN m, cells of 1 cm", 0.9, 2e-3, 0.3, 30}};
  std::vector<TheoryScene> list;
  for (const Fabric& fabric : kFabrics) {
    StripScene strip;
    strip.length = fabric.length;
    strip.cells = fabric.cells;
    strip.area_density = fabric.area_density;
    strip.rigidity = fabric.rigidity;
    list.push_back(strip_scene(fabric.id, fmt::format("a strip of {},", fabric.what), strip));
  }
  return list;
}

}  // namespace weft::validation
