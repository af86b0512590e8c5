#include <weft/playback/exchange/gltf/glb_writer.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// Constants of the glTF 2.0 specification, sections 3.6 and 4.4.
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kGlbVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::size_t kAlignment = 4;
constexpr std::array<const char*, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};

constexpr const char* kGenerator = "Weft";
/// The document begins with this: the asset is the first of its objects.
constexpr std::string_view kDocumentBeginning =
    "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Weft\"";

void append_word(std::string& bytes, std::uint32_t word) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

void pad(std::string& bytes, char filler) {
  while (bytes.size() % kAlignment != 0) bytes += filler;
}

void append_chunk(std::string& bytes, std::uint32_t type, std::string_view content) {
  append_word(bytes, static_cast<std::uint32_t>(content.size()));
  append_word(bytes, type);
  bytes += content;
}

bool begins_as_glb(std::string_view beginning) {
  std::uint32_t magic = 0;
  constexpr std::size_t kJsonBegin =
      20;  // [byte] after the headers of the file and of its first chunk
  if (beginning.size() < kJsonBegin) return false;
  std::memcpy(&magic, beginning.data(), sizeof magic);
  return magic == kMagic && beginning.substr(kJsonBegin).starts_with(kDocumentBeginning);
}

}  // namespace

const output::FileKind kGlbKind{"a glTF file", begins_as_glb};

GlbWriter::GlbWriter() {
  root_["asset"] = {{"version", "2.0"}, {"generator", kGenerator}};
}

int GlbWriter::add(const char* array, GltfJson object) {
  root_[array].push_back(std::move(object));
  return static_cast<int>(root_[array].size()) - 1;
}

int GlbWriter::add_view(std::string_view bytes, const char* target_key, int target) {
  pad(binary_, '\0');
  GltfJson view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target_key != nullptr) view[target_key] = target;
  binary_ += bytes;
  return add("bufferViews", std::move(view));
}

int GlbWriter::add_accessor(const void* values, std::size_t bytes, Use use, GltfJson accessor) {
  const std::string_view content(static_cast<const char*>(values), bytes);
  accessor["bufferView"] =
      use == Use::kAnimation
          ? add_view(content, nullptr, 0)
          : add_view(content, "target", use == Use::kIndices ? kElementArrayBuffer : kArrayBuffer);
  return add("accessors", std::move(accessor));
}

int GlbWriter::add_numbers(const Eigen::Ref<const Eigen::MatrixXf>& numbers, Use use) {
  const Eigen::MatrixXf packed = numbers;
  GltfJson accessor = {{"componentType", kFloat},
                       {"count", packed.cols()},
                       {"type", kTypes.at(static_cast<std::size_t>(packed.rows()) - 1)}};
  for (Eigen::Index row = 0; row < packed.rows(); ++row) {
    accessor["min"].push_back(packed.row(row).minCoeff());
    accessor["max"].push_back(packed.row(row).maxCoeff());
  }
  const std::size_t bytes = static_cast<std::size_t>(packed.size()) * sizeof(float);
  return add_accessor(packed.data(), bytes, use, std::move(accessor));
}

int GlbWriter::add_indices(const Eigen::Ref<const Eigen::MatrixXi>& indices) {
  static_assert(sizeof(int) == sizeof(std::uint32_t));
  const Eigen::MatrixXi packed = indices;
  GltfJson accessor = {
      {"componentType", kUnsignedInt}, {"count", packed.size()}, {"type", "SCALAR"}};
  accessor["min"].push_back(packed.minCoeff());
  accessor["max"].push_back(packed.maxCoeff());
  const std::size_t bytes = static_cast<std::size_t>(packed.size()) * sizeof(int);
  return add_accessor(packed.data(), bytes, Use::kIndices, std::move(accessor));
}

int GlbWriter::add_image(std::string_view bytes, const char* media_type) {
  const int view = add_view(bytes, nullptr, 0);
  return add("images", {{"bufferView", view}, {"mimeType", media_type}});
}

std::string GlbWriter::bytes() const {
  std::string binary = binary_;
  pad(binary, '\0');
  GltfJson root = root_;
  if (!binary.empty()) root["buffers"] = GltfJson::array({{{"byteLength", binary.size()}}});
  // Names come from scenes and programs: bytes that are no UTF-8 must not end the export.
  std::string text = root.dump(-1, ' ', false, GltfJson::error_handler_t::replace);
  pad(text, ' ');
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  const std::size_t size =
      kHeader + kChunkHeader + text.size() + (binary.empty() ? 0 : kChunkHeader + binary.size());
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format(
        "a .glb file of {:.2f} GB, expected at most 4.29 GB (weft trim makes a recording shorter)",
        1e-9 * static_cast<double>(size)));
  }
  std::string file;
  file.reserve(size);
  append_word(file, kMagic);
  append_word(file, kGlbVersion);
  append_word(file, static_cast<std::uint32_t>(size));
  append_chunk(file, kJsonChunk, text);
  if (!binary.empty()) append_chunk(file, kBinaryChunk, binary);
  return file;
}

}  // namespace weft::scenes
