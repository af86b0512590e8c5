// Tested by tests/scenes/recording/round_trip_test.cpp, tests/scenes/recording/damage_test.cpp.

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/codec/chunk_codec.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/storage/asset_table.hpp>
#include <weft/scenes/recording/storage/mark_table.hpp>
#include <weft/scenes/recording/storage/open_recording.hpp>

namespace weft::scenes {
namespace {

struct StoredMetric {
  std::string name;
  RecordingReader::Sample sample;
};

StoredPrecision read_precision(const Header& header, const std::string& file) {
  const std::string& text = meta_value(header, "precision", file);
  if (text != "float32" && text != "float64") {
    throw Error(fmt::format("{}: precision = '{}', expected float32 or float64", file, text));
  }
  return text == "float64" ? StoredPrecision::kFloat64 : StoredPrecision::kFloat32;
}

std::int64_t count_in_meta(const Header& header, const std::string& key, const std::string& file) {
  const std::string& text = meta_value(header, key, file);
  std::int64_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc() || stop != end || count < 0) {
    throw Error(fmt::format("{}: '{}' in table meta is no number: the file is damaged", file, key));
  }
  return count;
}

/// Everything that shows or measures a recording takes the bodies of its scene for those of its
/// frames.
void check_bodies(const Scene& scene, const Header& header, const std::string& file) {
  const std::vector<RecordedBody> expected = recorded_bodies(scene);
  const auto is_same = [](const RecordedBody& a, const RecordedBody& b) {
    return a.name == b.name && a.is_cloth == b.is_cloth && a.num_nodes == b.num_nodes;
  };
  if (!std::equal(expected.begin(), expected.end(), header.bodies.begin(), header.bodies.end(),
                  is_same)) {
    throw Error(file + ": table body has not the bodies of the scene: the file is damaged");
  }
}

}  // namespace

struct RecordingReader::Impl {
  explicit Impl(const std::filesystem::path& the_path);

  /// A finished recording keeps its connection. While one is being written it is opened anew for
  /// each chunk: a connection at rest would keep the writer from removing its log at the end.
  template <class Read>
  auto with_database(const Read& read) const {
    return kept ? read(*kept) : read(open_recording(path));
  }

  std::vector<std::byte> read_chunk(const ChunkEntry& chunk) const;
  /// Decoded bytes of a frame's chunk; the last chunk is remembered.
  std::span<const std::byte> frame_bytes(int frame) const;
  const std::vector<StoredMetric>& metric_rows() const;
  const std::vector<MarkEntry>& mark_entries() const;
  std::string compute_content_hash() const;
  Scene read_scene() const;

  std::filesystem::path path;
  std::string file;
  std::optional<Database> kept;
  Header header;
  Topologies topologies;
  RecordingIndex index;
  Provenance provenance;

  // Computed when first asked for.
  mutable std::optional<Scene> scene;
  mutable std::optional<std::size_t> cached_chunk;
  mutable std::vector<std::byte> cached_bytes;
  mutable std::optional<std::vector<StoredMetric>> metrics;
  mutable std::optional<std::vector<MarkEntry>> marks;  ///< growing frames
  mutable std::string content_hash;
};

RecordingReader::Impl::Impl(const std::filesystem::path& the_path)
    : path(the_path), file(the_path.string()), kept(open_recording(the_path)) {
  kept->execute("BEGIN");  // one moment of a recording that may be growing
  header = read_header(*kept, file);
  const FrameCodec codec(header.bodies, read_precision(header, file));
  if (static_cast<std::int64_t>(codec.frame_bytes()) > kMaxFrameBytes) {
    throw Error(fmt::format("{}: a frame has {} bytes, expected at most {}: the file is damaged",
                            file, codec.frame_bytes(), kMaxFrameBytes));
  }
  topologies = Topologies(*kept, header, codec, file);
  index = read_index(*kept, header, topologies, file);
  kept->execute("COMMIT");
  for (const auto& [key, value] : header.meta) {
    if (key.starts_with(kProvenancePrefix)) {
      provenance[key.substr(kProvenancePrefix.size())] = value;
    }
  }
  if (meta_value(header, "finished", file) != "yes") {
    kept.reset();
  }
}

