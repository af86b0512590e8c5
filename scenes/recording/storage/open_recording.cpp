#include <weft/scenes/recording/storage/open_recording.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/core.h>
#include <sqlite3.h>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>
#include <weft/scenes/recording/storage/asset_table.hpp>
#include <weft/scenes/recording/storage/mark_table.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::size_t kSqliteHeaderBytes = 100;

std::uint32_t big_endian(const char* from, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8 | static_cast<unsigned char>(from[i]);
  }
  return value;
}

std::uintmax_t size_or_zero(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

std::filesystem::path log_path(const std::filesystem::path& path) {
  return path.string() + "-wal";
}

/// Bytes that the file must have according to its own header (SQLite file format, section 1.3), 0
/// if unknown.
std::uintmax_t promised_size(const std::string& header) {
  const std::uint32_t page = big_endian(&header[16], 2);
  const bool size_is_valid = std::memcmp(&header[24], &header[92], 4) == 0;
  return size_is_valid ? std::uintmax_t{page == 1 ? 65536 : page} * big_endian(&header[28], 4) : 0;
}

/// Clear words for what SQLite would answer with "disk image is malformed", or not at all. Gives the
/// file's header.
std::string check_file(const std::filesystem::path& path, const std::string& file) {
  std::string header;
  try {
    header = read_input_start(path, kSqliteHeaderBytes);
  } catch (const InvalidArgument& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
  if (header.empty()) throw Error(fmt::format("{}: is empty, not a Weft recording", file));
  if (std::string_view(header).substr(0, kSqliteMagic.size()) != kSqliteMagic) {
    throw Error(fmt::format("{}: not a Weft recording", file));
  }
  // In this order: with a log the file may be behind its header; without, header and size agree.
  const bool has_log = size_or_zero(log_path(path)) > 0;
  const std::uintmax_t size = size_or_zero(path);
  const std::uintmax_t promised =
      header.size() < kSqliteHeaderBytes ? kSqliteHeaderBytes : promised_size(header);
  if (header.size() < kSqliteHeaderBytes || (!has_log && size < promised)) {
    throw Error(fmt::format("{}: truncated, {} of {} bytes", file, size,
                            std::max<std::uintmax_t>(promised, kSqliteHeaderBytes)));
  }
  return header;
}

/// Whether the file can be had at all is known only after the first access.
Database open_and_touch(const std::filesystem::path& path, Database::Access access) {
  Database database(path, access);
  (void)database.query_integer("PRAGMA application_id");
  (void)database.query_integer("SELECT count(*) FROM sqlite_master");
  return database;
}

/// Whether nobody can be writing: the file keeps no log, and none is beside it. A finished recording
/// is one in itself, whatever else lies there.
bool is_settled(const std::filesystem::path& path, const std::string& header) {
  const bool keeps_log = header[18] != 1 || header[19] != 1;  // write and read version: 2 for a log
  return !keeps_log && size_or_zero(log_path(path)) == 0 &&
         size_or_zero(path.string() + "-journal") == 0;
}

Database open_database(const std::filesystem::path& path, const std::string& header) {
  if (is_settled(path, header)) return open_and_touch(path, Database::Access::kReadOnlyImmutable);
  try {
    return open_and_touch(path, Database::Access::kReadOnly);
  } catch (const DatabaseError& error) {
    if (error.code() != SQLITE_CANTOPEN && error.code() != SQLITE_READONLY) {
      throw;
    }
  }
  // A folder without write access: SQLite cannot make the index beside a log. Nobody writes here,
  // so none is needed.
  const bool has_log = size_or_zero(log_path(path)) > 0;
  return open_and_touch(
      path, has_log ? Database::Access::kReadOnlyUnlocked : Database::Access::kReadOnlyImmutable);
}

[[noreturn]] void damaged(const std::string& file, std::string_view what) {
  throw Error(fmt::format("{}: {}: the file is damaged", file, what));
}

std::vector<RecordedBody> read_bodies(const Database& database, const std::string& file) {
  std::vector<RecordedBody> bodies;
  Statement rows = database.prepare("SELECT id, name, kind, nodes FROM body ORDER BY id");
  while (rows.step()) {
    const std::string kind = rows.text(2);
    const std::int64_t nodes = rows.integer(3);
    const bool is_known = kind == "cloth" || kind == "rigid";
    if (rows.integer(0) != static_cast<std::int64_t>(bodies.size()) || !is_known || nodes < 1 ||
        nodes > std::numeric_limits<int>::max()) {
      damaged(file, "table body is not consistent");
    }
    bodies.push_back({rows.text(1), kind == "cloth", static_cast<int>(nodes)});
  }
  return bodies;
}

std::optional<BlowUp> read_blow_up(const Database& database, const std::string& file) {
  const auto small = [&](std::int64_t value) {
    if (value < 0 || value > std::numeric_limits<int>::max()) {
      damaged(file, "table event is not consistent");
    }
    return static_cast<int>(value);
  };
  Statement rows = database.prepare(
      "SELECT step, time_s, body, node, reason FROM event WHERE kind = 'blow_up' ORDER BY id");
  if (!rows.step()) {
    return std::nullopt;
  }
  return BlowUp{small(rows.integer(0)), rows.real(1), rows.text(2), small(rows.integer(3)),
                rows.text(4)};
}

}  // namespace

Database open_recording(const std::filesystem::path& path) {
  const std::string file = path.string();
  Database database = open_database(path, check_file(path, file));
  if (database.query_integer("PRAGMA application_id") != kApplicationId) {
    throw Error(fmt::format("{}: not a Weft recording but another application's database", file));
  }
  const std::int64_t version = database.query_integer("PRAGMA user_version");
  if (version < kFormatVersion || version > kTornFormatVersion) {
    throw Error(
        fmt::format("{}: recording format version {}, this program reads version {} to {}{}", file,
                    version, kFormatVersion, kTornFormatVersion,
                    version > kTornFormatVersion ? "; a newer Weft is needed" : ""));
  }
  std::string tables(kTableSchema);
  if (version == kTornFormatVersion) tables += kTopologySchema;
  database.require_schema(tables, std::string(kAssetSchema) + ";" + std::string(kMarkSchema));
  return database;
}

const std::string& meta_value(const Header& header, const std::string& key,
                              const std::string& file) {
  const auto found = header.meta.find(key);
  if (found == header.meta.end()) damaged(file, fmt::format("has no '{}' in table meta", key));
  return found->second;
}

Header read_header(const Database& database, const std::string& file) {
  Header header;
  Statement rows = database.prepare("SELECT key, value FROM meta ORDER BY key");
  while (rows.step()) {
    header.meta[rows.text(0)] = rows.text(1);
  }
  header.scene_text = database.query_text("SELECT text FROM scene");
  header.bodies = read_bodies(database, file);
  header.blow_up = read_blow_up(database, file);
  const auto stored = header.meta.find("meta_hash");
  if (stored == header.meta.end() || stored->second != header_hash(header)) {
    damaged(file, "tables meta, scene, body and event do not have their hash");
  }
  return header;
}

RecordingIndex read_index(const Database& database, const Header& header, const Topologies& layout,
                          const std::string& file) {
  RecordingIndex index;
  StreamHash hash;
  double last_time = -std::numeric_limits<double>::infinity();
  Statement chunks = database.prepare(
      "SELECT id, first_frame, num_frames, codec, raw_bytes, hash FROM chunk ORDER BY id");
  Statement times = database.prepare("SELECT id, time_s, chunk FROM frame ORDER BY id");
  while (chunks.step()) {
    ChunkEntry chunk{chunks.integer(0), chunks.integer(1), chunks.integer(4),
                     chunks.text(3),    chunks.text(5),    {}};
    const std::int64_t num_frames = chunks.integer(2);
    std::size_t raw_bytes = 0;
    if (chunk.raw_bytes > kMaxChunkBytes) {
      damaged(file, fmt::format("chunk {} has {} bytes, expected at most {}", chunk.id,
                                chunk.raw_bytes, kMaxChunkBytes));
    }
    for (std::int64_t i = 0; i < num_frames; ++i) {
      if (!times.step() || times.integer(0) != static_cast<std::int64_t>(index.times.size()) ||
          times.integer(2) != chunk.id) {
        damaged(file, fmt::format("frames of chunk {} are not consistent", chunk.id));
      }
      index.offsets.push_back(raw_bytes);
      raw_bytes += layout.codec_at(static_cast<std::int64_t>(index.times.size())).frame_bytes();
      chunk.times.push_back(times.real(1));
      if (!(chunk.times.back() > last_time)) {
        damaged(file, fmt::format("the times of chunk {} do not grow", chunk.id));
      }
      last_time = chunk.times.back();
      index.times.push_back(last_time);
      index.chunk_of.push_back(index.chunks.size());
    }
    const auto first = static_cast<std::int64_t>(index.times.size() - chunk.times.size());
    if (chunk.first_frame != first || static_cast<std::size_t>(chunk.raw_bytes) != raw_bytes) {
      damaged(file, fmt::format("chunk {} is not consistent", chunk.id));
    }
    add_to_index_hash(hash, chunk);
    index.chunks.push_back(std::move(chunk));
  }
  if (times.step() || hash.hex() != meta_value(header, "index_hash", file)) {
    damaged(file, "tables chunk and frame do not have their hash");
  }
  return index;
}

}  // namespace weft::scenes
