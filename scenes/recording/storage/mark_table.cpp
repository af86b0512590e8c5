#include <weft/scenes/recording/storage/mark_table.hpp>

#include <algorithm>
#include <bit>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/codec/chunk_codec.hpp>
#include <weft/scenes/recording/codec/little_endian.hpp>

namespace weft::scenes {

const std::string_view kMarkSchema = R"sql(
CREATE TABLE mark (
  id        INTEGER PRIMARY KEY,  -- from 0
  frame     INTEGER NOT NULL,     -- frame.id, never falls
  name      TEXT NOT NULL,        -- of all marks that mean the same
  kind      TEXT NOT NULL,        -- 'points', 'lines' or 'arrows'
  color     INTEGER NOT NULL,     -- 65536 red + 256 green + blue, sRGB
  raw_bytes INTEGER NOT NULL,     -- size of the decoded data
  hash      TEXT NOT NULL,        -- XXH3-128 of column data
  data      BLOB NOT NULL
))sql";

namespace {

constexpr const char* kMarkHashKey = "mark_hash";
constexpr const char* kNoteHashKey = "note_hash";
constexpr std::size_t kMarkScalarBytes = sizeof(float);
/// A blow-up is the event 1.
constexpr std::int64_t kFirstNoteId = 2;

[[noreturn]] void refuse_marks(const std::string& file, std::string_view what) {
  throw Error(fmt::format("{}: {}: the file is damaged", file, what));
}

std::string hash_of_mark(std::span<const std::byte> data) {
  StreamHash hash;
  hash.add(data);
  return hash.hex();
}

std::vector<std::byte> encode_mark(const Mark& mark) {
  std::vector<std::byte> raw(kMarkScalarBytes *
                             static_cast<std::size_t>(mark.from.size() + mark.to.size()));
  std::byte* to = raw.data();
  for (const Matrix3X<float>* ends : {&mark.from, &mark.to}) {
    for (const float value : ends->reshaped()) {
      store_little_endian(std::bit_cast<std::uint32_t>(value), to);
      to += kMarkScalarBytes;
    }
  }
  return raw;
}

Matrix3X<float> decode_ends(const std::byte* from, Eigen::Index count) {
  Matrix3X<float> ends(3, count);
  for (float& value : ends.reshaped()) {
    value = std::bit_cast<float>(load_little_endian<std::uint32_t>(from));
    from += kMarkScalarBytes;
  }
  return ends;
}

void add_to_mark_hash(StreamHash& hash, const MarkEntry& entry) {
  hash.add(entry.frame);
  hash.add(std::string_view(entry.name));
  hash.add(std::string_view(entry.kind));
  hash.add(entry.color);
  hash.add(entry.raw_bytes);
  hash.add(std::string_view(entry.hash));
}

void add_to_mark_hash(StreamHash& hash, const Note& note) {
  hash.add(note.time);
  hash.add(std::string_view(note.text));
}

bool has_mark_table(const Database& database) {
  return database.prepare("SELECT 1 FROM sqlite_master WHERE name = 'mark' AND type = 'table'")
      .step();
}

void insert_mark(Database& database, const MarkEntry& entry, std::span<const std::byte> data) {
  if (entry.id == 0) database.execute(std::string(kMarkSchema));
  database.prepare("INSERT INTO mark VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(1, entry.id)
      .bind(2, entry.frame)
      .bind(3, std::string_view(entry.name))
      .bind(4, std::string_view(entry.kind))
      .bind(5, entry.color)
      .bind(6, entry.raw_bytes)
      .bind(7, std::string_view(entry.hash))
      .bind(8, data)
      .run();
}

std::vector<std::byte> stored_mark(const Database& database, const MarkEntry& entry) {
  Statement row = database.prepare("SELECT data FROM mark WHERE id = ?");
  row.bind(1, entry.id);
  return row.step() ? row.blob(0) : std::vector<std::byte>();
}

}  // namespace

void MarkWriter::add(std::int64_t frame, std::span<const Mark> marks) {
  for (const Mark& mark : marks) {
    check_mark(mark);
    const std::vector<std::byte> raw = encode_mark(mark);
    Row row;
    row.data = compress_chunk(raw, kMarkScalarBytes);
    row.entry = {
        num_marks_++,
        frame,
        mark.name,
        std::string(mark_word(mark.kind)),
        std::int64_t{mark.color[0]} << 16 | std::int64_t{mark.color[1]} << 8 | mark.color[2],
        static_cast<std::int64_t>(raw.size()),
        hash_of_mark(row.data)};
    add_to_mark_hash(mark_hash_, row.entry);
    marks_.push_back(std::move(row));
  }
}

void MarkWriter::add(const Note& note) {
  add_to_mark_hash(note_hash_, note);
  notes_.push_back(note);
  ++num_notes_;
}

void MarkWriter::write(Database& database) {
  for (const Row& row : marks_) insert_mark(database, row.entry, row.data);
  std::int64_t id = kFirstNoteId + num_notes_ - std::ssize(notes_);
  for (const Note& note : notes_) {
    database.prepare("INSERT INTO event VALUES (?, 'note', ?, 0, '', 0, ?)")
        .bind(1, id++)
        .bind(2, note.time)
        .bind(3, std::string_view(note.text))
        .run();
  }
  marks_.clear();
  notes_.clear();
}

void MarkWriter::update(Meta& meta) const {
  if (num_marks_ > 0) meta[kMarkHashKey] = mark_hash_.hex();
  if (num_notes_ > 0) meta[kNoteHashKey] = note_hash_.hex();
}

std::vector<MarkEntry> read_mark_entries(const Database& database, const Header& header,
                                         const std::string& file) {
  std::vector<MarkEntry> entries;
  const auto expected = header.meta.find(kMarkHashKey);
  if (expected == header.meta.end()) return entries;
  if (!has_mark_table(database)) refuse_marks(file, "has no table 'mark'");
  StreamHash hash;
  Statement rows = database.prepare(
      "SELECT id, frame, name, kind, color, raw_bytes, hash FROM mark ORDER BY id");
  // A recording that grows may have more rows by now than when its header was read.
  while (entries.empty() || hash.hex() != expected->second) {
    if (!rows.step()) refuse_marks(file, "table mark does not have its hash");
    entries.push_back({rows.integer(0), rows.integer(1), rows.text(2), rows.text(3),
                       rows.integer(4), rows.integer(5), rows.text(6)});
    const MarkEntry& entry = entries.back();
    if (entry.frame < 0 ||
        (entries.size() > 1 && entry.frame < entries[entries.size() - 2].frame)) {
      refuse_marks(file, fmt::format("the frame of mark {} is not consistent", entry.id));
    }
    add_to_mark_hash(hash, entry);
  }
  return entries;
}

Mark read_mark(const Database& database, const MarkEntry& entry, const std::string& file) {
  Mark mark;
  mark.name = entry.name;
  constexpr MarkKind kKinds[] = {MarkKind::kPoints, MarkKind::kLines, MarkKind::kArrows};
  const auto* const kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                        [&](MarkKind one) { return mark_word(one) == entry.kind; });
  const std::int64_t parts = kind == std::begin(kKinds) ? 1 : 2;
  const std::int64_t element_bytes = parts * 3 * static_cast<std::int64_t>(kMarkScalarBytes);
  const bool has_size = entry.raw_bytes >= 0 && entry.raw_bytes <= kMaxFrameBytes &&
                        entry.raw_bytes % element_bytes == 0;
  if (kind == std::end(kKinds) || !has_size) {
    refuse_marks(file, fmt::format("mark {} is not consistent", entry.id));
  }
  const std::vector<std::byte> data = stored_mark(database, entry);
  if (hash_of_mark(data) != entry.hash) {
    refuse_marks(file, fmt::format("mark {} does not have its hash", entry.id));
  }
  const std::vector<std::byte> raw =
      decompress_chunk(data, static_cast<std::size_t>(entry.raw_bytes), kMarkScalarBytes);
  const Eigen::Index count = entry.raw_bytes / element_bytes;
  mark.kind = *kind;
  mark.color = {static_cast<std::uint8_t>(entry.color >> 16),
                static_cast<std::uint8_t>(entry.color >> 8),
                static_cast<std::uint8_t>(entry.color)};
  mark.from = decode_ends(raw.data(), count);
  mark.to = Matrix3X<float>(3, 0);
  if (parts == 2) mark.to = decode_ends(raw.data() + raw.size() / 2, count);
  return mark;
}

std::vector<Note> read_notes(const Database& database, const Header& header,
                             const std::string& file) {
  std::vector<Note> notes;
  const auto expected = header.meta.find(kNoteHashKey);
  if (expected == header.meta.end()) return notes;
  StreamHash hash;
  Statement rows =
      database.prepare("SELECT time_s, reason FROM event WHERE kind = 'note' ORDER BY id");
  while (notes.empty() || hash.hex() != expected->second) {
    if (!rows.step()) refuse_marks(file, "the notes in table event do not have their hash");
    notes.push_back({rows.real(0), rows.text(1)});
    add_to_mark_hash(hash, notes.back());
  }
  return notes;
}

}  // namespace weft::scenes
