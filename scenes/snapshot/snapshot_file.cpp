#include <weft/scenes/snapshot/snapshot_file.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/core/input_file.hpp>
#include <weft/core/state_archive.hpp>
#include <weft/scenes/recording/codec/stream_hash.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kName = "weft-snapshot/";
constexpr std::string_view kFirstLine = "weft-snapshot/1\n";
constexpr std::size_t kHashSize = 32;

void serialize(StateArchive& archive, Snapshot& snapshot) {
  archive.part("snapshot");
  archive.value(snapshot.engine);
  archive.value(snapshot.precision);
  archive.value(snapshot.step);
  archive.value(snapshot.time);
  std::string scene = snapshot.scene ? *snapshot.scene : std::string();
  archive.value(scene);
  if (archive.is_reading()) snapshot.scene = std::make_shared<const std::string>(std::move(scene));
  archive.value(snapshot.state);
}

std::string hash_of(std::span<const std::byte> bytes) {
  StreamHash hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace

bool begins_as_snapshot(std::string_view beginning) {
  return beginning.starts_with(kName);
}

std::string snapshot_bytes(const Snapshot& snapshot) {
  Snapshot copy = snapshot;
  StateArchive archive = StateArchive::writer();
  serialize(archive, copy);
  const std::vector<std::byte> bytes = archive.take();
  std::string file(kFirstLine);
  file += hash_of(bytes) + "\n";
  file.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return file;
}

Snapshot read_snapshot_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::string file;
  try {
    file = read_input_file(path);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(name + ": " + error.what());
  }
  if (!file.starts_with(kName)) {
    throw InvalidArgument(name + ": is no snapshot, expected a file of weft run --snapshot");
  }
  if (!file.starts_with(kFirstLine)) {
    throw InvalidArgument(name + ": is a snapshot of version '" +
                          file.substr(kName.size(), file.find('\n') - kName.size()).substr(0, 20) +
                          "', expected '1'");
  }
  const std::size_t begin = kFirstLine.size() + kHashSize + 1;
  const std::span<const std::byte> bytes =
      std::as_bytes(std::span(file)).subspan(std::min(begin, file.size()));
  if (file.size() < begin || file.substr(kFirstLine.size(), kHashSize) != hash_of(bytes)) {
    throw InvalidArgument(
        name + ": the content does not have its hash, expected a snapshot that is whole");
  }
  Snapshot snapshot;
  try {
    StateArchive archive = StateArchive::reader(bytes);
    serialize(archive, snapshot);
    archive.end();
  } catch (const Error& error) {
    throw InvalidArgument(name + ": " + error.what());
  }
  return snapshot;
}

}  // namespace weft::scenes
