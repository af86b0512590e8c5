#include <weft/playback/rendering/assets.hpp>

#include <weft/core/error.hpp>

namespace weft::scenes {

const Asset& find_asset(std::string_view path) {
  for (const Asset& asset : assets()) {
    if (asset.path == path) return asset;
  }
  throw Error("playback: file '" + std::string(path) + "' is not built into the library");
}

std::string asset_text(std::string_view path) {
  const Asset& asset = find_asset(path);
  return {reinterpret_cast<const char*>(asset.bytes), asset.size};
}

}  // namespace weft::scenes
