// Tested by tests/scenes/recording/round_trip_test.cpp, tests/scenes/recording/recording_output_test.cpp.

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <thread>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/codec/chunk_codec.hpp>
#include <weft/scenes/recording/codec/topology_writer.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/recording/storage/asset_table.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>
#include <weft/scenes/recording/storage/mark_table.hpp>

namespace weft::scenes {
namespace {

/// Metrics without frames are committed when there are so many.
constexpr std::size_t kMaxPendingMetrics = 4096;

/// How often finish() asks for the exclusive moment in which the log file goes away, while somebody
/// reads.
constexpr int kJournalAttempts = 20;
constexpr std::chrono::milliseconds kJournalPause{50};

struct MetricRow {
  std::string name;
  double time;
  double value;
};

/// SQLite stores -0.0 as 0; hash and file must agree.
double without_negative_zero(double value) {
  return value + 0.0;
}

/// Makes the empty file; fails if there is one, without a gap between the question and the answer.
void reserve(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "wbx");
  if (file == nullptr) {
    const int reason = errno;
    throw Error(
        reason == EEXIST
            ? fmt::format("{}: exists already; a recording is never overwritten", path.string())
            : fmt::format("{}: cannot create: {}", path.string(), std::strerror(reason)));
  }
  std::fclose(file);
}

void remove_files(const std::filesystem::path& path) {
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) {
    std::error_code ignored;
    std::filesystem::remove(path.string() + suffix, ignored);
  }
}

Header make_header(const Scene& scene, const Provenance& provenance, StoredPrecision precision) {
  Header header;
  header.scene_text = write_scene(scene);
  header.bodies = recorded_bodies(scene);
  header.meta["precision"] = precision == StoredPrecision::kFloat64 ? "float64" : "float32";
  header.meta["byte_order"] = "little";
  if (!scene.files.empty()) header.meta[kAssetHashKey] = asset_hash(scene.files);
  for (const auto& [key, value] : provenance) {
    header.meta[std::string(kProvenancePrefix) + key] = value;
  }
  return header;
}

}  // namespace

struct RecordingWriter::Impl {
  Impl(const std::filesystem::path& path, Header header, const std::vector<SceneFile>& assets,
       StoredPrecision precision, const ChunkLimits& limits, bool can_tear);

  void create_tables(const std::vector<SceneFile>& assets);
  void require_usable() const;
  /// One transaction with everything that is pending.
  void commit();
  void write_pending();
  void write_chunk();
  void write_metrics();
  void write_event();
  void update_meta();
  void finish();

  std::string file;
  ChunkLimits limits;
  Header header;
  FrameCodec codec;
  TopologyWriter topologies;
  MarkWriter marks;
  std::optional<Database> database;
  ContentHash content_hash;
  StreamHash index_hash;
  StreamHash metric_hash;

  std::vector<std::byte> raw;  ///< frames that are not yet written
  std::vector<double> times;   ///< their times [s]
  std::vector<MetricRow> metrics;
  bool event_pending = false;

  std::int64_t num_chunks = 0;
  std::int64_t num_frames = 0;  ///< written
  std::int64_t num_metrics = 0;
  double last_time = -std::numeric_limits<double>::infinity();
  bool finished = false;
  bool broken = false;  ///< a commit failed: nothing more can be promised
  Committed committed;
};

RecordingWriter::Impl::Impl(const std::filesystem::path& path, Header the_header,
                            const std::vector<SceneFile>& assets, StoredPrecision precision,
                            const ChunkLimits& the_limits, bool can_tear)
    : file(path.string()),
      limits(the_limits),
      header(std::move(the_header)),
      codec(header.bodies, precision),
      topologies(header.bodies, can_tear),
      content_hash(header.scene_text, precision) {
  database.emplace(path, Database::Access::kReadWrite);
  create_tables(assets);
}

