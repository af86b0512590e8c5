#include <weft/playback/exchange/vtp_export.hpp>

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <weft/playback/exchange/vtp_file.hpp>

#include "tests/scenes/recording/recording_samples.hpp"

namespace weft::scenes {
namespace {

TEST(VtpText, HoldsNumbersAsBase64AfterTheirSize) {
  VtpSurface surface;
  surface.points = Matrix3X<double>::Zero(3, 1);
  surface.triangles = Triangles(3, 0);
  const std::string text = vtp_text(surface, false);
  // 12 bytes: the number in 64 bits, then three zeros.
  EXPECT_NE(text.find("Name=\"Points\" NumberOfComponents=\"3\" format=\"binary\">"
                      "DAAAAAAAAAAAAAAAAAAAAAAAAAA=</DataArray>"),
            std::string::npos)
      << text;
}

TEST(VtpExport, NamesEveryFileWithItsTime) {
  const samples::TemporaryFolder folder;
  const Scene scene = samples::make_scene();
  samples::write_sample(folder / "a.weftrec", scene, StoredPrecision::kFloat64, 3);
  const RecordingReader reader(folder / "a.weftrec");
  EXPECT_EQ(export_vtp_series(reader, vtp_folder(folder / "out")), 9);
  std::ifstream file(folder / "out/series.pvd");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find("timestep=\"0.016666666666666666\" part=\"1\" name=\"flag\" "
                            "file=\"flag_00001.vtp\""),
            std::string::npos)
      << text.str();
  EXPECT_TRUE(std::filesystem::exists(folder / "out/ball_00002.vtp"));
}

}  // namespace
}  // namespace weft::scenes
