#pragma once

// Tested by tests/scenes/catalog/tear_test.cpp.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::scenes {

/// Table topology of a recording that is read: what the cloths consist of in each frame. Nothing in
/// a recording of version 1.
class Topologies {
 public:
  Topologies() = default;
  /// Reads and verifies all rows but their data. Throws Error.
  Topologies(const Database& database, const Header& header, const FrameCodec& codec,
             std::string file);

  [[nodiscard]] bool empty() const { return rows_.empty(); }
  /// How the bytes of a frame are laid out.
  [[nodiscard]] const FrameCodec& codec_at(std::int64_t frame) const;
  /// Gives the cloths of a frame their topologies. Throws Error for damaged data.
  void set(const Database& database, std::int64_t frame, SceneState& state) const;
  [[nodiscard]] bool begins_at(std::int64_t frame) const;
  /// Adds those that begin with this frame. Throws Error for damaged data.
  void add_to_hash(const Database& database, std::int64_t frame, ContentHash& hash) const;

 private:
  struct Row {
    std::int64_t id;
    std::int64_t first_frame;
    std::size_t body;
    int nodes;
    std::int64_t raw_bytes;
    std::string hash;
    mutable std::shared_ptr<const ClothTopology> decoded;  ///< once asked for
  };
  struct Layout {
    std::int64_t first_frame;
    FrameCodec codec;
  };
  void check(const Row& row, const Header& header) const;
  [[nodiscard]] std::vector<std::byte> read(const Database& database, const Row& row) const;
  [[nodiscard]] std::size_t layout_at(std::int64_t frame) const;

  std::string file_;
  std::vector<int> first_nodes_;  ///< of each body
  std::vector<Row> rows_;
  std::vector<Layout> layouts_ = {{0, FrameCodec({}, StoredPrecision::kFloat64)}};
};

}  // namespace weft::scenes
