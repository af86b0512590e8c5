#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/recording.hpp>

#include "apps/app.hpp"
#include "apps/partial_note.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

void show(const std::string& file) {
  const scenes::RecordingReader reader(file);
  const std::string hash = reader.content_hash();  // reads and checks every frame
  print("{}: {} recording of scene '{}'\n", file, reader.finished() ? "finished" : "partial",
        reader.scene().name);
  if (reader.num_frames() == 0) {
    print("  no frame\n");
  } else {
    const int last = reader.num_frames() - 1;
    print("  {} frames, t = {:.6g} s to {:.6g} s of {:.6g} s\n", reader.num_frames(),
          reader.frame_time(0), reader.frame_time(last), reader.scene().world.duration);
  }
  if (const std::optional<scenes::BlowUp> blow_up = reader.blow_up()) {
    print("  blew up at step {}, t = {:.6g} s, body '{}', node {}: {}\n", blow_up->step,
          blow_up->time, blow_up->body, blow_up->node, blow_up->reason);
  }
  for (const auto& [key, value] : reader.provenance()) print("  {}: {}\n", key, value);
  print("  content hash {}\n", hash);
  note_if_partial(reader, file);
}

int show_all(const std::vector<std::string>& files) {
  int exit_code = kOk;
  for (const std::string& file : files) {
    try {
      show(file);
    } catch (const Error& error) {
      print(stderr, "weft: {}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

Action add_info_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "info", "What is in a recording, finished or partial; checks every frame");
  auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("RECORDING", *files, "Recordings made by `weft run`")->required();
  return [files] { return show_all(*files); };
}

}  // namespace weft::app
