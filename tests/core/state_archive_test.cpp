#include <weft/core/state_archive.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft {
namespace {

struct Everything {
  int count = 0;
  double time = 0;
  float nothing = 0;
  bool is_set = false;
  std::string name;
  Matrix3X<float> positions;
  std::vector<std::string> words;
  std::optional<double> present;
  std::optional<double> missing = 3.0;  ///< before something without it is read
  std::vector<float> masses = std::vector<float>(5);
  std::array<double, 3> vector{};

  void serialize(StateArchive& archive) {
    archive.part("everything");
    archive.value(count);
    archive.value(time);
    archive.value(nothing);
    archive.value(is_set);
    archive.value(name);
    archive.value(positions);
    archive.value(words);
    const auto each = [&](double& number) { archive.value(number); };
    archive.optional(present, each);
    archive.optional(missing, each);
    archive.runs(std::span(masses));
    archive.values(std::span(vector));
  }
};

Everything example() {
  Everything one;
  one.count = -3;
  one.time = 0.1;
  one.nothing = std::numeric_limits<float>::quiet_NaN();
  one.is_set = true;
  one.name = "cloth";
  one.positions = Matrix3X<float>::Random(3, 7);
  one.words = {"a", "", "long word"};
  one.present = 0.25;
  one.missing.reset();
  one.masses = {1.0F, 1.0F, 1.0F, -0.0F, 0.0F};
  one.vector = {1, -2, 3.5};
  return one;
}

std::vector<std::byte> bytes_of(Everything one) {
  StateArchive archive = StateArchive::writer();
  one.serialize(archive);
  return archive.take();
}

std::string refusal_of(const std::vector<std::byte>& bytes) {
  Everything other;
  try {
    StateArchive archive = StateArchive::reader(bytes);
    other.serialize(archive);
    archive.end();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(StateArchive, GivesBackEveryBit) {
  const std::vector<std::byte> bytes = bytes_of(example());
  Everything read;
  StateArchive archive = StateArchive::reader(bytes);
  read.serialize(archive);
  archive.end();
  EXPECT_EQ(bytes_of(read), bytes);
  EXPECT_EQ(read.name, "cloth");
  EXPECT_EQ(read.present, 0.25);
  EXPECT_EQ(read.missing, std::nullopt);
  EXPECT_TRUE(std::isnan(read.nothing));
  EXPECT_TRUE(std::signbit(read.masses[3]));
  EXPECT_FALSE(std::signbit(read.masses[4])) << "0 and -0 are no run";
}

TEST(StateArchive, RefusesEveryTruncation) {
  const std::vector<std::byte> bytes = bytes_of(example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(refusal_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), "");
  }
}

TEST(StateArchive, RefusesWhatFollows) {
  std::vector<std::byte> bytes = bytes_of(example());
  bytes.push_back(std::byte{0});
  EXPECT_NE(refusal_of(bytes).find("1 bytes more than expected"), std::string::npos);
}

TEST(StateArchive, NamesThePartThatItExpected) {
  StateArchive archive = StateArchive::writer();
  archive.part("something");
  EXPECT_NE(refusal_of(archive.bytes()).find("part 'something', expected 'everything'"),
            std::string::npos);
}

TEST(StateArchive, NoDamageMakesItAllocateOrReadBeyondTheEnd) {
  const std::vector<std::byte> bytes = bytes_of(example());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::byte> damaged = bytes;
    damaged[i] = std::byte{0xff};
    (void)refusal_of(damaged);  // an Error or another number, and nothing else
  }
}

TEST(StateArchive, ComparesWhatMustBeTheSame) {
  StateArchive archive = StateArchive::writer();
  archive.expect(4, "nodes");
  const std::vector<std::byte> bytes = archive.take();
  StateArchive reader = StateArchive::reader(bytes);
  EXPECT_THROW(reader.expect(5, "nodes"), Error);
  StateArchive again = StateArchive::reader(bytes);
  EXPECT_NO_THROW(again.expect(4, "nodes"));
}

}  // namespace
}  // namespace weft
