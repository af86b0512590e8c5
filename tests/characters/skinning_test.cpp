#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include <weft/characters/gltf_reader.hpp>
#include <weft/core/error.hpp>

#include "tests/characters/small_model.hpp"

namespace weft::tests {
namespace {

using characters::Character;
using characters::Part;

/// The file's numbers have 24 bits and the table nine digits; a figure is 2 m tall [m].
constexpr double kOracleTolerance = 1e-6;
/// Sines and cosines of angles between 24-bit quaternions in the small model [m].
constexpr double kSmallTolerance = 1e-6;

Character small_character() {
  const std::string text = small_model();
  return characters::read_gltf(std::as_bytes(std::span(text)), "small.gltf");
}

const Part& part_named(const Character& character, const std::string& name) {
  return character.parts.at(
      static_cast<std::size_t>(characters::find_parts(character, name).at(0)));
}

Matrix3X<double> skin_at(const Character& character, const Part& part, double time) {
  return skinned_positions(part, bone_frames(character.skeleton, &character.clips.at(0), time));
}

/// Distance from expected to the nearest of the vertices that lie there in the file [m]: limbs of
/// different bones may touch.
double distance_at(const Part& part, const Matrix3X<double>& skin, const Vector3<double>& place,
                   const Vector3<double>& expected) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index v = 0; v < skin.cols(); ++v) {
    // The table rounds to nine digits.
    if ((part.positions.col(v) - place).norm() > 1e-8) continue;
    nearest = std::min(nearest, (skin.col(v) - expected).norm());
  }
  return nearest;
}

/// Largest distance from the table that skin_oracle.py made of the model [m].
double distance_from_table(const std::string& model, const std::string& table) {
  const std::string root = WEFT_SOURCE_DIR;
  const Character character = characters::read_gltf_file(root + model);
  std::ifstream lines(root + table);
  std::string line;
  double worst = 0;
  int count = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string name;
    Vector3<double> place;
    Vector3<double> expected;
    double time = 0;
    words >> name >> place[0] >> place[1] >> place[2] >> time >> expected[0] >> expected[1] >>
        expected[2];
    const Part& part = part_named(character, name);
    const Matrix3X<double> skin = skin_at(character, part, time);
    worst = std::max(worst, distance_at(part, skin, place, expected));
    ++count;
  }
  EXPECT_GT(count, 60) << table;
  return worst;
}

TEST(Skinning, AgreesWithAnIndependentEvaluationOfTheFile) {
  EXPECT_LT(distance_from_table("/scenes/models/caped_figure.glb",
                                "/tests/characters/caped_figure_skin.txt"),
            kOracleTolerance);
}

TEST(Skinning, AgreesWithAnIndependentEvaluationOfAPublicSample) {
  EXPECT_LT(distance_from_table("/tests/characters/models/simple_skin.gltf",
                                "/tests/characters/simple_skin_skin.txt"),
            kOracleTolerance);
}

TEST(Skinning, LinearStepAndCubicChannelsFollowTheirFormulas) {
  const Character character = small_character();
  const characters::Clip& clip = character.clips.at(0);
  EXPECT_EQ(clip.duration, 2.0);
  EXPECT_EQ(value_at(clip.channels.at(0), 0.25), Eigen::Vector3d(0.5, 1, 0));
  EXPECT_EQ(value_at(clip.channels.at(1), 0.999), Eigen::Vector4d(0, 0, 0, 1));
  EXPECT_NEAR(value_at(clip.channels.at(1), 1.0)[2], std::sqrt(0.5), 1e-15);
  // Hermite: tangents 0 at both ends, so 1 + 3 s^2 - 2 s^3.
  EXPECT_NEAR(value_at(clip.channels.at(2), 0.25)[0], 1 + 3 * 0.0625 - 2 * 0.015625, 1e-15);
  EXPECT_EQ(value_at(clip.channels.at(2), 7.0), Eigen::Vector3d(1, 1, 1));
}