std::vector<std::byte> RecordingReader::Impl::read_chunk(const ChunkEntry& chunk) const {
  try {
    const std::vector<std::byte> data = with_database([&](const Database& database) {
      Statement row = database.prepare("SELECT data FROM chunk WHERE id = ?");
      row.bind(1, chunk.id);
      if (!row.step()) {
        throw Error(file + ": no such chunk");
      }
      return row.blob(0);
    });
    StreamHash hash;
    hash.add(data);
    if (hash.hex() != chunk.hash) {
      throw Error(file + ": data does not have its hash");
    }
    if (chunk.codec != kCodecName) {
      throw Error(fmt::format("{}: unknown codec '{}'", file, chunk.codec));
    }
    return decompress_chunk(data, static_cast<std::size_t>(chunk.raw_bytes),
                            topologies.codec_at(0).scalar_bytes());
  } catch (const Error& error) {
    const auto last = chunk.first_frame + static_cast<std::int64_t>(chunk.times.size()) - 1;
    throw Error(fmt::format("{} (chunk {}, frames {} to {})", error.what(), chunk.id,
                            chunk.first_frame, last));
  }
}

std::span<const std::byte> RecordingReader::Impl::frame_bytes(int frame) const {
  if (frame < 0 || static_cast<std::size_t>(frame) >= index.times.size()) {
    throw InvalidArgument(fmt::format("{}: frame = {}, expected 0 to {}", file, frame,
                                      static_cast<int>(index.times.size()) - 1));
  }
  const std::size_t chunk = index.chunk_of[static_cast<std::size_t>(frame)];
  if (cached_chunk != chunk) {
    cached_chunk.reset();
    cached_bytes = read_chunk(index.chunks[chunk]);
    cached_chunk = chunk;
  }
  return std::span(cached_bytes)
      .subspan(index.offsets[static_cast<std::size_t>(frame)],
               topologies.codec_at(frame).frame_bytes());
}

const std::vector<StoredMetric>& RecordingReader::Impl::metric_rows() const {
  if (metrics) {
    return *metrics;
  }
  std::vector<StoredMetric> found;
  StreamHash hash;
  with_database([&](const Database& database) {
    Statement select =
        database.prepare("SELECT name, time_s, value FROM metric WHERE id <= ? ORDER BY id");
    select.bind(1, count_in_meta(header, "num_metrics", file));
    while (select.step()) {
      found.push_back({select.text(0), {select.real(1), select.real(2)}});
      const StoredMetric& row = found.back();
      add_to_metric_hash(hash, row.name, row.sample.time, row.sample.value);
    }
    return 0;
  });
  if (hash.hex() != meta_value(header, "metric_hash", file)) {
    throw Error(file + ": table metric does not have its hash: the file is damaged");
  }
  metrics = std::move(found);
  return *metrics;
}

const std::vector<MarkEntry>& RecordingReader::Impl::mark_entries() const {
  if (!marks) {
    marks = with_database(
        [&](const Database& database) { return read_mark_entries(database, header, file); });
  }
  return *marks;
}

std::string RecordingReader::Impl::compute_content_hash() const {
  ContentHash hash(header.scene_text, topologies.codec_at(0).precision());
  for (std::size_t i = 0; i < index.times.size(); ++i) {
    const auto frame = static_cast<std::int64_t>(i);
    if (topologies.begins_at(frame)) {
      with_database([&](const Database& database) {
        topologies.add_to_hash(database, frame, hash);
        return 0;
      });
    }
    hash.add_frame(index.times[i], frame_bytes(static_cast<int>(i)));
  }
  std::string found = hash.hex(header.blow_up);
  if (found != meta_value(header, "content_hash", file)) {
    throw Error(file + ": the content does not have its hash: the file is damaged");
  }
  return found;
}

