#include <weft/scenes/recording/codec/topology_writer.hpp>

#include <fmt/core.h>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/codec/chunk_codec.hpp>
#include <weft/scenes/recording/codec/topology_codec.hpp>

namespace weft::scenes {

TopologyWriter::TopologyWriter(const std::vector<RecordedBody>& bodies, bool can_tear)
    : can_tear_(can_tear), last_(bodies.size()) {
  for (const RecordedBody& body : bodies) first_nodes_.push_back(body.num_nodes);
}

bool TopologyWriter::is_new(const SceneState& state, std::size_t cloth) const {
  const auto& topology = state.cloths[cloth].topology;
  return cloth < last_.size() && topology &&
         topology != last_[cloth];  // more: the codec refuses it
}

int TopologyWriter::num_nodes(const ClothState& cloth, std::size_t body) const {
  return first_nodes_[body] + static_cast<int>(cloth.topology->origins.size());
}

void TopologyWriter::check(const ClothState& cloth, std::size_t body) const {
  if (!can_tear_) {
    throw InvalidArgument(fmt::format(
        "add_frame: cloth '{}' is torn, expected a scene in which a cloth can tear", cloth.name));
  }
  const int expected = num_nodes(cloth, body);
  const auto before = last_[body] ? last_[body]->origins.size() : 0;
  if (cloth.positions.cols() != expected || cloth.topology->origins.size() <= before) {
    throw InvalidArgument(fmt::format(
        "add_frame: cloth '{}' has {} nodes, expected {} as its topology, more than before",
        cloth.name, cloth.positions.cols(), expected));
  }
  try {
    (void)decode_topology(encode_topology(*cloth.topology), first_nodes_[body], expected);
  } catch (const Error& error) {
    throw InvalidArgument(fmt::format("add_frame: cloth '{}': {}", cloth.name, error.what()));
  }
}

void TopologyWriter::prepare(const SceneState& state, FrameCodec& codec) const {
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    if (c < last_.size() && last_[c] && !state.cloths[c].topology) {
      throw InvalidArgument(
          fmt::format("add_frame: cloth '{}' is whole, expected the torn one of the frame before",
                      state.cloths[c].name));
    }
    if (!is_new(state, c)) continue;
    check(state.cloths[c], c);
    codec.set_num_nodes(c, num_nodes(state.cloths[c], c));
  }
}

void TopologyWriter::take(const SceneState& state, std::int64_t frame, ContentHash& hash) {
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    if (!is_new(state, c)) continue;
    const ClothState& cloth = state.cloths[c];
    pending_.push_back({frame, c, num_nodes(cloth, c), encode_topology(*cloth.topology)});
    hash.add_topology(static_cast<int>(c), pending_.back().bytes);
    last_[c] = cloth.topology;
  }
}

void TopologyWriter::write(Database& database) {
  for (const Pending& row : pending_) {
    const std::vector<std::byte> data = compress_chunk(row.bytes, sizeof(std::uint32_t));
    StreamHash hash;
    hash.add(data);
    const std::string hex = hash.hex();
    const std::int64_t values[] = {num_rows_++, row.first_frame,
                                   static_cast<std::int64_t>(row.body), row.nodes,
                                   static_cast<std::int64_t>(row.bytes.size())};
    Statement insert = database.prepare("INSERT INTO topology VALUES (?, ?, ?, ?, ?, ?, ?)");
    int parameter = 1;
    for (const std::int64_t value : values) {
      insert.bind(parameter++, value);
      hash_.add(value);
    }
    hash_.add(std::string_view(hex));
    insert.bind(6, std::string_view(hex)).bind(7, std::span<const std::byte>(data)).run();
  }
  pending_.clear();
}

}  // namespace weft::scenes