TEST(Skinning, AVertexIsTheWeightedMeanOfWhatItsJointsDoToIt) {
  const Character character = small_character();
  const Matrix3X<double> skin = skin_at(character, part_named(character, "Strip"), 1.0);
  // Root has moved by (2, 0, 0). The lower vertices follow it; the upper ones are halfway between
  // Root and Tip, which is turned by 90 deg and twice as large about (2, 2, 0).
  EXPECT_LT((skin.col(0) - Vector3<double>(2, 0, 0)).norm(), kSmallTolerance);
  EXPECT_LT((skin.col(2) - Vector3<double>(2, 2, 0)).norm(), kSmallTolerance);
  const Vector3<double> turned = Vector3<double>(2, 2, 0) + Vector3<double>(0, 2, 0);
  const Vector3<double> expected = 0.5 * (Vector3<double>(3, 2, 0) + turned);
  EXPECT_LT((skin.col(3) - expected).norm(), kSmallTolerance);
}

TEST(Skinning, AMeshWithoutASkinIsCarriedByItsNode) {
  const Character character = small_character();
  const Matrix3X<double> flag = skin_at(character, part_named(character, "Flag"), 0.0);
  EXPECT_EQ(flag.col(1), Vector3<double>(1, 2, 0));
}

TEST(Skinning, GivesTheSameBitsAtTheSameTime) {
  const Character character = small_character();
  const Part& strip = part_named(character, "Strip");
  const Matrix3X<double> once = skin_at(character, strip, 0.7);
  (void)skin_at(character, strip, 1.9);
  EXPECT_EQ(skin_at(character, strip, 0.7), once);
}

TEST(Skinning, TheRestPoseIsThatOfTheFile) {
  const Character character = small_character();
  const Part& strip = part_named(character, "Strip");
  const Matrix3X<double> rest =
      skinned_positions(strip, bone_frames(character.skeleton, nullptr, 0.0));
  EXPECT_EQ(rest, strip.positions);
}

TEST(Skinning, ALoopedClipStartsAgainAndAnotherOneHoldsItsEnd) {
  const Character character = small_character();
  const characters::Clip& clip = character.clips.at(0);
  EXPECT_EQ(clip_time(clip, 2.5, true), 0.5);
  EXPECT_EQ(clip_time(clip, 2.5, false), 2.0);
}

TEST(Skinning, PartsAreFoundByNodeMeshAndMaterial) {
  const Character character = small_character();
  for (const char* name : {"Strip", "Ribbon", "Silk"}) {
    EXPECT_EQ(characters::find_parts(character, name), std::vector<int>{1}) << name;
  }
  EXPECT_EQ(characters::find_parts(character, "Flag"), std::vector<int>{0});
  try {
    (void)characters::find_parts(character, "Cape");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown part 'Cape', expected one of 'Flag', 'Strip', 'Plate', 'Ribbon', 'Silk'");
  }
}

TEST(Skinning, VertexGroupsAreTheWeightsOfABone) {
  const Character character = small_character();
  const Part& strip = part_named(character, "Strip");
  EXPECT_EQ(joint_weights(character, strip, "Tip"), Eigen::Vector4d(0, 0, 0.5, 0.5));
  EXPECT_THROW((void)joint_weights(character, strip, "Strip"), InvalidArgument);
}

TEST(Skinning, VerticesInOnePlaceBecomeOneWherePartsAreMerged) {
  const Character character = small_character();
  // Both parts are the same strip in their own coordinates, on different bones.
  const Part cloth = merged_part(character, {0, 1}, characters::Weld::kSamePlace);
  EXPECT_EQ(cloth.positions.cols(), 4);
  EXPECT_EQ(cloth.triangles.cols(), 4);
  EXPECT_EQ(cloth.first_influence.size(), 5U);
  const Part skin = merged_part(character, {0, 1}, characters::Weld::kSameSkin);
  EXPECT_EQ(skin.positions.cols(), 8);
}

}  // namespace
}  // namespace weft::tests
