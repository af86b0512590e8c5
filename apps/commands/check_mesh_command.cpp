#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/scenes/import/import_mesh.hpp>

#include "apps/app.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct CheckMeshOptions {
  std::vector<std::string> files;
  import::ImportOptions import;
  std::string up = "y";
  double weld_tolerance = -1.0;
};

int check_meshes(CheckMeshOptions options) {
  options.import.up = options.up == "z" ? import::UpAxis::kZ : import::UpAxis::kY;
  if (options.weld_tolerance >= 0) options.import.weld_tolerance = options.weld_tolerance;
  int exit_code = kOk;
  for (const std::string& file : options.files) {
    try {
      const import::MeshReport report = import::check_mesh(file, options.import);
      print("{}:\n{}", file, report.text());
      if (const std::optional<std::string> fault = report.fault()) {
        throw import::ImportError(file, *fault);
      }
      print("ok, a body can be made of it\n");
    } catch (const InvalidArgument& error) {
      print(stderr, "weft: {}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

Action add_check_mesh_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "check-mesh", "Check mesh files: what is in them, and what keeps them from being a body");
  auto options = std::make_shared<CheckMeshOptions>();
  command->add_option("FILE", options->files, "Mesh files (OBJ, glTF, GLB, PLY, FBX, STL)")
      ->required();
  command->add_option("--part", options->import.part, "Only this node, mesh or material");
  command->add_option("--scale", options->import.scale, "Metres per unit of the file (1)");
  command->add_option("--up", options->up, "Axis of the file that points up: y (default) or z")
      ->check(CLI::IsMember({"y", "z"}));
  command
      ->add_option("--weld", options->weld_tolerance,
                   "Distance [m] within which vertices become one node "
                   "(a millionth of the diagonal)")
      ->check(CLI::NonNegativeNumber);
  return [options] { return check_meshes(*options); };
}

}  // namespace weft::app
