#include <weft/scenes/recording/storage/asset_table.hpp>

#include <cstdint>
#include <span>
#include <string_view>

#include <fmt/core.h>

#include <weft/core/input_file.hpp>

namespace weft::scenes {

const std::string_view kAssetSchema = R"sql(
CREATE TABLE asset (
  id   INTEGER PRIMARY KEY,  -- from 0
  name TEXT NOT NULL,        -- as the scene spells it
  data BLOB NOT NULL         -- the whole file
))sql";

std::string asset_hash(const std::vector<SceneFile>& files) {
  StreamHash hash;
  for (const SceneFile& file : files) {
    hash.add(std::string_view(file.name));
    hash.add(std::string_view(file.bytes));
  }
  return hash.hex();
}

void write_assets(Database& database, const std::vector<SceneFile>& files) {
  database.execute(std::string(kAssetSchema));
  Statement insert = database.prepare("INSERT INTO asset VALUES (?, ?, ?)");
  std::int64_t id = 0;
  for (const SceneFile& file : files) {
    insert.bind(1, id++).bind(2, std::string_view(file.name));
    insert.bind(3, std::as_bytes(std::span(file.bytes))).run();
  }
}

std::vector<SceneFile> read_assets(const Database& database, const Header& header,
                                   const std::string& file) {
  std::vector<SceneFile> files;
  const auto expected = header.meta.find(kAssetHashKey);
  if (expected == header.meta.end()) return files;
  Statement tables =
      database.prepare("SELECT 1 FROM sqlite_master WHERE name = 'asset' AND type = 'table'");
  if (!tables.step()) throw Error(file + ": has no table 'asset': the file is damaged");
  Statement rows = database.prepare("SELECT name, data FROM asset ORDER BY id");
  std::uintmax_t size = 0;
  while (rows.step()) {
    const std::vector<std::byte> data = rows.blob(1);
    size += data.size();
    if (size > kMaxInputSize) {
      throw Error(fmt::format("{}: table asset has over {} bytes, as no scene's files have", file,
                              kMaxInputSize));
    }
    SceneFile& entry = files.emplace_back();
    entry.name = rows.text(0);
    entry.bytes.assign(reinterpret_cast<const char*>(data.data()), data.size());
  }
  if (asset_hash(files) != expected->second) {
    throw Error(file + ": table asset does not have its hash: the file is damaged");
  }
  return files;
}

}  // namespace weft::scenes
