#include <weft/custom_forces/assembly/edge_assembly.hpp>

#include <algorithm>
#include <numeric>

namespace weft::forces {
namespace {

/// Cuts places [begin, end) into runs. first and second: slots of each place.
void append_runs(int begin, int end, const std::vector<int>& first, const std::vector<int>& second,
                 std::vector<EdgeRun>& runs) {
  const auto at = [](const std::vector<int>& slots, int place) {
    return slots[static_cast<std::size_t>(place)];
  };
  int place = begin;
  while (place < end) {
    int next = place + 1;
    while (next < end && next - place < kEdgeBatch &&
           at(first, next) == at(first, place) + (next - place) &&
           at(second, next) == at(second, place) + (next - place)) {
      ++next;
    }
    if (next - place >= kShortestRun) {
      runs.push_back({place, next - place, true});
    } else if (runs.empty() || runs.back().is_consecutive || runs.back().begin < begin ||
               runs.back().count + (next - place) > kEdgeBatch) {
      runs.push_back({place, next - place, false});
    } else {
      runs.back().count += next - place;
    }
    place = next;
  }
}

}  // namespace

EdgeAssembly::EdgeAssembly(Edges edges, int num_nodes, int grain)
    : edges_(std::move(edges)),
      chunks_(edges_, num_nodes, grain),
      first_slots_(static_cast<std::size_t>(edges_.cols())),
      second_slots_(static_cast<std::size_t>(edges_.cols())) {
  first_run_.push_back(0);
  for (const ElementChunks::Chunk& chunk : chunks_.chunks()) {
    std::vector<Eigen::Index> places(static_cast<std::size_t>(chunk.end - chunk.begin));
    std::iota(places.begin(), places.end(), chunk.begin);
    const auto& slots = chunks_.slots();
    const auto diagonal = [&](Eigen::Index place) { return slots(1, place) - slots(0, place); };
    std::stable_sort(places.begin(), places.end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::pair(diagonal(a), slots(0, a)) < std::pair(diagonal(b), slots(0, b));
    });
    chunks_.reorder(chunk, places);
    for (Eigen::Index place = chunk.begin; place < chunk.end; ++place) {
      const auto p = static_cast<std::size_t>(place);
      first_slots_[p] = slots(0, place) - static_cast<int>(chunk.first_slot);
      second_slots_[p] = slots(1, place) - static_cast<int>(chunk.first_slot);
    }
    append_runs(static_cast<int>(chunk.begin), static_cast<int>(chunk.end), first_slots_,
                second_slots_, runs_);
    first_run_.push_back(runs_.size());
  }
}

}  // namespace weft::forces
