#pragma once

// Tested by tests/scenes/recording/format_document_test.cpp, tests/scenes/recording/damage_test.cpp.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <weft/scenes/recording/codec/frame_codec.hpp>
#include <weft/scenes/recording/codec/stream_hash.hpp>

/// What writer and reader agree on; docs/recording_format.md is the same for people.
namespace weft::scenes {

inline constexpr std::int64_t kApplicationId = 0x57454654;  // "WEFT" in ASCII

/// SQLite's user_version. 2 is 1 with table topology and frames of different sizes: only scenes with
/// a cloth that can tear need it, so that older programs read all others.
inline constexpr std::int64_t kFormatVersion = 1;
inline constexpr std::int64_t kTornFormatVersion = 2;
[[nodiscard]] std::int64_t format_version(const Scene& scene);

/// Largest frame and largest chunk before compression [bytes]: far above what the largest scene
/// makes, and small enough that a forged number cannot ask for all memory.
inline constexpr std::int64_t kMaxFrameBytes = std::int64_t{128} << 20U;
inline constexpr std::int64_t kMaxChunkBytes = kMaxFrameBytes + (std::int64_t{2} << 20U);

/// Statements that make the tables. Their comments stay in the file: ".schema" explains it.
extern const std::string_view kTableSchema;
extern const std::string_view kTopologySchema;  ///< version 2 only
inline constexpr std::string_view kProvenancePrefix = "provenance.";

using Meta = std::map<std::string, std::string>;

/// A row of table chunk without the data, and the times of its frames.
struct ChunkEntry {
  std::int64_t id = 0;
  std::int64_t first_frame = 0;
  std::int64_t raw_bytes = 0;
  std::string codec;
  std::string hash;           ///< of the column data
  std::vector<double> times;  ///< [s]
};

/// Everything of a recording that is small: covered by one hash, read whole when it is opened.
struct Header {
  Meta meta;
  std::string scene_text;
  std::vector<RecordedBody> bodies;
  std::optional<BlowUp> blow_up;
};

/// Over everything in the header except meta.meta_hash itself.
[[nodiscard]] std::string header_hash(const Header& header);
/// Continues the running hash of tables chunk and frame.
void add_to_index_hash(StreamHash& hash, const ChunkEntry& chunk);
/// Continues the running hash of table metric.
void add_to_metric_hash(StreamHash& hash, std::string_view name, double time, double value);

/// The hash that names the content: scene, precision, frames and blow-up; not the chunks,
/// compression, provenance.
class ContentHash {
 public:
  ContentHash(std::string_view scene_text, StoredPrecision precision);
  void add_frame(double time, std::span<const std::byte> frame);
  /// Before the frame from which on a body consists of these.
  void add_topology(int body, std::span<const std::byte> topology);
  /// With what ends the content; more frames may follow.
  [[nodiscard]] std::string hex(const std::optional<BlowUp>& blow_up) const;

 private:
  StreamHash hash_;
  std::int64_t num_frames_ = 0;
};

}  // namespace weft::scenes
