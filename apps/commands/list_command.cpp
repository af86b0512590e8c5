#include <memory>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/custom_forces/registry.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/scenes/catalog.hpp>
#include <weft/scenes/engine_kind.hpp>

#include "apps/app.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

/// Springs of a node whose whole neighborhood lies inside the cloth; the largest number of any
/// node.
int springs_of_inner_node(const ClothMesh& mesh) {
  std::vector<int> count(static_cast<std::size_t>(mesh.num_nodes()), 0);
  for (const EdgeSet& set : mesh.edge_sets) {
    for (const int node : set.edges.reshaped()) ++count[static_cast<std::size_t>(node)];
  }
  return *std::max_element(count.begin(), count.end());
}

void print_cloth(const scenes::Cloth& cloth) {
  const ClothMesh mesh = scenes::make_mesh(cloth);
  print("    {}: {} nodes, {} springs ({} per interior node), {} triangles, {} pinned, {:.6g} kg\n",
        cloth.name, mesh.num_nodes(), mesh.num_edges(), springs_of_inner_node(mesh),
        mesh.triangles.cols(), mesh.pinned.size(), mesh.masses.sum());
  for (const EdgeSet& set : mesh.edge_sets) {
    print("      springs \"{}\": {}\n", set.name, set.edges.cols());
  }
  for (const forces::LawSpecification& law : cloth.laws) {
    print("      law {}:", law.law);
    for (const forces::ParameterInfo& parameter : forces::find_law(law.law)->parameters) {
      const auto found = law.parameters.find(parameter.name);
      if (found == law.parameters.end()) continue;
      print(" {} =", parameter.name);
      for (const double value : found->second) print(" {:.6g}", value);
      if (parameter.unit != "1") print(" {}", parameter.unit);
      print(";");
    }
    print("\n");
  }
}

void print_scene(const scenes::CatalogEntry& entry, bool verbose) {
  const scenes::Scene scene = scenes::load_scene(std::string(entry.name));
  print("  {:<16} {}\n", scene.name, scene.summary);
  if (!verbose) return;
  print("    {:.6g} s in steps of {:.6g} s\n", scene.world.duration, scene.world.time_step);
  for (const scenes::Cloth& cloth : scene.cloths) print_cloth(cloth);
  for (const scenes::Collider& collider : scene.colliders) {
    print("    {}: {}\n", collider.name,
          collider.mass ? fmt::format("dynamic rigid body, {:.6g} kg", *collider.mass)
                        : std::string("fixed collider"));
  }
}

int list(bool verbose) {
  print("Scenes:\n");
  for (const scenes::CatalogEntry& entry : scenes::scene_catalog()) print_scene(entry, verbose);
  print("\nEngines:\n");
  for (const scenes::EngineInfo& engine : scenes::engine_table()) {
    const bool both = scenes::find_engine_kind(engine.name)->uses_bullet;
    print("  {:<26} {}{}\n", engine.name, engine.summary, both ? " (float32 and float64)" : "");
  }
  print("\nForce laws:\n");
  for (const forces::LawInfo* law : forces::all_laws()) {
    print("  {:<16} {}{}\n", law->id, law->summary,
          verbose ? fmt::format(": {}", law->formula) : "");
  }
  return kOk;
}

}  // namespace

Action add_list_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand("list", "List scenes, engines and force laws");
  auto verbose = std::make_shared<bool>(false);
  command->add_flag("-v,--verbose", *verbose,
                    "Node and spring counts, masses, laws and their values");
  return [verbose] { return list(*verbose); };
}

}  // namespace weft::app
