#include <weft/scenes/recording/trim.hpp>

#include <cmath>
#include <optional>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/frame_times.hpp>

namespace weft::scenes {
namespace {

std::string range_text(const TrimRange& range) {
  const std::string from =
      std::isinf(range.from) ? "the beginning" : fmt::format("{:.6g} s", range.from);
  return std::isinf(range.to) ? fmt::format("from {} to the end", from)
                              : fmt::format("from {} to {:.6g} s", from, range.to);
}

}  // namespace

std::vector<int> frames_to_keep(const RecordingReader& reader, const TrimRange& range) {
  if (range.every < 1) {
    throw InvalidArgument(fmt::format("trim: every = {}, expected >= 1", range.every));
  }
  if (reader.num_frames() == 0) throw InvalidArgument("has no frame to keep");
  const std::vector<int> all = frames_between(reader, range.from, range.to);
  if (all.empty()) {
    throw InvalidArgument(
        fmt::format("has no frame {}, expected a time from its {} frames, t = {:.6g} s to {:.6g} s",
                    range_text(range), reader.num_frames(), reader.frame_time(0),
                    reader.frame_time(reader.num_frames() - 1)));
  }
  std::vector<int> kept;
  for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(range.every)) {
    kept.push_back(all[i]);
  }
  return kept;
}

void copy_range(const RecordingReader& reader, const TrimRange& range, RecordingWriter& writer,
                const std::function<void(double)>& progress) {
  const std::vector<int> frames = frames_to_keep(reader, range);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SceneState state = reader.frame(frames[i]);
    if (range.rounding) round_state(state, *range.rounding);
    writer.add_frame(state, reader.marks(frames[i]));
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(frames.size()));
  }
  const double tolerance = time_tolerance(reader);
  const auto is_inside = [&](double time) {
    return time >= range.from - tolerance && time <= range.to + tolerance;
  };
  for (const std::string& name : reader.metric_names()) {
    for (const RecordingReader::Sample& sample : reader.metric(name)) {
      if (is_inside(sample.time)) writer.add_metric(name, sample.time, sample.value);
    }
  }
  for (const Note& note : reader.notes()) {
    if (is_inside(note.time)) writer.add_note(note);
  }
  const std::optional<BlowUp> blow_up = reader.blow_up();
  if (blow_up && is_inside(blow_up->time)) writer.set_blow_up(*blow_up);
}

Provenance trimmed_provenance(const RecordingReader& reader, const TrimRange& range) {
  const std::vector<int> frames = frames_to_keep(reader, range);
  Provenance provenance = reader.provenance();
  provenance["trimmed"] =
      fmt::format("frames {} to {} of {}{}, counted from 0{}", frames.front(), frames.back(),
                  reader.num_frames(), reader.finished() ? "" : " of a partial recording",
                  range.every > 1 ? fmt::format(", one in {}", range.every) : "");
  if (range.rounding) provenance[kRoundedKey] = rounding_text(*range.rounding);
  return provenance;
}

}  // namespace weft::scenes
