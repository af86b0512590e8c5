#include <weft/scenes/characters/model_files.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include <weft/characters/base64.hpp>
#include <weft/characters/gltf_reader.hpp>
#include <weft/custom_forces/core/error.hpp>

namespace weft::scenes {
namespace {

constexpr std::string_view kUriStart = "data:model/gltf-binary;base64,";

std::vector<std::byte> bytes_of(const std::string& name, const std::string& scene_file) {
  if (name.starts_with(kUriStart)) {
    auto bytes = characters::from_base64(std::string_view(name).substr(kUriStart.size()));
    if (!bytes) throw InvalidArgument("the model inside the scene is no base64 text");
    return std::move(*bytes);
  }
  const std::span<const ModelFile> files = model_files();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&](const ModelFile& file) { return file.name == name; });
  if (found != files.end()) {
    const auto bytes = std::as_bytes(found->bytes);
    return {bytes.begin(), bytes.end()};
  }
  return characters::file_bytes(std::filesystem::path(scene_file).parent_path() / name);
}

}  // namespace

std::shared_ptr<const CharacterModel> load_model(const std::string& name,
                                                 const std::string& scene_file) {
  auto model = std::make_shared<CharacterModel>();
  model->bytes = bytes_of(name, scene_file);
  if (model->bytes.size() > kMaxModelSize) {
    throw InvalidArgument("has " + std::to_string(model->bytes.size()) +
                          " bytes, expected at most " + std::to_string(kMaxModelSize) +
                          ", for a recording keeps it; export without pictures");
  }
  const bool is_inside = name.starts_with(kUriStart);
  // A folder that cannot be: other files are not part of the recording.
  const std::filesystem::path no_folder = "/dev/null";
  model->character = characters::read_gltf(
      model->bytes, is_inside ? "model" : std::filesystem::path(name).filename().string(),
      no_folder);
  return model;
}

std::string model_uri(const CharacterModel& model) {
  return std::string(kUriStart) + characters::to_base64(model.bytes);
}

}  // namespace weft::scenes
