// Prints docs/force_laws.md from the rows of the registry.

#include <string>

#include <fmt/core.h>

#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

std::string domain(const ParameterInfo& parameter) {
  if (parameter.size > 1) return fmt::format("{} finite numbers", parameter.size);
  if (parameter.maximum < ParameterInfo{}.maximum) {
    return fmt::format("{:g} to {:g}", parameter.minimum, parameter.maximum);
  }
  return fmt::format(">= {:g}", parameter.minimum);
}

std::string default_of(const ParameterInfo& parameter) {
  if (parameter.required) return "required";
  std::string text = fmt::format("{:g}", parameter.default_value);
  for (int i = 1; i < parameter.size; ++i) text += fmt::format(", {:g}", parameter.default_value);
  return text;
}

std::string_view elements(ElementKind kind) {
  switch (kind) {
    case ElementKind::kEdges:
      return "edges (`edge_sets`)";
    case ElementKind::kLines:
      return "three nodes in a row (`line_sets`)";
    case ElementKind::kHinges:
      return "hinges between triangles";
    case ElementKind::kFaces:
      return "triangles";
    case ElementKind::kConnections:
      return "connections (`connection_sets`)";
    case ElementKind::kNodeSets:
      return "regions of nodes (`node_sets`)";
    case ElementKind::kNodes:
      break;
  }
  return "nodes";
}

std::string traits(const LawTraits& t) {
  std::string text = fmt::format("acts on {}", elements(t.elements));
  text += t.internal ? "; internal: conserves linear and angular momentum"
                     : "; external: may change momentum";
  if (t.ignores_rigid_motion) text += "; feels no rigid motion";
  if (!t.free_at_rest) text += "; may act at the rest shape";
  text += t.has_energy ? "; has an energy" : "; stores no energy";
  if (t.dissipative) text += "; only takes energy out";
  if (t.needs_closed_surface) text += "; needs a closed surface";
  if (t.level == LawTraits::Level::kVelocity) {
    text += "; velocity level: engines apply its exact solution after their step";
  }
  if (t.level == LawTraits::Level::kInertia) {
    text += "; inertia level: engines apply it to the sum of all forces";
  }
  return text;
}

void print(const LawInfo& law) {
  fmt::print("\n## `{}`\n\n{}.\n\n    {}\n\n", law.id, law.summary, law.formula);
  fmt::print(
      "| Symbol | Parameter | Unit | Domain | Default | Meaning |\n|---|---|---|---|---|---|\n");
  for (const ParameterInfo& parameter : law.parameters) {
    fmt::print("| {} | `{}` | {} | {} | {} | {} |\n", parameter.symbol, parameter.name,
               parameter.unit, domain(parameter), default_of(parameter), parameter.summary);
  }
  fmt::print("\nTraits: {}.  \nSource: {}.\n", traits(law.traits), law.source);
}

}  // namespace
}  // namespace weft::forces

int main() {
  fmt::print(
      "# Which force laws are there?\n\n"
      "This page is generated from the rows of `custom_forces/registry.cpp`; do not edit it. A "
      "test\n"
      "compares it with the registry and prints the command that writes it anew.\n\n"
      "Units are SI; the unit `1` is a dimensionless number. x, v are positions [m] and "
      "velocities\n"
      "[m/s], m masses [kg], l and l0 an edge's length and rest length [m], u its unit vector "
      "from\n"
      "node i to node j, E energy [J], f force on a node [N]. Every law is held to its traits by "
      "the\n"
      "tests in `tests/contract`. To add a law: `custom_forces/README.md`.\n");
  for (const weft::forces::LawInfo* law : weft::forces::all_laws()) weft::forces::print(*law);
  return 0;
}
