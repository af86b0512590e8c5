#include <weft/scenes/recording/playback_copy.hpp>

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/format/scene_file.hpp>
#include <weft/scenes/recording/codec/chunk_codec.hpp>
#include <weft/scenes/recording/codec/position_codec.hpp>
#include <weft/scenes/recording/codec/topology_codec.hpp>
#include <weft/scenes/recording/storage/asset_table.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>
#include <weft/scenes/recording/storage/mark_table.hpp>

namespace weft::scenes {
namespace {

/// Not that of a recording: a copy is never taken for one.
constexpr std::int64_t kCopyApplicationId = 0x57454650;  // "WEFP" in ASCII

/// A chunk is decoded whole before its first frame is shown: these take some 20 ms.
constexpr std::size_t kMaxChunkFrames = 60;
constexpr std::size_t kMaxChunkValues = 600'000;

/// Relative to the largest cloth: 31 bits of smaller steps would not reach around it, and larger ones leave it no shape.
constexpr double kSmallestError = 1e-8;
constexpr double kLargestError = 0.1;

void check(double position_error, const Scene& scene) {
  double size = 0.0;
  for (const Cloth& cloth : scene.cloths) size = std::max(size, body_size(cloth.source));
  const double smallest = kSmallestError * size;
  const double largest = kLargestError * size;
  if (position_error >= smallest && position_error <= largest) return;
  throw InvalidArgument(fmt::format(
      "playback copy: position error = {} [m], expected {:.3g} to {:.3g} for a cloth of {:.3g} m",
      position_error, smallest, largest, size));
}

class CopyWriter {
 public:
  CopyWriter(const RecordingReader& reader, const PlaybackCopyOptions& options)
      : reader_(reader),
        scene_(reader.scene()),
        step_(2.0 * options.position_error),
        database_(Database::in_memory("playback copy")) {
    database_.execute(fmt::format("PRAGMA application_id={}; PRAGMA user_version={}; BEGIN",
                                  kCopyApplicationId, kTornFormatVersion));
    database_.execute(std::string(kTableSchema) + std::string(kTopologySchema));
    database_.prepare("INSERT INTO scene VALUES (?)")
        .bind(1, std::string_view(reader.scene_text()))
        .run();
    if (!scene_.files.empty()) write_assets(database_, scene_.files);
    write_bodies(recorded_bodies(scene_));
  }

  void add(int frame) {
    const SceneState state = reader_.frame(frame);
    write_topologies(state, frame);
    marks_.add(frame, reader_.marks(frame));
    RoundedFrame rounded;
    std::vector<int> nodes;
    for (const ClothState& cloth : state.cloths) {
      nodes.push_back(static_cast<int>(cloth.positions.cols()));
      for (int axis = 0; axis < 3; ++axis) {
        for (const double x : cloth.positions.row(axis)) {
          rounded.steps.push_back(rounded_steps(x, step_));
        }
      }
    }
    for (const RigidState& rigid : state.rigids) {
      for (const double x : rigid.position) rounded.poses.push_back(static_cast<float>(x));
      for (const double x : rigid.orientation.coeffs()) {
        rounded.poses.push_back(static_cast<float>(x));
      }
    }
    if (nodes != nodes_) flush();
    nodes_ = nodes;
    const std::size_t values = rounded.steps.size();
    frames_.push_back(std::move(rounded));
    times_.push_back(reader_.frame_time(frame));
    if (frames_.size() >= kMaxChunkFrames || frames_.size() * values >= kMaxChunkValues) flush();
  }

  std::string finish(const PlaybackCopyOptions& options) {
    flush();
    for (const std::string& name : reader_.metric_names()) write_metric(name, reader_.metric(name));
    for (const PlaybackMetric& metric : options.metrics) write_metric(metric.name, metric.samples);
    for (const Note& note : reader_.notes()) marks_.add(note);
    marks_.write(database_);
    write_event();
    write_meta(options.position_error);
    database_.execute("COMMIT");
    return database_.serialized();
  }

 private:
  void write_bodies(const std::vector<RecordedBody>& bodies) {
    std::int64_t id = 0;
    Statement insert = database_.prepare("INSERT INTO body VALUES (?, ?, ?, ?)");
    for (const RecordedBody& body : bodies) {
      insert.bind(1, id++)
          .bind(2, std::string_view(body.name))
          .bind(3, std::string_view(body.is_cloth ? "cloth" : "rigid"))
          .bind(4, std::int64_t{body.num_nodes})
          .run();
    }
  }

