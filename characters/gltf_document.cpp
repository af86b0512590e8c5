#include <weft/characters/gltf_document.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <weft/characters/base64.hpp>
#include <weft/core/error.hpp>

namespace weft::characters {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;

/// Larger files are no game characters; every buffer is held in memory.
constexpr std::size_t kMaxBytes = kMaxInputSize;

/// Numbers of all parts and clips: 256 MB of doubles, more than a million vertices need.
constexpr std::size_t kMaxValues = 32'000'000;

constexpr std::size_t kMaxShown = 80;     ///< of a text of the file, in a message
constexpr std::size_t kMaxMessage = 400;  ///< a message is one line

std::uint32_t number_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8U | std::to_integer<std::uint32_t>(bytes[offset + i]);
  }
  return value;
}

}  // namespace

GltfDocument::GltfDocument(std::span<const std::byte> bytes, std::string name,
                           const FileSource& files)
    : name_(std::move(name)) {
  if (bytes.size() > kMaxBytes) {
    fail("has " + std::to_string(bytes.size()) + " bytes, expected at most " +
         std::to_string(kMaxBytes));
  }
  const bool is_binary = bytes.size() >= 4 && number_at(bytes, 0) == kMagic;
  is_binary ? read_binary(bytes) : parse(bytes);
  check_version();
  read_buffers(files);
}

void GltfDocument::fail(const std::string& message) const {
  const bool is_long = message.size() > kMaxMessage;
  throw InvalidArgument(name_ + ": " +
                        (is_long ? message.substr(0, kMaxMessage) + "..." : message));
}

void GltfDocument::claim(std::size_t num_values, const std::string& where) const {
  if (num_values > kMaxValues - num_claimed_) {
    fail(where + " and what is before it have over " + std::to_string(kMaxValues) + " numbers");
  }
  num_claimed_ += num_values;
}

void GltfDocument::read_binary(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderSize + kChunkHeaderSize) fail("ends within its header");
  const std::uint32_t version = number_at(bytes, 4);
  if (version != 2) fail("glTF version " + std::to_string(version) + ", expected 2");
  const std::size_t length = number_at(bytes, 8);
  if (length > bytes.size()) {
    fail("has " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(length) +
         " as its header says");
  }
  bool has_json = false;
  for (std::size_t offset = kHeaderSize; offset + kChunkHeaderSize <= length;) {
    const std::size_t size = number_at(bytes, offset);
    const std::uint32_t kind = number_at(bytes, offset + 4);
    offset += kChunkHeaderSize;
    if (size > length - offset) fail("a chunk reaches beyond the end of the file");
    const std::span<const std::byte> chunk = bytes.subspan(offset, size);
    if (!has_json) {
      if (kind != kJsonChunk) fail("its first chunk is no JSON, expected a glTF 2.0 file");
      parse(chunk);
      has_json = true;
    } else if (kind == kBinaryChunk && !binary_) {
      binary_.emplace(chunk.begin(), chunk.end());
    }
    offset += size;
  }
  if (!has_json) fail("has no JSON chunk, expected a glTF 2.0 file");
}

void GltfDocument::parse(std::span<const std::byte> text) {
  const auto* begin = reinterpret_cast<const char*>(text.data());
  try {
    root_ = Json::parse(begin, begin + text.size());
  } catch (const Json::exception& error) {
    fail("is no glTF file (.glb or .gltf): " + std::string(error.what()));
  }
  if (!root_.is_object()) fail("its JSON is no object, expected a glTF 2.0 file");
}

void GltfDocument::check_version() const {
  const auto asset = root_.find("asset");
  const std::string version =
      asset != root_.end() && asset->is_object() ? text(*asset, "version", "") : "";
  if (!version.starts_with("2.")) {
    fail("asset.version = '" + version + "', expected '2.0'");
  }
  const auto required = root_.find("extensionsRequired");
  if (required == root_.end()) return;
  if (!required->is_array()) fail("extensionsRequired is no array");
  for (const Json& extension : *required) {
    const std::string id = extension.is_string() ? extension.get<std::string>() : "?";
    // Looks only: geometry and motion are the same without them.
    if (id.starts_with("KHR_materials_") || id == "KHR_texture_transform" ||
        id == "KHR_texture_basisu" || id == "EXT_texture_webp" || id == "KHR_lights_punctual") {
      continue;
    }
    fail("needs the extension '" + id + "', expected plain glTF 2.0; export without compression");
  }
}