void RecordingWriter::Impl::create_tables(const std::vector<SceneFile>& assets) {
  // Made in one piece before the log is switched on: who sees the tables sees a valid recording.
  database->execute(fmt::format("PRAGMA application_id={}; PRAGMA user_version={}; BEGIN IMMEDIATE",
                                kApplicationId,
                                topologies.can_tear() ? kTornFormatVersion : kFormatVersion));
  database->execute(std::string(kTableSchema));
  if (topologies.can_tear()) database->execute(std::string(kTopologySchema));
  database->prepare("INSERT INTO scene VALUES (?)")
      .bind(1, std::string_view(header.scene_text))
      .run();
  std::int64_t id = 0;
  for (const RecordedBody& body : header.bodies) {
    database->prepare("INSERT INTO body VALUES (?, ?, ?, ?)")
        .bind(1, id++)
        .bind(2, std::string_view(body.name))
        .bind(3, std::string_view(body.is_cloth ? "cloth" : "rigid"))
        .bind(4, std::int64_t{body.num_nodes})
        .run();
  }
  if (!assets.empty()) write_assets(*database, assets);
  update_meta();
  database->execute("COMMIT; PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL");
}

void RecordingWriter::Impl::require_usable() const {
  if (finished || broken) {
    throw Error(fmt::format("{}: cannot add to a recording {}", file,
                            finished ? "that is finished" : "after a failed write"));
  }
}

void RecordingWriter::Impl::commit() {
  try {
    database->execute("BEGIN IMMEDIATE");
    write_pending();
    database->execute("COMMIT");
    committed = {static_cast<int>(num_frames), last_time};
  } catch (...) {
    broken = true;
    finished = false;
    database.reset();  // rolls back
    throw;
  }
}

void RecordingWriter::Impl::write_pending() {
  if (!times.empty()) {
    write_chunk();
  }
  marks.write(*database);
  write_metrics();
  if (event_pending) {
    write_event();
  }
  update_meta();
}

void RecordingWriter::Impl::write_chunk() {
  topologies.write(*database);
  const auto data = compress_chunk(raw, codec.scalar_bytes());
  StreamHash hash;
  hash.add(data);
  const ChunkEntry chunk{
      num_chunks, num_frames, static_cast<std::int64_t>(raw.size()), std::string(kCodecName),
      hash.hex(), times};
  database->prepare("INSERT INTO chunk VALUES (?, ?, ?, ?, ?, ?, ?)")
      .bind(1, chunk.id)
      .bind(2, chunk.first_frame)
      .bind(3, static_cast<std::int64_t>(times.size()))
      .bind(4, std::string_view(chunk.codec))
      .bind(5, chunk.raw_bytes)
      .bind(6, std::string_view(chunk.hash))
      .bind(7, std::span<const std::byte>(data))
      .run();
  Statement insert = database->prepare("INSERT INTO frame VALUES (?, ?, ?)");
  for (const double time : times) {
    insert.bind(1, num_frames++).bind(2, time).bind(3, chunk.id).run();
  }
  add_to_index_hash(index_hash, chunk);
  ++num_chunks;
  raw.clear();
  times.clear();
}

void RecordingWriter::Impl::write_metrics() {
  Statement insert = database->prepare("INSERT INTO metric VALUES (?, ?, ?, ?)");
  for (const MetricRow& row : metrics) {
    insert.bind(1, ++num_metrics).bind(2, std::string_view(row.name)).bind(3, row.time);
    insert.bind(4, row.value).run();
    add_to_metric_hash(metric_hash, row.name, row.time, row.value);
  }
  metrics.clear();
}

void RecordingWriter::Impl::write_event() {
  const BlowUp& blow_up = *header.blow_up;
  database->prepare("INSERT INTO event VALUES (1, 'blow_up', ?, ?, ?, ?, ?)")
      .bind(1, blow_up.time)
      .bind(2, std::int64_t{blow_up.step})
      .bind(3, std::string_view(blow_up.body))
      .bind(4, std::int64_t{blow_up.node})
      .bind(5, std::string_view(blow_up.reason))
      .run();
  event_pending = false;
}

void RecordingWriter::Impl::update_meta() {
  Meta& meta = header.meta;
  meta["finished"] = finished ? "yes" : "no";
  meta["num_frames"] = std::to_string(num_frames);
  meta["num_metrics"] = std::to_string(num_metrics);
  meta["content_hash"] = content_hash.hex(header.blow_up);
  meta["index_hash"] = index_hash.hex();
  meta["metric_hash"] = metric_hash.hex();
  if (topologies.can_tear()) meta["topology_hash"] = topologies.hash();
  marks.update(meta);
  meta["meta_hash"] = header_hash(header);
  Statement upsert = database->prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)");
  for (const auto& [key, value] : meta) {
    upsert.bind(1, std::string_view(key)).bind(2, std::string_view(value)).run();
  }
}

