#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <weft/scenes/catalog.hpp>
#include <weft/scenes/format/scene_file.hpp>

namespace weft::scenes {
namespace {

constexpr const char* kAgain = "run the command that docs/scenes.md names";

TEST(ScenePage, HasEverySceneWithItsPictureAndItsSummary) {
  const std::filesystem::path docs = std::filesystem::path(WEFT_SOURCE_DIR) / "docs";
  std::ifstream stream(docs / "scenes.md");
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_TRUE(std::filesystem::exists(docs / "img/contact_sheet.png")) << kAgain;
  for (const CatalogEntry& entry : scene_catalog()) {
    const std::string name(entry.name);
    const std::string picture = "img/scenes/" + name + ".png";
    EXPECT_NE(page.find("| ![" + name + "](" + picture + ") | [`" + name + "`]"), std::string::npos)
        << name << ": " << kAgain;
    EXPECT_TRUE(std::filesystem::exists(docs / picture)) << kAgain;
    const std::string shows = load_scene(name).summary.substr(std::string("Shows ").size());
    EXPECT_NE(page.find("| " + shows + " |"), std::string::npos) << name << ": " << kAgain;
  }
}

}  // namespace
}  // namespace weft::scenes
