// A running program changes laws, masses and rest lengths, which act from the next step on.
#include <cmath>
#include <cstdio>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/mesh/rope.hpp>

namespace {

std::vector<weft::forces::LawSpecification> laws(double stiffness) {
  return {{"tension", {}, {{"stiffness", {stiffness}}}},
          {"velocity_damping", {}, {{"rate", {4.0}}}},
          {"gravity", {}, {{"acceleration", {0, -9.81, 0}}}}};
}

}  // namespace

int main() {
  weft::bridge::SoftWorld world({});
  weft::ClothMesh mesh =
      weft::make_rope({.nodes = 11, .start = {0, 0, 0}, .end = {0, -1, 0}, .total_mass = 1.1});
  mesh.pinned = {0};
  btSoftBody& rope = world.add(weft::bridge::make_cloth_body(
      world.info(), mesh, {.links = {{.edge_sets = {}, .stiffness = 100}}}));
  weft::bridge::SoftBodySolver& solver = world.solver();
  if (const auto refusal = solver.attach_fast(rope, mesh, laws(200))) {
    std::fprintf(stderr, "%s\n", refusal->c_str());
    return 2;
  }
  const auto length = [&] {
    for (int step = 0; step < 600; ++step) world.step(1 / 60.0);
    return -static_cast<double>(rope.m_nodes[10].m_x.y());
  };
  const auto report = [&](const char* what, double value) {
    std::printf("%-28s %.4f m long\n", what, value);
    return value;
  };

  const double first = report("200 N/m", length());

  solver.replace_laws(rope, mesh, laws(400));  // other parameters, by their names
  const double stiffer = report("400 N/m", length());

  rope.setMass(10, 1);  // a weight at its end
  const double heavier = report("with 1 kg at its end", length());

  for (int l = 0; l < rope.m_links.size(); ++l) rope.m_links[l].m_rl *= 2;  // paid out
  const double longer = report("twice as long at rest", length());

  // Twice the stiffness, half the stretch; and rest lengths say what is added to it.
  const double stretch = first - 1;
  const bool is_right = std::abs((stiffer - 1) - stretch / 2) < 1e-3 && heavier > stiffer + 0.04 &&
                        std::abs(longer - heavier - 1) < 1e-2;
  return is_right ? 0 : 1;
}
