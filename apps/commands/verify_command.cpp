#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/verify.hpp>

#include "apps/app.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

/// Frames with their times, as `weft trim` takes them.
std::string range_text(const scenes::RecordingReader& reader, const scenes::FrameRange& range) {
  return fmt::format("{} to {} (t = {:.6g} s to {:.6g} s)", range.first, range.last,
                     reader.frame_time(range.first), reader.frame_time(range.last));
}

void print_readable(const scenes::RecordingReader& reader,
                    const scenes::Verification& verification) {
  if (verification.num_frames == 0) return print("  no frame is committed\n");
  if (verification.num_readable == 0) {
    return print("  none of {} committed frames is readable\n", verification.num_frames);
  }
  if (verification.num_readable == verification.num_frames) {
    return print("  all {} committed frames are readable, {}\n", verification.num_frames,
                 range_text(reader, verification.readable.front()));
  }
  std::string ranges;
  for (const scenes::FrameRange& range : verification.readable) {
    ranges += (ranges.empty() ? "" : ", ") + range_text(reader, range);
  }
  print("  {} of {} committed frames are readable: {}\n", verification.num_readable,
        verification.num_frames, ranges);
}

void print_non_finite(const scenes::RecordingReader& reader,
                      const scenes::Verification& verification) {
  if (!verification.first_non_finite) return;
  const scenes::NonFiniteValue& first = *verification.first_non_finite;
  print(
      "  {} of them with values that are not finite, first frame {}, t = {:.6g} s: {}{} of body "
      "'{}'\n",
      verification.num_non_finite, first.frame, first.time, first.quantity,
      first.node ? fmt::format(" of node {}", *first.node) : "", first.body);
  const std::optional<scenes::BlowUp> blow_up = reader.blow_up();
  print("  {}\n", blow_up ? fmt::format("the run blew up at step {}, t = {:.6g} s", blow_up->step,
                                        blow_up->time)
                          : "no blow-up is recorded");
}

int verify(const std::string& file) {
  const scenes::RecordingReader reader(file);
  const scenes::Verification verification = [&] {
    ProgressBar progress("verify");
    return scenes::verify_recording(reader, [&](double part) { progress.update(part); });
  }();
  const char* verdict = !verification.faults.empty() ? "damaged"
                        : verification.is_sound()    ? "sound"
                                                     : "not finite";
  print("{}: {}{}\n", file, verdict,
        reader.finished() ? "" : ", a partial recording whose run has not ended or was stopped");
  print_readable(reader, verification);
  print_non_finite(reader, verification);
  for (const std::string& fault : verification.faults) print("  {}\n", fault);
  return verification.is_sound() ? kOk : kUnsound;
}

int verify_all(const std::vector<std::string>& files) {
  int exit_code = kOk;
  for (const std::string& file : files) {
    try {
      exit_code = std::max(exit_code, verify(file));
    } catch (const Error& error) {
      print(stderr, "weft: {}\n", error.what());
      exit_code = kBadInput;
    }
  }
  return exit_code;
}

}  // namespace

Action add_verify_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "verify", "Read every frame of a recording: which are sound, also in a damaged one?");
  auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("RECORDING", *files, "Recordings made by `weft run`")->required();
  command->footer(
      "Looks at the tables and their hashes, the scene, every frame with its chunk's hash, the\n"
      "metrics, and at each value, whether it is a finite number. A run that was stopped or "
      "killed\n"
      "leaves every committed frame readable. `weft trim` saves the readable frames of a damaged\n"
      "recording.\n"
      "Exit codes: 0 sound; 1 frames that cannot be read, a wrong hash, or values that are not\n"
      "finite; 2 not a recording that can be opened.");
  return [files] { return verify_all(*files); };
}

}  // namespace weft::app
