#include <weft/scenes/snapshot/snapshot_file.hpp>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>

namespace weft::scenes {
namespace {

Snapshot example() {
  Snapshot snapshot{
      "bullet_weft", "float32", 60, 0.5, std::make_shared<const std::string>("a = 1\n"), {}};
  for (int i = 0; i < 300; ++i) snapshot.state.push_back(static_cast<std::byte>(i));
  return snapshot;
}

class SnapshotFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".weftsnap");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
  [[nodiscard]] std::string refusal() const {
    try {
      (void)read_snapshot_file(path_);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path path_;
};

TEST_F(SnapshotFile, ComesBackWhole) {
  write(snapshot_bytes(example()));
  const Snapshot read = read_snapshot_file(path_);
  EXPECT_EQ(read.engine, "bullet_weft");
  EXPECT_EQ(read.precision, "float32");
  EXPECT_EQ(read.step, 60);
  EXPECT_EQ(read.time, 0.5);
  EXPECT_EQ(*read.scene, "a = 1\n");
  EXPECT_EQ(read.state, example().state);
  EXPECT_EQ(snapshot_bytes(read), snapshot_bytes(example()));
}

TEST_F(SnapshotFile, RefusesEveryTruncation) {
  const std::string bytes = snapshot_bytes(example());
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    write(bytes.substr(0, size));
    EXPECT_NE(refusal(), "") << size;
  }
}

TEST_F(SnapshotFile, RefusesEveryOtherByte) {
  const std::string bytes = snapshot_bytes(example());
  for (std::size_t i = 0; i < bytes.size(); i += 5) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x20);
    write(damaged);
    EXPECT_NE(refusal(), "") << i;
  }
}

TEST_F(SnapshotFile, SaysWhatItIsInstead) {
  write("SQLite format 3");
  EXPECT_NE(refusal().find("is no snapshot, expected a file of weft run --snapshot"),
            std::string::npos);
  write("weft-snapshot/7\n");
  EXPECT_NE(refusal().find("version '7', expected '1'"), std::string::npos);
  std::filesystem::remove(path_);
  EXPECT_NE(refusal().find(path_.string()), std::string::npos);
}

}  // namespace
}  // namespace weft::scenes