void GltfDocument::read_buffers(const FileSource& files) {
  std::size_t total = 0;
  for (std::size_t b = 0; b < count("buffers"); ++b) {
    const Json& buffer = entry("buffers", b);
    const std::string where = "buffers[" + std::to_string(b) + "]";
    std::vector<std::byte> bytes = buffer_bytes(b, files);
    const auto length = buffer.find("byteLength");
    if (length == buffer.end() || !length->is_number_unsigned() ||
        length->get<std::size_t>() > bytes.size()) {
      fail(where + ".byteLength is no number or more than the " + std::to_string(bytes.size()) +
           " bytes that are there");
    }
    total += bytes.size();
    if (total > kMaxBytes) fail("its buffers have over " + std::to_string(kMaxBytes) + " bytes");
    bytes.resize(length->get<std::size_t>());
    buffers_.push_back(std::move(bytes));
  }
}

std::vector<std::byte> GltfDocument::buffer_bytes(std::size_t index,
                                                  const FileSource& files) const {
  const Json& buffer = entry("buffers", index);
  const std::string where = "buffers[" + std::to_string(index) + "]";
  const std::string uri = text(buffer, "uri", "");
  if (uri.empty()) {
    if (index != 0 || !binary_) fail(where + " has no uri, and the file has no binary chunk");
    return *binary_;
  }
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(";base64,");
    if (comma == std::string::npos) fail(where + ".uri is no base64 data");
    std::optional<std::vector<std::byte>> bytes =
        from_base64(std::string_view(uri).substr(comma + 8));
    if (!bytes) fail(where + ".uri is no base64 data");
    return std::move(*bytes);
  }
  const std::string place = where + ".uri = '" + uri.substr(0, kMaxShown) + "': ";
  if (!files) fail(place + "names another file, expected a .glb with everything inside");
  std::optional<std::string> bytes;
  try {
    bytes = files(uri);
  } catch (const InvalidArgument& error) {
    fail(place + error.what());
  }
  if (!bytes) fail(place + "no such file");
  const auto view = std::as_bytes(std::span(*bytes));
  return {view.begin(), view.end()};
}

std::size_t GltfDocument::count(const std::string& array) const {
  const auto found = root_.find(array);
  if (found == root_.end()) return 0;
  if (!found->is_array()) fail(array + " is no array");
  return found->size();
}

const nlohmann::json& GltfDocument::entry(const std::string& array, std::size_t index) const {
  if (index >= count(array)) {
    fail(array + "[" + std::to_string(index) + "] does not exist, there are " +
         std::to_string(count(array)));
  }
  const Json& result = root_[array][index];
  if (!result.is_object()) fail(array + "[" + std::to_string(index) + "] is no object");
  return result;
}

std::optional<std::size_t> GltfDocument::index(const nlohmann::json& object, const std::string& key,
                                               const std::string& array,
                                               const std::string& where) const {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  const std::size_t size = count(array);
  if (!found->is_number_unsigned() || found->get<std::size_t>() >= size) {
    fail(where + "." + key + " = " + found->dump().substr(0, 40) + ", expected one of the " +
         std::to_string(size) + " " + array + ", from 0");
  }
  return found->get<std::size_t>();
}

std::size_t GltfDocument::required_index(const nlohmann::json& object, const std::string& key,
                                         const std::string& array, const std::string& where) const {
  const std::optional<std::size_t> result = index(object, key, array, where);
  if (!result) fail(where + "." + key + " is missing");
  return *result;
}

std::optional<Eigen::VectorXd> GltfDocument::numbers(const nlohmann::json& object,
                                                     const std::string& key, std::size_t size,
                                                     const std::string& where) const {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  const std::string expected =
      where + "." + key + ", expected " + std::to_string(size) + " finite numbers";
  if (!found->is_array() || found->size() != size) fail(expected);
  Eigen::VectorXd result(static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i) {
    if (!(*found)[i].is_number()) fail(expected);
    result[static_cast<Eigen::Index>(i)] = (*found)[i].get<double>();
  }
  if (!result.allFinite()) fail(expected);
  return result;
}

std::string GltfDocument::text(const nlohmann::json& object, const std::string& key,
                               const std::string& otherwise) const {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

}  // namespace weft::characters
