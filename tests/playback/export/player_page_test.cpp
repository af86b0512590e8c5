#include <weft/playback/export/player_page.hpp>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/playback/export/player_template.hpp>
#include <weft/scenes/output/output_file.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

TEST(PlayerPage, WithoutRecordingsIsThePlayer) {
  const std::string page = player_page({});
  EXPECT_EQ(page.find("application/x-weft-recording\" data-name"), std::string::npos);
  EXPECT_GT(page.size(), 1'000'000U) << "web/dist/player.html has not been built";
}

TEST(PlayerPage, HoldsRecordingsAndPostersAsBase64) {
  const std::string page = player_page({{"a.weftrec", "Weft", "jpeg", "hang at t = 1 s"}});
  EXPECT_NE(page.find("data-name=\"a.weftrec\">V2VmdA==</script>"), std::string::npos);
  EXPECT_NE(page.find("alt=\"hang at t = 1 s\" src=\"data:image/jpeg;base64,anBlZw==\""),
            std::string::npos);
}

TEST(PlayerPage, NoNameLeavesItsAttribute) {
  const std::string page = player_page({{"\"><script>alert(1)</script>&.weftrec", "", "", ""}});
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(page.find("&quot;&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;.weftrec"),
            std::string::npos);
}

TEST(PlayerPage, IsReplacedByItselfAndByNothingElse) {
  const samples::TemporaryFolder folder;
  output::write_file(folder / "page.html", kPlayerPageKind, player_page({}));
  EXPECT_NO_THROW(output::write_file(folder / "page.html", kPlayerPageKind, player_page({})));
  const output::FileKind anything{"a text", [](std::string_view) { return true; }};
  output::write_file(folder / "mine.html", anything, "<!doctype html><p>mine</p>");
  EXPECT_THROW(output::OutputFile(folder / "mine.html", kPlayerPageKind), InvalidArgument);
}

TEST(PlayerPage, AsksForNothingFromANetwork) {
  const std::string_view page = player_template();
  EXPECT_NE(page.find("default-src 'none'"), std::string_view::npos);
  EXPECT_EQ(page.find("connect-src"), std::string_view::npos);
}

}  // namespace
}  // namespace weft::scenes
