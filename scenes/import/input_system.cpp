#include <weft/scenes/import/input_system.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include <assimp/IOStream.hpp>

namespace weft::import {
namespace {

/// Extensions that glTF 2.0 (section 3.6.1) gives to the files of its buffers.
constexpr std::array<std::string_view, 3> kBufferExtensions = {".bin", ".glbin", ".glbuf"};
constexpr std::size_t kMaxShownName = 80;  // of a name, in a message

/// Bytes in memory, as assimp reads them. assimp's own stream of this kind divides by the size of an
/// element, which may be 0, and lets a position overflow.
class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string bytes) : bytes_(std::move(bytes)) {}

  size_t Read(void* to, size_t size, size_t count) override {
    if (to == nullptr || size == 0 || count == 0) return 0;
    const std::size_t number = std::min(count, (bytes_.size() - position_) / size);
    if (number == 0) return 0;
    std::memcpy(to, bytes_.data() + position_, size * number);
    position_ += size * number;
    return number;
  }
  size_t Write(const void* /*from*/, size_t /*size*/, size_t /*count*/) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const std::size_t size = bytes_.size();
    const std::size_t room = origin == aiOrigin_CUR ? size - position_ : size;
    if (offset > room) return aiReturn_FAILURE;
    position_ = origin == aiOrigin_SET   ? offset
                : origin == aiOrigin_CUR ? position_ + offset
                                         : size - offset;
    return aiReturn_SUCCESS;
  }
  [[nodiscard]] size_t Tell() const override { return position_; }
  [[nodiscard]] size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace

InputSystem::InputSystem(const MeshInput& input)
    : input_(input), mesh_name_("mesh" + input.name.extension().string()) {}

bool InputSystem::Exists(const char* name) const {
  return name == mesh_name_;
}

std::optional<std::string> InputSystem::content_of(const std::string& name) {
  if (name == mesh_name_) return input_.bytes;
  const std::string extension = std::filesystem::path(name).extension().string();
  const bool is_buffer = std::find(kBufferExtensions.begin(), kBufferExtensions.end(), extension) !=
                         kBufferExtensions.end();
  std::string reason = "no such file";
  if (!is_buffer) {
    reason = "is no buffer, expected a file that ends with .bin, .glbin or .glbuf";
  } else {
    try {
      std::optional<std::string> bytes = input_.files ? input_.files(name) : std::nullopt;
      if (bytes) return bytes;
    } catch (const InvalidArgument& error) {
      reason = error.what();
    }
  }
  if (refusal_.empty()) {
    refusal_ = "the file '" + name.substr(0, kMaxShownName) + "' that it names " +
               (reason == "no such file" ? "does not exist" : reason);
  }
  return std::nullopt;
}

Assimp::IOStream* InputSystem::Open(const char* name, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  std::optional<std::string> content = content_of(name);
  if (!content) return nullptr;
  return new MemoryStream(std::move(*content));  // assimp owns it until Close()
}

void InputSystem::Close(Assimp::IOStream* stream) {
  delete stream;
}

}  // namespace weft::import
