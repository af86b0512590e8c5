#include <weft/scenes/recording/storage/format.hpp>

#include <cmath>
#include <limits>

namespace weft::scenes {
namespace {

void add_blow_up(StreamHash& hash, const std::optional<BlowUp>& blow_up) {
  hash.add(blow_up ? 1 : 0);
  if (blow_up) {
    hash.add(blow_up->step);
    hash.add(blow_up->time);
    hash.add(std::string_view(blow_up->body));
    hash.add(blow_up->node);
    hash.add(std::string_view(blow_up->reason));
  }
}

}  // namespace

const std::string_view kTableSchema = R"sql(
CREATE TABLE meta (
  key   TEXT PRIMARY KEY,      -- see docs/recording_format.md
  value TEXT NOT NULL
);
CREATE TABLE scene (
  text  TEXT NOT NULL          -- one row: the resolved scene, TOML
);
CREATE TABLE body (
  id    INTEGER PRIMARY KEY,   -- from 0, in the order of a frame
  name  TEXT NOT NULL,
  kind  TEXT NOT NULL,         -- 'cloth' or 'rigid'
  nodes INTEGER NOT NULL       -- 1 for rigid bodies
);
CREATE TABLE chunk (
  id          INTEGER PRIMARY KEY,  -- from 0
  first_frame INTEGER NOT NULL,
  num_frames  INTEGER NOT NULL,
  codec       TEXT NOT NULL,        -- 'shuffle+zstd'
  raw_bytes   INTEGER NOT NULL,     -- size of the decoded data
  hash        TEXT NOT NULL,        -- XXH3-128 of column data
  data        BLOB NOT NULL
);
CREATE TABLE frame (
  id     INTEGER PRIMARY KEY,  -- from 0
  time_s REAL NOT NULL,
  chunk  INTEGER NOT NULL      -- chunk.id
);
CREATE TABLE metric (
  id     INTEGER PRIMARY KEY,  -- from 1, in the order of writing
  name   TEXT NOT NULL,        -- ends with its unit: 'kinetic_energy_J'
  time_s REAL NOT NULL,
  value  REAL                  -- NULL: not a number
);
CREATE TABLE event (
  id     INTEGER PRIMARY KEY,  -- from 1
  kind   TEXT NOT NULL,        -- 'blow_up'
  time_s REAL NOT NULL,
  step   INTEGER NOT NULL,     -- counted from 1
  body   TEXT NOT NULL,
  node   INTEGER NOT NULL,     -- counted from 0
  reason TEXT NOT NULL
);
)sql";

const std::string_view kTopologySchema = R"sql(
CREATE TABLE topology (
  id          INTEGER PRIMARY KEY,  -- from 0
  first_frame INTEGER NOT NULL,     -- frame.id from which on it holds
  body        INTEGER NOT NULL,     -- body.id of a cloth
  nodes       INTEGER NOT NULL,     -- it has now
  raw_bytes   INTEGER NOT NULL,     -- size of the decoded data
  hash        TEXT NOT NULL,        -- XXH3-128 of column data
  data        BLOB NOT NULL
);
)sql";

std::int64_t format_version(const Scene& scene) {
  for (const Cloth& cloth : scene.cloths) {
    if (cloth.tear) return kTornFormatVersion;
  }
  return kFormatVersion;
}

std::string header_hash(const Header& header) {
  StreamHash hash;
  for (const auto& [key, value] : header.meta) {
    if (key != "meta_hash") {
      hash.add(std::string_view(key));
      hash.add(std::string_view(value));
    }
  }
  hash.add(std::string_view(header.scene_text));
  for (const RecordedBody& body : header.bodies) {
    hash.add(std::string_view(body.name));
    hash.add(body.is_cloth ? 1 : 0);
    hash.add(body.num_nodes);
  }
  add_blow_up(hash, header.blow_up);
  return hash.hex();
}

void add_to_index_hash(StreamHash& hash, const ChunkEntry& chunk) {
  hash.add(chunk.id);
  hash.add(chunk.first_frame);
  hash.add(chunk.times.size());
  hash.add(std::string_view(chunk.codec));
  hash.add(chunk.raw_bytes);
  hash.add(std::string_view(chunk.hash));
  for (const double time : chunk.times) {
    hash.add(time);
  }
}

void add_to_metric_hash(StreamHash& hash, std::string_view name, double time, double value) {
  hash.add(name);
  hash.add(time);
  // One NaN for all: the file keeps only that a value is not a number.
  hash.add(std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value);
}

ContentHash::ContentHash(std::string_view scene_text, StoredPrecision precision) {
  hash_.add(scene_text);
  hash_.add(precision == StoredPrecision::kFloat64 ? 64 : 32);
}

void ContentHash::add_frame(double time, std::span<const std::byte> frame) {
  hash_.add(time);
  hash_.add(frame);
  ++num_frames_;
}

void ContentHash::add_topology(int body, std::span<const std::byte> topology) {
  hash_.add(body);
  hash_.add(static_cast<std::int64_t>(topology.size()));
  hash_.add(topology);
}

std::string ContentHash::hex(const std::optional<BlowUp>& blow_up) const {
  StreamHash hash(hash_);
  hash.add(num_frames_);
  add_blow_up(hash, blow_up);
  return hash.hex();
}

}  // namespace weft::scenes