  void write_topologies(const SceneState& state, int frame) {
    last_.resize(state.cloths.size());
    for (std::size_t c = 0; c < state.cloths.size(); ++c) {
      const ClothState& cloth = state.cloths[c];
      if (cloth.topology == last_[c]) continue;
      last_[c] = cloth.topology;
      const std::vector<std::byte> bytes = encode_topology(*cloth.topology);
      const std::vector<std::byte> data = compress_chunk(bytes, sizeof(std::int32_t));
      database_.prepare("INSERT INTO topology VALUES (?, ?, ?, ?, ?, ?, ?)")
          .bind(1, num_topologies_++)
          .bind(2, std::int64_t{frame})
          .bind(3, static_cast<std::int64_t>(c))
          .bind(4, static_cast<std::int64_t>(cloth.positions.cols()))
          .bind(5, static_cast<std::int64_t>(bytes.size()))
          .bind(6, std::string_view(hash_of(data)))
          .bind(7, std::span<const std::byte>(data))
          .run();
    }
  }

  void flush() {
    if (frames_.empty()) return;
    const CompressedFrames chunk = compress_positions(frames_, nodes_);
    database_.prepare("INSERT INTO chunk VALUES (?, ?, ?, ?, ?, ?, ?)")
        .bind(1, num_chunks_)
        .bind(2, num_frames_)
        .bind(3, static_cast<std::int64_t>(frames_.size()))
        .bind(4, kPositionCodecName)
        .bind(5, static_cast<std::int64_t>(chunk.raw_bytes))
        .bind(6, std::string_view(hash_of(chunk.data)))
        .bind(7, std::span<const std::byte>(chunk.data))
        .run();
    Statement insert = database_.prepare("INSERT INTO frame VALUES (?, ?, ?)");
    for (const double time : times_) {
      insert.bind(1, num_frames_++).bind(2, time).bind(3, num_chunks_).run();
    }
    ++num_chunks_;
    frames_.clear();
    times_.clear();
  }

  void write_metric(const std::string& name, const std::vector<RecordingReader::Sample>& samples) {
    Statement insert = database_.prepare("INSERT INTO metric VALUES (?, ?, ?, ?)");
    for (const RecordingReader::Sample& sample : samples) {
      insert.bind(1, ++num_metrics_).bind(2, std::string_view(name)).bind(3, sample.time);
      insert.bind(4, sample.value).run();
    }
  }

  void write_event() {
    const std::optional<BlowUp> blow_up = reader_.blow_up();
    if (!blow_up) return;
    database_.prepare("INSERT INTO event VALUES (1, 'blow_up', ?, ?, ?, ?, ?)")
        .bind(1, blow_up->time)
        .bind(2, std::int64_t{blow_up->step})
        .bind(3, std::string_view(blow_up->body))
        .bind(4, std::int64_t{blow_up->node})
        .bind(5, std::string_view(blow_up->reason))
        .run();
  }

  void write_meta(double position_error) {
    Meta meta;
    meta["precision"] = reader_.precision() == StoredPrecision::kFloat64 ? "float64" : "float32";
    meta["byte_order"] = "little";
    meta["finished"] = reader_.finished() ? "yes" : "no";
    meta["num_frames"] = std::to_string(num_frames_);
    meta["num_metrics"] = std::to_string(num_metrics_);
    meta["content_hash"] = reader_.content_hash();
    marks_.update(meta);
    meta["position_error_m"] = fmt::format("{}", position_error);
    for (const auto& [key, value] : reader_.provenance()) {
      meta[std::string(kProvenancePrefix) + key] = value;
    }
    Statement insert = database_.prepare("INSERT INTO meta VALUES (?, ?)");
    for (const auto& [key, value] : meta) {
      insert.bind(1, std::string_view(key)).bind(2, std::string_view(value)).run();
    }
  }

  static std::string hash_of(const std::vector<std::byte>& data) {
    StreamHash hash;
    hash.add(data);
    return hash.hex();
  }

  const RecordingReader& reader_;
  const Scene& scene_;
  double step_;  ///< [m]
  Database database_;
  std::vector<RoundedFrame> frames_;  ///< that are not yet written, all with nodes_
  std::vector<int> nodes_;
  std::vector<double> times_;  ///< [s]
  std::vector<std::shared_ptr<const ClothTopology>> last_;
  MarkWriter marks_;
  std::int64_t num_topologies_ = 0;
  std::int64_t num_chunks_ = 0;
  std::int64_t num_frames_ = 0;
  std::int64_t num_metrics_ = 0;
};

}  // namespace

std::string playback_copy(const RecordingReader& reader, const PlaybackCopyOptions& options) {
  check(options.position_error, reader.scene());
  CopyWriter writer(reader, options);
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    writer.add(frame);
    if (options.on_progress) options.on_progress((frame + 1.0) / reader.num_frames());
  }
  return writer.finish(options);
}

}  // namespace weft::scenes
