#pragma once

// Tested by tests/scenes/catalog/tear_test.cpp.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <weft/scenes/recording/storage/database.hpp>
#include <weft/scenes/recording/storage/format.hpp>

namespace weft::scenes {

/// Table topology of a recording that is written.
class TopologyWriter {
 public:
  TopologyWriter(const std::vector<RecordedBody>& bodies, bool can_tear);

  [[nodiscard]] bool can_tear() const { return can_tear_; }
  /// Tells the codec how many nodes the cloths of a state have. Throws InvalidArgument for a
  /// topology that does not fit.
  void prepare(const SceneState& state, FrameCodec& codec) const;
  /// What is new in a state that was prepared goes into the hash and, with write(), into the file.
  void take(const SceneState& state, std::int64_t frame, ContentHash& hash);
  void write(Database& database);
  [[nodiscard]] std::string hash() const { return hash_.hex(); }  ///< of what is written

 private:
  struct Pending {
    std::int64_t first_frame;
    std::size_t body;
    int nodes;
    std::vector<std::byte> bytes;
  };
  [[nodiscard]] bool is_new(const SceneState& state, std::size_t cloth) const;
  [[nodiscard]] int num_nodes(const ClothState& cloth, std::size_t body) const;
  void check(const ClothState& cloth, std::size_t body) const;

  bool can_tear_;
  std::vector<int> first_nodes_;  ///< of each body
  std::vector<std::shared_ptr<const ClothTopology>> last_;
  std::vector<Pending> pending_;
  std::int64_t num_rows_ = 0;
  StreamHash hash_;
};

}  // namespace weft::scenes
