#include <weft/scenes/characters/model_files.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include <weft/characters/base64.hpp>
#include <weft/characters/gltf_reader.hpp>
#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kUriStart = "data:model/gltf-binary;base64,";

std::vector<std::byte> bytes_of(const std::string& name, const FileSource& files) {
  if (name.starts_with(kUriStart)) {
    auto bytes = characters::from_base64(std::string_view(name).substr(kUriStart.size()));
    if (!bytes) throw InvalidArgument("the model inside the scene is no base64 text");
    return std::move(*bytes);
  }
  const std::span<const ModelFile> own = model_files();
  const auto found = std::find_if(own.begin(), own.end(),
                                  [&](const ModelFile& file) { return file.name == name; });
  if (found != own.end()) {
    const auto bytes = std::as_bytes(found->bytes);
    return {bytes.begin(), bytes.end()};
  }
  const std::optional<std::string> bytes = files ? files(name) : std::nullopt;
  if (!bytes) throw InvalidArgument("no such file, expected a glTF model beside the scene file");
  const auto view = std::as_bytes(std::span(*bytes));
  return {view.begin(), view.end()};
}

}  // namespace

std::shared_ptr<const CharacterModel> load_model(const std::string& name, const FileSource& files) {
  auto model = std::make_shared<CharacterModel>();
  model->bytes = bytes_of(name, files);
  if (model->bytes.size() > kMaxModelSize) {
    throw InvalidArgument("has " + std::to_string(model->bytes.size()) +
                          " bytes, expected at most " + std::to_string(kMaxModelSize) +
                          ", for a recording keeps it; export without pictures");
  }
  const bool is_inside = name.starts_with(kUriStart);
  // Without other files: they would not be part of a recording.
  model->character = characters::read_gltf(
      model->bytes, is_inside ? "model" : std::filesystem::path(name).filename().string());
  return model;
}

std::string model_uri(const CharacterModel& model) {
  return std::string(kUriStart) + characters::to_base64(model.bytes);
}

}  // namespace weft::scenes
