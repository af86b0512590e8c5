#include <weft/playback/exchange/gltf/tracked_nodes.hpp>

#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <weft/playback/exchange/unfit_recording.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace weft::scenes {

TrackedNodes::TrackedNodes(ClothMesh whole, std::shared_ptr<const ClothTopology> last)
    : whole_(std::move(whole)), mesh_(drawn_mesh(whole_, last.get())), topology_(std::move(last)) {
  nodes_.resize(static_cast<std::size_t>(mesh_.num_nodes()));
  std::iota(nodes_.begin(), nodes_.end(), 0);
}

const Triangles& TrackedNodes::triangles(const ClothState& cloth) const {
  return cloth.topology ? cloth.topology->triangles : whole_.triangles;
}

const std::vector<int>& TrackedNodes::nodes(const ClothState& cloth) {
  if (cloth.topology == topology_) return nodes_;
  const Triangles& now = triangles(cloth);
  std::vector<int> found(nodes_.size(), -1);
  bool fits = now.cols() == mesh_.triangles.cols();
  for (Eigen::Index k = 0; fits && k < now.size(); ++k) {
    int& node = found[static_cast<std::size_t>(mesh_.triangles(k))];
    fits = (node < 0 || node == now(k)) && now(k) >= 0 && now(k) < cloth.positions.cols();
    node = now(k);
  }
  if (!fits) {
    throw UnfitRecording(
        fmt::format("cloth '{}' has nodes that are one in the last frame and several before, "
                    "expected tears that stay open",
                    cloth.name));
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_of_this_state = static_cast<Eigen::Index>(i) < cloth.positions.cols();
    if (found[i] < 0) found[i] = is_of_this_state ? static_cast<int>(i) : 0;
  }
  nodes_ = std::move(found);
  topology_ = cloth.topology;
  return nodes_;
}

}  // namespace weft::scenes