Scene RecordingReader::Impl::read_scene() const {
  Scene assets;
  assets.files =
      with_database([&](const Database& database) { return read_assets(database, header, file); });
  const FileSource own = files_of(assets);
  Scene scene = read_scene_text(header.scene_text, file, [&](const std::string& name) {
    std::optional<std::string> bytes = own(name);
    if (!bytes) {
      throw InvalidArgument("is not in the recording, expected one that needs no other file");
    }
    return bytes;
  });
  check_bodies(scene, header, file);
  return scene;
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : impl_(std::make_unique<Impl>(path)) {}
RecordingReader::~RecordingReader() = default;

const Scene& RecordingReader::scene() const {
  if (!impl_->scene) {
    impl_->scene = impl_->read_scene();
  }
  return *impl_->scene;
}

const std::string& RecordingReader::scene_text() const {
  return impl_->header.scene_text;
}
const Provenance& RecordingReader::provenance() const {
  return impl_->provenance;
}
StoredPrecision RecordingReader::precision() const {
  return impl_->topologies.codec_at(0).precision();
}
bool RecordingReader::finished() const {
  return impl_->header.meta.at("finished") == "yes";
}
std::optional<BlowUp> RecordingReader::blow_up() const {
  return impl_->header.blow_up;
}
int RecordingReader::num_frames() const {
  return static_cast<int>(impl_->index.times.size());
}

std::string RecordingReader::content_hash() const {
  if (impl_->content_hash.empty()) {
    impl_->content_hash = impl_->compute_content_hash();
  }
  return impl_->content_hash;
}

double RecordingReader::frame_time(int frame) const {
  if (frame < 0 || frame >= num_frames()) {
    throw InvalidArgument(
        fmt::format("{}: frame = {}, expected 0 to {}", impl_->file, frame, num_frames() - 1));
  }
  return impl_->index.times[static_cast<std::size_t>(frame)];
}

SceneState RecordingReader::frame(int frame) const {
  const double time = frame_time(frame);  // refuses a frame that is not there
  SceneState state = impl_->topologies.codec_at(frame).decode(impl_->frame_bytes(frame));
  state.time = time;
  if (!impl_->topologies.empty()) {
    impl_->with_database([&](const Database& database) {
      impl_->topologies.set(database, frame, state);
      return 0;
    });
  }
  return state;
}

std::vector<Mark> RecordingReader::marks(int frame) const {
  (void)frame_time(frame);  // refuses a frame that is not there
  std::vector<Mark> found;
  const std::vector<MarkEntry>& entries = impl_->mark_entries();
  const auto is_before = [](const MarkEntry& entry, int wanted) { return entry.frame < wanted; };
  auto entry = std::lower_bound(entries.begin(), entries.end(), frame, is_before);
  if (entry == entries.end() || entry->frame != frame) return found;
  return impl_->with_database([&](const Database& database) {
    for (; entry != entries.end() && entry->frame == frame; ++entry) {
      found.push_back(read_mark(database, *entry, impl_->file));
    }
    return found;
  });
}

std::vector<Note> RecordingReader::notes() const {
  return impl_->with_database(
      [&](const Database& database) { return read_notes(database, impl_->header, impl_->file); });
}

std::vector<std::string> RecordingReader::metric_names() const {
  std::set<std::string> names;
  for (const StoredMetric& row : impl_->metric_rows()) {
    names.insert(row.name);
  }
  return {names.begin(), names.end()};
}

std::vector<RecordingReader::Sample> RecordingReader::metric(const std::string& name) const {
  std::vector<Sample> samples;
  for (const StoredMetric& row : impl_->metric_rows()) {
    if (row.name == name) {
      samples.push_back(row.sample);
    }
  }
  return samples;
}

}  // namespace weft::scenes
