#include <weft/scenes/recording/codec/topology_codec.hpp>

#include <cstdint>

#include <weft/core/error.hpp>
#include <weft/scenes/recording/codec/little_endian.hpp>

namespace weft::scenes {
namespace {

constexpr std::size_t kIndexBytes = sizeof(std::uint32_t);

}  // namespace

std::vector<std::byte> encode_topology(const ClothTopology& topology) {
  const auto corners = static_cast<std::size_t>(topology.triangles.size());
  std::vector<std::byte> bytes(kIndexBytes * (corners + topology.origins.size()));
  std::byte* to = bytes.data();
  const auto put = [&](int node) {
    store_little_endian(static_cast<std::uint32_t>(node), to);
    to += kIndexBytes;
  };
  for (const int node : topology.triangles.reshaped()) put(node);
  for (const int node : topology.origins) put(node);
  return bytes;
}

ClothTopology decode_topology(std::span<const std::byte> bytes, int first_nodes, int num_nodes) {
  const auto num_origins = static_cast<std::size_t>(num_nodes - first_nodes);
  const std::size_t count = bytes.size() / kIndexBytes;
  if (num_nodes < first_nodes || bytes.size() % kIndexBytes != 0 || count < num_origins ||
      (count - num_origins) % 3 != 0) {
    throw Error("not the triangles of a torn cloth");
  }
  const std::byte* from = bytes.data();
  const auto get = [&](int limit) {
    const auto node = load_little_endian<std::uint32_t>(from);
    from += kIndexBytes;
    if (node >= static_cast<std::uint32_t>(limit)) throw Error("names a node that is not there");
    return static_cast<int>(node);
  };
  ClothTopology topology;
  topology.triangles.resize(3, static_cast<Eigen::Index>((count - num_origins) / 3));
  for (int& node : topology.triangles.reshaped()) node = get(num_nodes);
  for (std::size_t k = 0; k < num_origins; ++k) topology.origins.push_back(get(first_nodes));
  return topology;
}

}  // namespace weft::scenes
