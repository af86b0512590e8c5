#include "fuzz/recording_seal.hpp"

#include <string>
#include <vector>

#include <weft/scenes/recording/storage/asset_table.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::fuzz {
namespace {

using namespace weft::scenes;

void set_meta(Database& database, const std::string& key, const std::string& value) {
  database.prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)")
      .bind(1, std::string_view(key))
      .bind(2, std::string_view(value))
      .run();
}

/// A step that fails leaves its hash as it is.
template <class Step>
void try_to(const Step& step) {
  try {
    step();
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): the reader says what is wrong
  }
}

void seal_data(Database& database, const std::string& table) {
  std::vector<std::pair<std::int64_t, std::string>> hashes;
  Statement rows = database.prepare("SELECT id, data FROM " + table);
  while (rows.step()) {
    StreamHash hash;
    hash.add(rows.blob(1));
    hashes.emplace_back(rows.integer(0), hash.hex());
  }
  for (const auto& [id, hash] : hashes) {
    database.prepare("UPDATE " + table + " SET hash = ? WHERE id = ?")
        .bind(1, std::string_view(hash))
        .bind(2, id)
        .run();
  }
}

void seal_index(Database& database) {
  StreamHash hash;
  Statement chunks =
      database.prepare("SELECT id, first_frame, codec, raw_bytes, hash FROM chunk ORDER BY id");
  while (chunks.step()) {
    ChunkEntry chunk{chunks.integer(0), chunks.integer(1), chunks.integer(3),
                     chunks.text(2),    chunks.text(4),    {}};
    Statement times = database.prepare("SELECT time_s FROM frame WHERE chunk = ? ORDER BY id");
    times.bind(1, chunk.id);
    while (times.step()) chunk.times.push_back(times.real(0));
    add_to_index_hash(hash, chunk);
  }
  set_meta(database, "index_hash", hash.hex());
}

void seal_metrics(Database& database) {
  StreamHash hash;
  Statement rows = database.prepare("SELECT name, time_s, value FROM metric ORDER BY id");
  while (rows.step()) add_to_metric_hash(hash, rows.text(0), rows.real(1), rows.real(2));
  set_meta(database, "metric_hash", hash.hex());
}

void seal_topologies(Database& database) {
  StreamHash hash;
  Statement rows = database.prepare(
      "SELECT id, first_frame, body, nodes, raw_bytes, hash FROM topology ORDER BY id");
  while (rows.step()) {
    for (int column = 0; column < 5; ++column) hash.add(rows.integer(column));
    hash.add(std::string_view(rows.text(5)));
  }
  set_meta(database, "topology_hash", hash.hex());
}

void seal_header(Database& database) {
  Header header;
  Statement meta = database.prepare("SELECT key, value FROM meta ORDER BY key");
  while (meta.step()) header.meta[meta.text(0)] = meta.text(1);
  header.scene_text = database.query_text("SELECT text FROM scene");
  Statement bodies = database.prepare("SELECT name, kind, nodes FROM body ORDER BY id");
  while (bodies.step()) {
    header.bodies.push_back(
        {bodies.text(0), bodies.text(1) == "cloth", static_cast<int>(bodies.integer(2))});
  }
  Statement events = database.prepare(
      "SELECT step, time_s, body, node, reason FROM event WHERE kind = 'blow_up' ORDER BY id");
  if (events.step()) {
    header.blow_up = BlowUp{static_cast<int>(events.integer(0)), events.real(1), events.text(2),
                            static_cast<int>(events.integer(3)), events.text(4)};
  }
  set_meta(database, "meta_hash", header_hash(header));
}

}  // namespace

void seal_recording(const std::filesystem::path& path) {
  try_to([&] {
    Database database(path, Database::Access::kReadWrite);
    try_to([&] { seal_data(database, "chunk"); });
    try_to([&] { seal_data(database, "topology"); });
    try_to([&] { seal_index(database); });
    try_to([&] { seal_metrics(database); });
    try_to([&] { seal_topologies(database); });
    try_to([&] { seal_header(database); });
  });
}

}  // namespace weft::fuzz
