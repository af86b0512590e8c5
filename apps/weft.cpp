// The weft command: parse, call the library, print.
#include <cstdio>
#include <exception>
#include <map>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/app.hpp"
#include "apps/progress/interruption.hpp"
#include "apps/terminal.hpp"

namespace {

constexpr const char* kFooter = R"(Examples:
  weft list                                  what scenes there are
  weft run drape_sphere -o drape.weftrec     simulate and record, with the reference solver
  weft run drape_sphere --engine bullet_forces --precision float64 -o drape.weftrec
  weft info drape.weftrec                    how far it goes, and whether it is whole
  weft diff drape.weftrec other.weftrec      are they equal bit for bit, and if not, how far apart?
  weft trim drape.weftrec -o part.weftrec --from "1 s" --to "2 s"
  weft verify drape.weftrec                  is every frame readable, every hash right?
  weft view drape_sphere                     a window: simulate, look, pull; recordings too
  weft render drape.weftrec -o drape.png     a picture of the last frame
  weft export --html d.html drape.weftrec    a page that plays it in any browser
  weft import hang --pc2 cloth.pc2 --frame-rate "50 Hz" -o theirs.weftrec
  weft validate --recording theirs.weftrec   another program's result, judged as an engine's is
  weft check my_scene.toml                   is this scene file right?
  weft check-mesh shirt.obj                  can a body be made of this mesh?
  weft stability hang                        the largest stable step, over stiffness and inertia
  weft reference hang -o hang.json           run to convergence, with two integrators
  weft validate -o report                    every case in every engine, as report/index.html

A SCENE is a name from `weft list` or the path of a scene file (TOML).
A file is never written over another one, except what the same command made before; a recording only with --force.
A run that is stopped keeps its frames in NAME.partial.weftrec.
Exit codes: 0 ok; 1 a case failed, a simulation blew up, two recordings differ, or one is not sound;
2 bad input or no place for the output; 128 + n stopped by signal n.)";

/// A shell variable that is not set makes an empty text, which is not the same as none.
void refuse_empty_texts(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) throw CLI::ValidationError(option->get_name(), "is empty, expected a text");
    }
  }
}

int run(int argc, char** argv) {
  using namespace weft::app;
  CLI::App parser("weft: validated cloth for the Bullet physics engine");
  parser.footer(kFooter);
  parser.require_subcommand(1);
  parser.set_version_flag("--version", "weft " WEFT_VERSION);
  parser.get_formatter()->column_width(36);

  CommandLine command_line;
  command_line.words.assign(argv, argv + argc);
  command_line.executable = std::filesystem::read_symlink("/proc/self/exe");

  // Actions by subcommand, in the order in which --help lists them.
  std::map<std::string, Action> actions;
  actions["list"] = add_list_command(parser);
  actions["run"] = add_run_command(parser, command_line);
  actions["info"] = add_info_command(parser);
  actions["diff"] = add_diff_command(parser);
  actions["trim"] = add_trim_command(parser);
  actions["verify"] = add_verify_command(parser);
  actions["view"] = add_view_command(parser, command_line);
  actions["render"] = add_render_command(parser);
  actions["contact-sheet"] = add_contact_sheet_command(parser);
  actions["export"] = add_export_command(parser);
  actions["import"] = add_import_command(parser);
  actions["check"] = add_check_command(parser);
  actions["check-mesh"] = add_check_mesh_command(parser);
  actions["contact-table"] = add_contact_table_command(parser);
  actions["stability"] = add_stability_command(parser);
  actions["reference"] = add_reference_command(parser);
  actions["validate"] = add_validate_command(parser, command_line);

  try {
    parser.parse(argc, argv);
    refuse_empty_texts(*parser.get_subcommands().front());
  } catch (const CLI::Success& asked) {  // --help, --version
    return parser.exit(asked);
  } catch (const CLI::ParseError& error) {
    print(stderr, "weft: {}\nTry: weft --help\n", error.what());
    return kBadInput;
  }
  return actions.at(parser.get_subcommands().front()->get_name())();
}

int run_or_say_why(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const weft::app::Interrupted& stop) {
    weft::app::print(stderr, "weft: {}\n", stop.what());
    return weft::app::kSignal + stop.signal();
  } catch (const std::exception& error) {
    weft::app::print(stderr, "weft: {}\n", weft::app::reason_of(error));
    return weft::app::kBadInput;
  }
}

}  // namespace

std::string weft::app::reason_of(const std::exception& error) {
  const bool is_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  return is_memory ? "there is not enough memory" : error.what();
}

int main(int argc, char** argv) {
  weft::app::prepare_output();
  return weft::app::finish_output(run_or_say_why(argc, argv));
}
