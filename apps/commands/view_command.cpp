#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>

#include "apps/app.hpp"

namespace weft::app {
namespace {

/// The words after "view"; the precision chooses the executable.
struct ViewWords {
  std::vector<std::string> words;
  std::string precision = "float32";
};

ViewWords words_after_view(const std::vector<std::string>& all) {
  ViewWords view;
  std::size_t i = 1;
  while (i < all.size() && all[i] != "view") ++i;
  for (++i; i < all.size(); ++i) {
    const std::string& word = all[i];
    if ((word == "-p" || word == "--precision") && i + 1 < all.size()) {
      view.precision = all[++i];
    } else if (word.starts_with("--precision=")) {
      view.precision = word.substr(std::string_view("--precision=").size());
    } else {
      view.words.push_back(word);
    }
  }
  if (view.precision != "float32" && view.precision != "float64") {
    throw InvalidArgument("--precision " + view.precision + ": expected float32 or float64");
  }
  return view;
}

int view(const CommandLine& command_line) {
  constexpr std::string_view kMissing = WEFT_VIEWER_MISSING;
  if (!kMissing.empty()) {
    throw Error(
        "view: this build has no window, for " + std::string(kMissing) +
        " was not there when it was configured; expected it installed and Weft built again");
  }
  ViewWords view = words_after_view(command_line.words);
  const std::filesystem::path program =
      command_line.executable.parent_path() /
      (view.precision == "float64" ? "weft-view-float64" : "weft-view");
  std::string name = program.string();
  std::vector<char*> arguments = {name.data()};
  for (std::string& word : view.words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  execv(program.c_str(), arguments.data());
  throw Error(name + ": cannot be started (" + std::strerror(errno) +
              "), expected the program with the window beside " + command_line.executable.string() +
              "; a whole build makes it (cmake --build --preset release)");
}

}  // namespace

Action add_view_command(CLI::App& parser, const CommandLine& command_line) {
  CLI::App* command = parser.add_subcommand(
      "view", "Open a window: simulate scenes, play recordings (weft view --help)");
  // All words are those of the program with the window.
  command->set_help_flag();
  command->prefix_command();
  return [command_line] { return view(command_line); };
}

}  // namespace weft::app
