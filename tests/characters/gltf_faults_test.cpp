#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include <weft/characters/gltf_reader.hpp>
#include <weft/core/error.hpp>

#include "tests/characters/small_model.hpp"

namespace weft::tests {
namespace {

using characters::Character;

Character read(const std::string& text) {
  return characters::read_gltf(std::as_bytes(std::span(text)), "bad.gltf");
}

std::string message_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "read without an error";
}

struct Fault {
  const char* name;
  const char* from;
  const char* to;
  const char* message;  ///< a part of it
};

class GltfFaults : public testing::TestWithParam<Fault> {};

TEST_P(GltfFaults, GiveOneLineThatNamesThePlace) {
  const std::string text = changed(small_model(), GetParam().from, GetParam().to);
  const std::string message = message_of(text);
  EXPECT_EQ(message.substr(0, 10), "bad.gltf: ") << message;
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfFaults,
    testing::Values(
        Fault{"NoJson", "\"asset\"", "asset", "is no glTF file"},
        Fault{"OldVersion", "\"2.0\"", "\"1.0\"", "asset.version = '1.0', expected '2.0'"},
        Fault{"Compression", "\"scene\": 0,", "\"extensionsRequired\": [\"KHR_draco\"],",
              "needs the extension 'KHR_draco'"},
        Fault{"NoScene", "\"scenes\": [{\"nodes\": [0, 2]}],", "", "has no scene"},
        Fault{"NodeOutOfRange", "\"nodes\": [0, 2]", "\"nodes\": [0, 9]", "names node 9"},
        Fault{"Loop", "\"children\": [3]", "\"children\": [0]", "nodes[0] is reached twice"},
        Fault{"ShortVector", "\"translation\": [0, 1, 0], \"children\": [1]",
              "\"translation\": [0, 1], \"children\": [1]",
              "nodes[0].translation, expected 3 finite numbers"},
        Fault{"MatrixRow", "\"translation\": [0, 1, 0], \"children\": [1]",
              "\"matrix\": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1], \"children\": [1]",
              "nodes[0].matrix has another last row"},
        Fault{"NoPositions", "{\"attributes\": {\"POSITION\": 0}", "{\"attributes\": {}",
              "meshes[1].primitives[0].POSITION is missing"},
        Fault{"WrongType", "5126, \"type\": \"VEC3\", \"count\": 4",
              "5126, \"type\": \"VEC2\", \"count\": 4",
              "accessors[0].type = 'VEC2', expected 'VEC3'"},
        Fault{"Overrun", "\"VEC3\", \"count\": 4", "\"VEC3\", \"count\": 5",
              "reach beyond its bufferView"},
        Fault{"HugeCount", "\"VEC3\", \"count\": 4", "\"VEC3\", \"count\": 18446744073709551615",
              "reach beyond its bufferView"},
        Fault{"ComponentType", "5121, \"type\": \"VEC4\"", "5199, \"type\": \"VEC4\"",
              "accessors[1].componentType"},
        Fault{"Sparse", "\"count\": 6}", "\"count\": 6, \"sparse\": {}}", "is sparse"},
        Fault{"Triangles", "\"SCALAR\", \"count\": 6", "\"SCALAR\", \"count\": 5",
              "5 corners, expected a multiple of 3"},
        Fault{"FewWeights", "\"componentType\": 5126, \"type\": \"VEC4\", \"count\": 4},",
              "\"componentType\": 5126, \"type\": \"VEC4\", \"count\": 3},",
              "another number of JOINTS_0 or WEIGHTS_0"},
        Fault{"SkinAlone", "\"JOINTS_0\": 1, ", "", "JOINTS_0 or WEIGHTS_0 alone"},
        Fault{"JointOutOfRange", "\"joints\": [0, 1]", "\"joints\": [0]", "names joint 1"},
        Fault{"JointOutsideTheScene", "\"joints\": [0, 1]", "\"joints\": [0, 7]", "names node 7"},
        Fault{"FewMatrices", "\"MAT4\", \"count\": 2", "\"MAT4\", \"count\": 1",
              "has 1 matrices for 2 joints"},
        Fault{"Interpolation", "\"STEP\"", "\"SMOOTH\"", "interpolation = 'SMOOTH'"},
        Fault{"FewValues", "\"input\": 5, \"output\": 8", "\"input\": 5, \"output\": 6",
              "3 values for 3 times, expected 9"},
        Fault{"Times", "\"input\": 5, \"output\": 6}", "\"input\": 3, \"output\": 6}",
              "time 3 = 0.000000 s"},
        Fault{"Sampler", "\"sampler\": 2", "\"sampler\": 3", "channels[2].sampler"},
        Fault{"Base64", ";base64,", ";base64,*", "is no base64 data"},
        Fault{"MissingFile", "\"uri\": \"data:", "\"uri\": \"none:", "names another file"}),
    [](const testing::TestParamInfo<Fault>& info) { return info.param.name; });

TEST(GltfReader, RefusesABindMatrixWithoutAnInverse) {
  const std::string message = message_of(small_model(0.0F));
  EXPECT_EQ(message,
            "bad.gltf: skins[0].inverseBindMatrices, joint 1 ('Tip') has no inverse, expected "
            "determinant != 0");
}

TEST(GltfReader, TakesTheUnitMatrixWhereThereAreNoBindMatrices) {
  const Character character = read(changed(small_model(), ", \"inverseBindMatrices\": 4", ""));
  ASSERT_EQ(character.report.notes.size(), 1U);
  EXPECT_EQ(character.report.notes[0],
            "skins[0] has no inverse bind matrices: taken as unit matrices");
  EXPECT_EQ(character.parts[1].inverse_bind[1].matrix(), Eigen::Matrix4d::Identity());
}

TEST(GltfReader, NormalizesWeightsAndReportsIt) {
  // The colours 0 0 0 1 / 0 0 0 1 / 1 0 0 1 / 1 0 0 1 as weights: the last two sum to 2.
  const Character character = read(changed(small_model(), "\"WEIGHTS_0\": 2", "\"WEIGHTS_0\": 9"));
  EXPECT_EQ(character.report.num_normalized_weights, 2);
  EXPECT_EQ(character.report.largest_weight_error, 1.0);
  for (std::size_t v = 0; v < 4; ++v) {
    const characters::Part& part = character.parts[1];
    double sum = 0;
    for (int k = part.first_influence[v]; k < part.first_influence[v + 1]; ++k) {
      sum += part.influence_weight[static_cast<std::size_t>(k)];
    }
    EXPECT_EQ(sum, 1.0);
  }
}

TEST(GltfReader, SurvivesEveryCutOfAFile) {
  const std::string whole = small_model();
  for (std::size_t size = 0; size < whole.size(); size += 37) {
    EXPECT_NE(message_of(whole.substr(0, size)), "read without an error") << size;
  }
  const std::string file =
      read_input_file(std::string(WEFT_SOURCE_DIR) + "/scenes/models/caped_figure.glb");
  const auto binary = std::as_bytes(std::span(file));
  for (std::size_t size = 0; size < binary.size(); size += 1009) {
    EXPECT_THROW((void)characters::read_gltf(binary.first(size), "cut.glb"), InvalidArgument)
        << size;
  }
}

TEST(GltfReader, ReadsNoOtherFileWithoutASource) {
  const std::string model = small_model();
  const std::size_t uri = model.find("data:application");
  const std::size_t size = model.find('"', uri) - uri;
  // Files that are there: one by an absolute path, one in the working directory.
  for (const char* name : {"/proc/self/status", "CTestTestfile.cmake", "../secret_config"}) {
    const std::string message = message_of(std::string(model).replace(uri, size, name));
    EXPECT_NE(message.find("names another file, expected a .glb"), std::string::npos) << message;
  }
}

TEST(GltfReader, BoundsTheNumbersOfPartsThatShareTheirBytes) {
  // A million vertices take a buffer of 12 MB, and each further part only a few letters.
  constexpr std::size_t kVertices = 999'999;
  std::string parts;
  for (int p = 0; p < 100; ++p) {
    parts += std::string(p == 0 ? "" : ", ") + R"({"attributes": {"POSITION": 0}})";
  }
  const std::string size = std::to_string(12 * kVertices);
  const std::string text =
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" +
      parts + R"(]}], "buffers": [{"uri": "zeros.bin", "byteLength": )" + size +
      R"(}], "bufferViews": [{"buffer": 0, "byteLength": )" + size +
      R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
      std::to_string(kVertices) + "}]}";
  const auto zeros = [&](const std::string&) { return std::string(12 * kVertices, '\0'); };
  try {
    (void)characters::read_gltf(std::as_bytes(std::span(text)), "bad.gltf", zeros);
    FAIL() << "read";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("numbers"), std::string::npos) << error.what();
  }
}

std::string message_of_file(const std::filesystem::path& path) {
  try {
    (void)characters::read_gltf_file(path);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "read without an error";
}

TEST(GltfReader, RefusesALargeFileBeforeItIsRead) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("weft_large_" + std::to_string(getpid()) + ".glb");
  std::ofstream(path) << "glTF";
  std::filesystem::resize_file(path, 20'000'000'000);  // no block on the disk
  const std::string message = message_of_file(path);
  EXPECT_NE(message.find("has 20000000000 bytes, expected at most"), std::string::npos) << message;
  std::filesystem::remove(path);
}

// Without a writer, opening a pipe waits for ever.
TEST(GltfReader, RefusesAPipeAtOnce) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("weft_pipe_" + std::to_string(getpid()) + ".glb");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const std::string message = message_of_file(path);
  EXPECT_NE(message.find("expected a regular file"), std::string::npos) << message;
  std::filesystem::remove(path);
}

TEST(GltfReader, NamesAFileThatIsNotThere) {
  EXPECT_THROW((void)characters::read_gltf_file("/nowhere/figure.glb"), InvalidArgument);
}

}  // namespace
}  // namespace weft::tests
