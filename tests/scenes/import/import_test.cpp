#include <weft/scenes/import/import_mesh.hpp>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <weft/mesh/topology/hinges.hpp>
#include <weft/scenes/import/isolated_run.hpp>
#include <weft/scenes/import/weld.hpp>
#include "tests/scenes/import/broken_cases.hpp"

namespace weft::import {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::filesystem::path kHere = std::string(WEFT_SOURCE_DIR) + "/tests/scenes/import";
constexpr double kRoundoff = 1e-12;  // of a few sums near 1

std::string error_of(const std::filesystem::path& file, const ImportOptions& options = {}) {
  try {
    (void)import_mesh(file, options);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Import, EveryBrokenFileGivesOneClearLine) {
  for (const BrokenCase& broken : kBrokenCases) {
    const std::filesystem::path file = kHere / "broken" / broken.file;
    const std::string error = error_of(file);
    EXPECT_THAT(error, StartsWith(file.string() + ": ")) << broken.file;
    EXPECT_THAT(error, HasSubstr(broken.fragment)) << broken.file;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_LE(error.size(), file.string().size() + 400) << error;
  }
}

TEST(Import, ATetrahedronIsTheSameFromEveryFormat) {
  for (const char* name : {"tetrahedron.glb", "tetrahedron.stl", "tetrahedron.ply"}) {
    const ImportedMesh mesh = import_mesh(kHere / "good" / name);
    EXPECT_EQ(mesh.surface.positions.cols(), 4) << name;
    EXPECT_EQ(mesh.surface.triangles.cols(), 4) << name;
    EXPECT_TRUE(mesh.report.is_closed()) << name;
    EXPECT_TRUE(is_closed_surface(mesh.surface.triangles)) << name;
    EXPECT_NEAR(surface_area(mesh.surface), 1.5 + std::sqrt(3.0) / 2, 1e-6) << name;
    EXPECT_NEAR(mesh.report.area, surface_area(mesh.surface), kRoundoff) << name;
    const ClothMesh body =
        make_surface_body(mesh.surface, {.total_mass = 2.0, .center_mass_share = 0.1});
    EXPECT_NEAR(body.masses.sum(), 2.0, kRoundoff) << name;
  }
  EXPECT_EQ(import_mesh(kHere / "good/tetrahedron.stl").report.welded_vertices, 12 - 4);
}

// tools/models/make_flag.py: the weight of "Tip" is x / 0.3 m, that of "Pole" the rest.
TEST(Import, WeightsOfBonesBecomeGroupsFromEveryFormatThatHasThem) {
  for (const char* name : {"flag.glb", "flag.fbx"}) {
    const ImportedMesh mesh = import_mesh(kHere / "good" / name);
    ASSERT_EQ(mesh.surface.positions.cols(), 12) << name;
    EXPECT_NEAR(surface_area(mesh.surface), 0.06, 1e-7) << name;  // metres, in single precision
    int found = 0;
    for (const NodeGroup& group : mesh.groups) {
      if (group.is_part) continue;
      ++found;
      EXPECT_EQ(group.nodes.size(), 9U) << name << ' ' << group.name;  // three columns of three
      for (std::size_t i = 0; i < group.nodes.size(); ++i) {
        const double share = mesh.surface.positions(0, group.nodes[i]) / 0.3;
        const double expected = group.name == "Tip" ? share : 1.0 - share;
        EXPECT_NEAR(group.weights[i], expected, 1e-6) << name << ' ' << group.name;
      }
    }
    EXPECT_EQ(found, 2) << name;
  }
}

/// A folder with a mesh in a folder of its own, removed at the end.
class MeshFolder {
 public:
  MeshFolder()
      : path_(std::filesystem::temp_directory_path() / ("weft_mesh_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_ / "models");
  }
  ~MeshFolder() { std::filesystem::remove_all(path_); }
  MeshFolder(const MeshFolder&) = delete;
  MeshFolder& operator=(const MeshFolder&) = delete;
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Import, ReadsTheBuffersOfGltfInItsFolderAndBelowOnly) {
  const MeshFolder folder;
  const std::string text = content_of(kHere / "broken/missing_buffer.gltf");
  const std::string tetrahedron = content_of(kHere / "good/tetrahedron.glb");
  const std::string buffer = tetrahedron.substr(tetrahedron.size() - 72);  // its binary chunk
  folder.write("secret.bin", buffer);
  folder.write("models/own.bin", buffer);
  std::filesystem::create_directory(folder / "models/below");
  folder.write("models/below/own.bin", buffer);
  std::filesystem::create_symlink(folder / "secret.bin", folder / "models/link.bin");
  const auto error_with = [&](const std::string& uri) {
    std::string changed = text;
    changed.replace(changed.find("not_there.bin"), 13, uri);
    folder.write("models/m.gltf", changed);
    return error_of(folder / "models/m.gltf");
  };
  EXPECT_EQ(error_with("own.bin"), "no error");
  EXPECT_EQ(error_with("below/own.bin"), "no error");
  EXPECT_THAT(error_with("../secret.bin"), HasSubstr("leads out of the folder"));
  EXPECT_THAT(error_with((folder / "secret.bin").string()), HasSubstr("is an absolute path"));
  EXPECT_THAT(error_with("link.bin"), HasSubstr("is a link out of the folder"));
}

TEST(Import, ReadsNoMaterialLibraryOfAnObj) {
  const MeshFolder folder;
  // Lines that assimp quotes in its messages, once for each that it does not know.
  folder.write("secret.txt", "newmtl out of range\nKd dropped the password is 1234\n");
  for (const std::string name : {"../secret.txt", "m.mtl"}) {
    folder.write("models/m.mtl", "mtllib out of range\nnewmtl dropped\n");
    folder.write("models/m.obj", "mtllib " + name + "\nmtllib ../../" + name +
                                     "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    const std::string error = error_of(folder / "models/m.obj");
    EXPECT_EQ(error.find("password"), std::string::npos) << error;
    EXPECT_EQ(error, "no error");
  }
  // Names of materials select a part all the same.
  EXPECT_EQ(error_of(folder / "models/m.obj", {.part = "red"}), "no error");
}

TEST(Import, APipeIsRefusedAtOnce) {
  const MeshFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.obj").c_str(), 0600), 0);
  EXPECT_THAT(error_of(folder / "pipe.obj"), HasSubstr("expected a regular file"));
}

TEST(Import, ALargeFileIsRefusedBeforeItIsRead) {
  const MeshFolder folder;
  folder.write("large.stl", "solid");
  std::filesystem::resize_file(folder / "large.stl", 20'000'000'000);  // no block on the disk
  EXPECT_THAT(error_of(folder / "large.stl"), HasSubstr("has 20000000000 bytes, expected at most"));
}

TEST(Import, LeavesOutWhatIsNoSurfaceAndSaysSo) {
  const MeshReport report = check_mesh(kHere / "good/square.obj");
  EXPECT_EQ(report.num_nodes, 5);
  EXPECT_EQ(report.num_triangles, 4);
  ASSERT_EQ(report.duplicate_faces.size(), 1U);
  EXPECT_EQ(report.duplicate_faces[0].face, 4);
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_EQ(report.boundary_edges, 4);
  EXPECT_NEAR(report.smallest_angle, std::numbers::pi / 4, 1e-6);
  EXPECT_FALSE(report.fault().has_value());
  EXPECT_THAT(report.text(), HasSubstr("duplicate triangles: 1: face 4 of 'sheet'"));
}

TEST(Import, ScaleAxisAndTextureAreAsTheOptionsSay) {
  const ImportedMesh plain = import_mesh(kHere / "good/quad.obj");
  ASSERT_EQ(plain.surface.corner_texture_coordinates.cols(), 6);
  for (Eigen::Index c = 0; c < 6; ++c) {
    // The texture coordinates of this file are x and -z.
    const int node = plain.surface.triangles(c % 3, c / 3);
    const Vector3<double> place = plain.surface.positions.col(node);
    EXPECT_EQ(plain.surface.corner_texture_coordinates.col(c),
              Eigen::Vector2d(place.x(), -place.z()));
  }
  const ImportedMesh turned =
      import_mesh(kHere / "good/quad.obj", {.scale = 0.5, .up = UpAxis::kZ});
  for (Eigen::Index n = 0; n < 4; ++n) {
    const Vector3<double> p = plain.surface.positions.col(n);
    EXPECT_EQ(turned.surface.positions.col(n), 0.5 * Vector3<double>(p.x(), p.z(), -p.y()));
  }
  EXPECT_THROW((void)import_mesh(kHere / "good/quad.obj", {.scale = 0.0}), InvalidArgument);
}

TEST(Import, PartsAreReadByNameAndAreGroups) {
  const std::filesystem::path file = kHere / "good/two_parts.obj";
  const ImportedMesh both = import_mesh(file);
  EXPECT_EQ(both.surface.triangles.cols(), 6);
  ASSERT_EQ(both.groups.size(), 2U);
  EXPECT_EQ(both.groups[1].name, "right");
  EXPECT_EQ(both.groups[1].nodes, (std::vector<int>{5, 6, 7, 8}));
  EXPECT_EQ(import_mesh(file, {.part = "right"}).surface.triangles.cols(), 2);
  EXPECT_THAT(error_of(file, {.part = "middle"}),
              HasSubstr("has no part 'middle', expected one of left, right"));
}

TEST(Weld, JoinsToTheFirstWithinTheToleranceAndNoOther) {
  Matrix3X<double> positions(3, 5);
  positions << 0, 1, 1.5e-3, 0.9e-3, 1,  //
      0, 0, 0, 0, 0,                     //
      0, 0, 0, 0, -0.5e-3;
  EXPECT_EQ(weld(positions, 1e-3), (std::vector<int>{0, 1, 2, 0, 1}));
  EXPECT_EQ(weld(positions, 0.0), (std::vector<int>{0, 1, 2, 3, 4}));
  positions.col(4) = positions.col(1);
  EXPECT_EQ(weld(positions, 0.0), (std::vector<int>{0, 1, 2, 3, 1}));
}

TEST(IsolatedRun, ACrashIsAnErrorOfTheChildAlone) {
  EXPECT_EQ(run_isolated([] { return std::string("a\0b", 3); }), std::string("a\0b", 3));
  EXPECT_THROW((void)run_isolated([]() -> std::string { throw Error("no"); }), Error);
  EXPECT_THROW((void)run_isolated([]() -> std::string {
                 std::signal(SIGABRT, SIG_DFL);
                 std::abort();
               }),
               Error);
}

/// Every beginning of a file is a damaged file: none may do more than give an error.
TEST(Import, EveryTruncationOfAFileIsAnError) {
  std::ifstream stream(kHere / "good/tetrahedron.glb", std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const std::filesystem::path file = testing::TempDir() + "truncated.glb";
  ASSERT_GT(whole.size(), 100U);
  constexpr std::size_t kStep = 13;  // no divisor of the chunks' sizes
  for (std::size_t size = 1; size < whole.size(); size += kStep) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, size);
    EXPECT_NE(error_of(file), "no error") << size << " bytes";
  }
}

}  // namespace
}  // namespace weft::import
