// Writes docs/force_laws.md and docs/laws/*.md from the rows of the registry.

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include <weft/custom_forces/registry.hpp>

namespace weft::forces {
namespace {

/// The law's header in custom_forces/laws, relative to the source folder.
std::string header_of(std::string_view law) {
  const std::filesystem::path root = WEFT_SOURCE_DIR;
  const std::string name = fmt::format("{}.hpp", law);
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(root / "custom_forces" / "laws")) {
    if (entry.path().filename() == name) {
      return entry.path().lexically_relative(root).generic_string();
    }
  }
  throw std::runtime_error(fmt::format("no {} below custom_forces/laws", name));
}

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
  if (t.is_pointwise) text += "; acts on each node by itself";
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

std::string_view shapes(ElementKind kind) {
  switch (kind) {
    case ElementKind::kEdges:
      return "edges 2 x m";
    case ElementKind::kLines:
      return "triples 3 x m: end, centre, end";
    case ElementKind::kHinges:
      return "hinges 4 x h, from the triangles and the crossed triangles";
    case ElementKind::kFaces:
      return "triangles 3 x t";
    case ElementKind::kConnections:
      return "connections 2 x m: node, far node";
    case ElementKind::kNodeSets:
      return "nodes of the named regions";
    case ElementKind::kNodes:
      break;
  }
  return "no elements";
}

/// A value that a scene file could have: the default, or one in the middle of nowhere.
std::string example(const ParameterInfo& parameter) {
  const double value = parameter.required ? 1.0 : parameter.default_value;
  const std::string one = parameter.unit == "1" ? fmt::format("{:g}", value)
                                                : fmt::format("\"{:g} {}\"", value, parameter.unit);
  return parameter.size == 3 ? fmt::format("[{}, {}, {}]", one, one, one) : one;
}

std::string page(const LawInfo& law) {
  std::string text = fmt::format(
      "# Law `{}`\n\nGenerated from the law's row in the registry; do not edit. "
      "[All laws](../force_laws.md).\n\n{}.\n\n    {}\n\n",
      law.id, law.summary, law.formula);
  if (law.parameters.empty()) text += "No parameters.\n";
  text += "| Symbol | Parameter | Unit | Domain | Default | Meaning |\n|---|---|---|---|---|---|\n";
  for (const ParameterInfo& parameter : law.parameters) {
    text +=
        fmt::format("| {} | `{}` | {} | {} | {} | {} |\n", parameter.symbol, parameter.name,
                    parameter.unit, domain(parameter), default_of(parameter), parameter.summary);
  }
  text += fmt::format(
      "\n* Shapes: positions and velocities 3 x n, masses n; {}\n* Traits: {}\n* Source: {}\n"
      "* Checked by: the contract tests (`tests/contract`); {}\n* Signs, degenerate elements, "
      "errors: `{}`\n\nIn a scene file, with every parameter (values are "
      "examples):\n\n```toml\n[[cloth.law]]\nlaw = \"{}\"\n",
      shapes(law.traits.elements), traits(law.traits), law.source, law.checked_by,
      header_of(law.id), law.id);
  for (const ParameterInfo& parameter : law.parameters) {
    text += fmt::format("{} = {}\n", parameter.name, example(parameter));
  }
  return text + "```\n";
}

/// A bar would end the cell of a table.
std::string in_table(std::string_view formula) {
  std::string text;
  for (const char c : formula) text += c == '|' ? std::string("\\|") : std::string(1, c);
  return text;
}

std::string index() {
  std::string text =
      "# Which force laws are there?\n\n"
      "This page and those it links to are generated from the rows of\n"
      "`custom_forces/registry.cpp`; do not edit them. A test compares them with the registry and\n"
      "prints the command that writes them anew.\n\n"
      "Units are SI; the unit `1` is a dimensionless number. x, v are positions [m] and "
      "velocities\n"
      "[m/s], m masses [kg], l and l0 an edge's length and rest length [m], u its unit vector "
      "from\n"
      "node i to node j, E energy [J], f force on a node [N]. Every law is held to its traits by "
      "the\n"
      "tests in `tests/contract`. To add a law: `custom_forces/README.md`.\n\n"
      "| Law | What it does | Formula |\n|---|---|---|\n";
  for (const LawInfo* law : all_laws()) {
    text += fmt::format("| [`{}`](laws/{}.md) | {} | `{}` |\n", law->id, law->id, law->summary,
                        in_table(law->formula));
  }
  return text;
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace
}  // namespace weft::forces

int main(int argc, char** argv) {
  using namespace weft::forces;
  if (argc != 2) {
    fmt::print(stderr, "usage: weft_law_docs FOLDER\nwrites force_laws.md and laws/*.md\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder / "laws");
  write(folder / "force_laws.md", index());
  for (const LawInfo* law : all_laws()) {
    write(folder / "laws" / (std::string(law->id) + ".md"), page(*law));
  }
  return 0;
}
