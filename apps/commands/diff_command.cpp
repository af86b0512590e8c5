#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <weft/core/error.hpp>
#include <weft/engines/engine_table.hpp>
#include <weft/playback/rendering/image.hpp>
#include <weft/playback/rendering/montage.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/output/output_file.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/validation/recordings/recording_difference.hpp>

#include "apps/app.hpp"
#include "apps/progress/partial_note.hpp"
#include "apps/progress/progress_bar.hpp"
#include "apps/terminal.hpp"

namespace weft::app {
namespace {

using validation::BodyDifference;
using validation::RecordingDifference;

struct DiffOptions {
  std::string a;
  std::string b;
  std::string picture;
};

/// The two recordings with the names that the user gave them.
struct Recordings {
  explicit Recordings(const DiffOptions& options)
      : name_a(options.a), name_b(options.b), a(options.a), b(options.b) {}
  std::string name_a;
  std::string name_b;
  scenes::RecordingReader a;
  scenes::RecordingReader b;
};

/// Removes and returns the first line of a text.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

/// Shows a long line, such as a mesh of many nodes, by its beginning.
std::string shortened(std::string_view line) {
  constexpr std::size_t kMaxLength = 60;
  return line.size() <= kMaxLength ? std::string(line)
                                   : std::string(line.substr(0, kMaxLength)) + " ...";
}

void print_scenes(const Recordings& recordings) {
  std::string_view a = recordings.a.scene_text();
  std::string_view b = recordings.b.scene_text();
  if (a == b) return;
  for (int number = 1;; ++number) {
    const std::string_view line_a = take_line(a);
    const std::string_view line_b = take_line(b);
    if (line_a == line_b && !(a.empty() && b.empty())) continue;
    print("  the scenes differ, first in line {}: '{}' and '{}'\n", number, shortened(line_a),
          shortened(line_b));
    return;
  }
}

void print_blow_up(const std::string& name, const std::optional<scenes::BlowUp>& blow_up) {
  if (!blow_up) return print("  {}: no blow-up\n", name);
  print("  {}: blew up at step {}, t = {:.6g} s, body '{}', node {}: {}\n", name, blow_up->step,
        blow_up->time, blow_up->body, blow_up->node, blow_up->reason);
}

std::string engine_of(const scenes::RecordingReader& reader) {
  const auto engine = reader.provenance().find("engine");
  return engine == reader.provenance().end() ? "unknown" : engine->second;
}

void print_engines(const Recordings& recordings) {
  const std::string a = engine_of(recordings.a);
  const std::string b = engine_of(recordings.b);
  if (a != b) print("  engines: {} and {}\n", a, b);
}

std::string frames_text(int a, int b) {
  return a == b ? fmt::format("frame {}", a) : fmt::format("frames {} and {}", a, b);
}

void print_first(const RecordingDifference& difference) {
  if (difference.num_common == 0) return;
  if (!difference.first) {
    print("  the frames at common times are equal bit for bit\n");
    return;
  }
  const validation::FirstDifference& first = *difference.first;
  const std::string when =
      fmt::format("{}, t = {:.6g} s", frames_text(first.frame_a, first.frame_b), first.time);
  if (first.body.empty()) {
    print("  first difference: {}, in the last digits of the time\n", when);
  } else {
    print("  first difference: {}, body '{}', {}{}\n", when, first.body, first.quantity,
          first.node ? fmt::format(" of node {}", *first.node) : "");
  }
}

void print_body(const BodyDifference& body) {
  const std::string note = body.note.empty() ? "" : "; it " + body.note;
  const std::string name =
      fmt::format("{} '{}'", body.is_cloth ? "cloth" : "rigid body", body.name);
  if (body.num_times == 0) {
    print("  {}: no distance{}\n", name, note);
  } else if (body.largest == 0 && body.largest_angle == 0) {
    print("  {}: at the same place{}\n", name, note);
  } else if (body.is_cloth) {
    print(
        "  {}: at most {:.4g} m apart, node {} at t = {:.6g} s; rms {:.4g} m then, {:.4g} m over "
        "all common times{}\n",
        name, body.largest, body.node, body.time, body.rms, body.rms_all, note);
  } else {
    print(
        "  {}: at most {:.4g} m apart, at t = {:.6g} s; rms {:.4g} m over all common times; "
        "turned by at most {:.4g} rad{}\n",
        name, body.largest, body.time, body.rms_all, body.largest_angle, note);
  }
}

void print_difference(const Recordings& recordings, const RecordingDifference& difference) {
  print("{} and {}: {}\n", recordings.name_a, recordings.name_b,
        difference.is_equal() ? fmt::format("equal bit for bit, {} frames", difference.num_frames_a)
                              : "different");
  print_scenes(recordings);
  print_engines(recordings);
  if (difference.is_equal()) return;
  if (!difference.is_same_precision) {
    print("  stored as {} and {}\n", scenes::to_string(recordings.a.precision()),
          scenes::to_string(recordings.b.precision()));
  }
  print("  {} and {} frames, {} of them at common times{}\n", difference.num_frames_a,
        difference.num_frames_b, difference.num_common,
        difference.largest_time_gap > 0
            ? fmt::format(", which are up to {:.2g} s apart", difference.largest_time_gap)
            : "");
  if (!difference.is_same_blow_up) {
    print_blow_up(recordings.name_a, recordings.a.blow_up());
    print_blow_up(recordings.name_b, recordings.b.blow_up());
  }
  print_first(difference);
  for (const BodyDifference& body : difference.bodies) print_body(body);
  for (const std::string& name : difference.only_in_a) {
    print("  body '{}': in {} alone\n", name, recordings.name_a);
  }
  for (const std::string& name : difference.only_in_b) {
    print("  body '{}': in {} alone\n", name, recordings.name_b);
  }
}

scenes::Image drawn(const scenes::RecordingReader& reader, const std::string& file, int frame) {
  scenes::Image picture =
      scenes::Renderer(reader.scene()).render(reader.frame(frame), scenes::RenderOptions{});
  scenes::draw_label(
      picture, fmt::format("{}, t = {:.4g} s", std::filesystem::path(file).filename().string(),
                           reader.frame_time(frame)));
  return picture;
}

/// The frame of the largest distance of both recordings, side by side.
void draw(const Recordings& recordings, const RecordingDifference& difference,
          const output::OutputFile& output) {
  const BodyDifference* farthest = difference.farthest();
  if (!farthest) {
    throw Error(output.path().string() +
                ": is not drawn, expected recordings with a common time and a common body");
  }
  const std::vector<scenes::Image> pictures = {
      drawn(recordings.a, recordings.name_a, farthest->frame_a),
      drawn(recordings.b, recordings.name_b, farthest->frame_b)};
  output.write(scenes::encode_png(scenes::filmstrip(pictures, 2)));
  print("{}: t = {:.4g} s\n", output.path().string(), farthest->time);
}

int diff(const DiffOptions& options) {
  const Recordings recordings(options);
  std::optional<output::OutputFile> output;
  if (!options.picture.empty()) output.emplace(options.picture, scenes::kPictureKind);
  note_if_partial(recordings.a, recordings.name_a);
  note_if_partial(recordings.b, recordings.name_b);
  const RecordingDifference difference = [&] {
    ProgressBar progress("diff");
    return validation::compare_recordings(recordings.a, recordings.b,
                                          [&](double part) { progress.update(part); });
  }();
  print_difference(recordings, difference);
  if (output) draw(recordings, difference, *output);
  return difference.is_equal() ? kOk : kDifferent;
}

}  // namespace

Action add_diff_command(CLI::App& parser) {
  CLI::App* command = parser.add_subcommand(
      "diff", "Are two recordings equal bit for bit, and if not, how far are they apart?");
  auto options = std::make_shared<DiffOptions>();
  command->add_option("A", options->a, "Recording made by `weft run`")->required();
  command->add_option("B", options->b, "Recording to hold against it")->required();
  command->add_option("-o,--output", options->picture,
                      "PNG to write: both at the time of the largest distance, side by side");
  command->footer(
      "Frames of the same time are compared, whose times may differ by a thousandth of the frame\n"
      "interval. Distances are in meters; rms is weighted by the area of each node.\n"
      "Exit codes: 0 equal in precision, frames and blow-up, bit for bit; 1 different; 2 bad "
      "input\n"
      "or no place for the output. Scene texts that differ are shown and do not count.");
  return [options] { return diff(*options); };
}

}  // namespace weft::app
