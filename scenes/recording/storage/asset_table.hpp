#pragma once

// Tested by tests/scenes/recording/asset_test.cpp.

#include <string>
#include <string_view>
#include <vector>

#include <weft/scenes/appearance/appearance.hpp>
#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::scenes {

/// Key of meta with the hash of table asset. Recordings without assets have neither.
inline constexpr const char* kAssetHashKey = "asset_hash";

/// The statement that makes table asset, which most recordings do not have.
extern const std::string_view kAssetSchema;

[[nodiscard]] std::string asset_hash(const std::vector<SceneFile>& files);

/// Makes and fills table asset.
void write_assets(Database& database, const std::vector<SceneFile>& files);

/// The assets of a recording, none if it has no asset_hash. Throws Error that names the file if
/// they do not have their hash.
[[nodiscard]] std::vector<SceneFile> read_assets(const Database& database, const Header& header,
                                                 const std::string& file);

}  // namespace weft::scenes