void RecordingWriter::Impl::finish() {
  finished = true;
  commit();
  database->execute("PRAGMA wal_checkpoint(TRUNCATE)");
  // Needs a moment without readers. Without one the recording is complete all the same, in WAL
  // mode.
  for (int attempt = 0; attempt < kJournalAttempts; ++attempt) {
    try {
      if (database->query_text("PRAGMA journal_mode=DELETE") == "delete") {
        break;
      }
    } catch (const DatabaseError&) {
    }
    std::this_thread::sleep_for(kJournalPause);
  }
  database.reset();
}

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const Scene& scene,
                                 const Provenance& provenance, StoredPrecision precision,
                                 const ChunkLimits& limits) {
  if (limits.frames < 1) {
    throw InvalidArgument(
        fmt::format("recording: chunk frames = {}, expected >= 1", limits.frames));
  }
  Header header = make_header(scene, provenance, precision);
  reserve(path);
  try {
    impl_ = std::make_unique<Impl>(path, std::move(header), scene.files, precision, limits,
                                   format_version(scene) == kTornFormatVersion);
  } catch (...) {
    remove_files(path);
    throw;
  }
}

RecordingWriter::~RecordingWriter() {
  try {
    if (!impl_->finished && !impl_->broken) {
      impl_->commit();
    }
  } catch (...) {  // NOLINT(bugprone-empty-catch): what was committed before is safe, and nobody
                   // can be told
  }
}

void RecordingWriter::add_frame(const SceneState& state, std::span<const Mark> marks) {
  impl_->require_usable();
  const double time = without_negative_zero(state.time);
  if (!std::isfinite(time) || time <= impl_->last_time) {
    throw InvalidArgument(fmt::format("add_frame: time = {} [s], expected more than {} and finite",
                                      time, impl_->last_time));
  }
  for (const Mark& mark : marks) check_mark(mark);
  FrameCodec codec = impl_->codec;
  impl_->topologies.prepare(state, codec);
  codec.check(state);
  impl_->codec = std::move(codec);
  const std::int64_t frame = impl_->num_frames + std::ssize(impl_->times);
  impl_->topologies.take(state, frame, impl_->content_hash);
  impl_->marks.add(frame, marks);
  const std::size_t begin = impl_->raw.size();
  impl_->codec.encode(state, impl_->raw);
  impl_->times.push_back(time);
  impl_->last_time = time;
  impl_->content_hash.add_frame(time, std::span(impl_->raw).subspan(begin));
  if (impl_->raw.size() >= impl_->limits.bytes ||
      impl_->times.size() >= static_cast<std::size_t>(impl_->limits.frames)) {
    impl_->commit();
  }
}

void RecordingWriter::add_metric(const std::string& name, double time, double value) {
  impl_->require_usable();
  if (name.empty() || !std::isfinite(time)) {
    throw InvalidArgument(fmt::format(
        "add_metric: name = '{}', time = {} [s], expected a name and finite", name, time));
  }
  impl_->metrics.push_back({name, without_negative_zero(time), without_negative_zero(value)});
  if (impl_->metrics.size() >= kMaxPendingMetrics) {
    impl_->commit();
  }
}

void RecordingWriter::add_note(const Note& note) {
  impl_->require_usable();
  if (note.text.empty() || !std::isfinite(note.time)) {
    throw InvalidArgument(fmt::format(
        "add_note: text = '{}', time = {} [s], expected a text and finite", note.text, note.time));
  }
  impl_->marks.add({without_negative_zero(note.time), note.text});
}

void RecordingWriter::set_blow_up(const BlowUp& blow_up) {
  impl_->require_usable();
  if (impl_->header.blow_up) {
    throw InvalidArgument("set_blow_up: already set, expected once");
  }
  if (!std::isfinite(blow_up.time)) {
    throw InvalidArgument(fmt::format("set_blow_up: time = {} [s], expected finite", blow_up.time));
  }
  impl_->header.blow_up = blow_up;
  impl_->header.blow_up->time = without_negative_zero(blow_up.time);
  impl_->event_pending = true;
  impl_->commit();
}

void RecordingWriter::commit() {
  impl_->require_usable();
  impl_->commit();
}

RecordingWriter::Committed RecordingWriter::committed() const {
  return impl_->committed;
}

std::string RecordingWriter::finish() {
  if (!impl_->finished) {
    impl_->require_usable();
    impl_->finish();
  }
  return impl_->header.meta.at("content_hash");
}

}  // namespace weft::scenes
