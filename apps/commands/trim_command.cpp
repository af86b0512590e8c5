#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/recording_output.hpp>
#include <weft/scenes/recording/trim.hpp>

#include "apps/app.hpp"
#include "apps/progress/interruption.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/quantity_option.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

struct TrimOptions {
  std::string recording;
  std::string output;
  std::string from;
  std::string to;
  int every = 1;
  std::string error;
  bool force = false;
};

scenes::TrimRange range_of(const TrimOptions& options) {
  scenes::TrimRange range;
  if (!options.from.empty()) range.from = quantity_option("--from", options.from, "s");
  if (!options.to.empty()) range.to = quantity_option("--to", options.to, "s");
  if (range.from > range.to) {
    throw InvalidArgument(
        fmt::format("--from \"{}\": is later than --to \"{}\", expected a time "
                    "before it",
                    options.from, options.to));
  }
  range.every = options.every;
  return range;
}

void refuse_same_file(const TrimOptions& options) {
  std::error_code ignored;  // the output need not be there
  if (std::filesystem::equivalent(options.recording, options.output, ignored)) {
    throw InvalidArgument("-o " + options.output +
                          ": is the recording to trim, expected another name");
  }
}

/// Asked for before the output is touched, so that the error is about the recording.
std::vector<int> kept_frames(const scenes::RecordingReader& reader, const TrimOptions& options,
                             const scenes::TrimRange& range) {
  try {
    return scenes::frames_to_keep(reader, range);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("{}: {}", options.recording, error.what()));
  }
}

/// Writes the partial recording and gives the content hash of what is in it.
std::string copy(const scenes::RecordingReader& reader, const scenes::TrimRange& range,
                 const std::filesystem::path& partial) {
  scenes::RecordingWriter writer(partial, reader.scene(), scenes::trimmed_provenance(reader, range),
                                 reader.precision());
  ProgressBar progress("trim");
  const Interruption interruption;
  scenes::copy_range(reader, range, writer, [&](double part) {
    progress.update(part);
    Interruption::check();
  });
  return writer.finish();
}

int trim(const TrimOptions& options) {
  scenes::TrimRange range = range_of(options);
  const scenes::RecordingReader reader(options.recording);
  refuse_same_file(options);
  if (!options.error.empty()) {
    range.rounding = scenes::rounding_bounds(quantity_option("--error", options.error, "m"),
                                             reader.scene().world.frame_interval);
  }
  const std::vector<int> frames = kept_frames(reader, options, range);
  note_if_partial(reader, options.recording);
  const scenes::RecordingOutput output(options.output, options.force);
  std::string hash;
  try {
    hash = copy(reader, range, output.partial());
  } catch (...) {
    output.discard();  // nothing is lost: all of it is in the recording that was read
    throw;
  }
  output.publish();
  print("{}: {} of {} frames, t = {:.6g} s to {:.6g} s\ncontent hash {}\n", options.output,
        frames.size(), reader.num_frames(), reader.frame_time(frames.front()),
        reader.frame_time(frames.back()), hash);
  if (range.rounding) print("rounded: {}\n", scenes::rounding_text(*range.rounding));
  return kOk;
}

}  // namespace

Action add_trim_command(CLI::App& parser) {
  CLI::App* command =
      parser.add_subcommand("trim", "Write a part of a recording as a recording of its own");
  auto options = std::make_shared<TrimOptions>();
  command
      ->add_option("RECORDING", options->recording, "Recording made by `weft run`, stays as it is")
      ->required();
  command->add_option("-o,--output", options->output, "Recording to write")->required();
  command->add_option("--from", options->from,
                      "First time to keep, e.g. \"1 s\" (default: the first frame)");
  command->add_option("--to", options->to,
                      "Last time to keep, e.g. \"1.5 s\" (default: the last frame)");
  command->add_option("--every", options->every, "Keep the first frame and then one in so many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--error", options->error,
                      "Round coordinates by at most so much, e.g. \"0.1 mm\", which makes a "
                      "smaller file; velocities by as "
                      "much in a frame interval (default: every bit is kept)");
  command->add_flag("-f,--force", options->force, "Replace an existing recording");
  return [options] { return trim(*options); };
}

}  // namespace weft::app
