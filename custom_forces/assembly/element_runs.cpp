#include <weft/custom_forces/assembly/element_runs.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace weft::forces {
namespace {

/// Shorter runs are not worth loops of their own.
constexpr int kShortestRun = 8;

}  // namespace

template <int kNodes>
ElementRuns<kNodes>::ElementRuns(Elements elements, int num_nodes, int grain)
    : elements_(std::move(elements)), chunks_(elements_, num_nodes, grain) {
  for (std::vector<int>& slots : slots_) slots.resize(static_cast<std::size_t>(elements_.cols()));
  first_run_.push_back(0);
  for (const ElementChunks::Chunk& chunk : chunks_.chunks()) {
    std::vector<Eigen::Index> places(static_cast<std::size_t>(chunk.end - chunk.begin));
    std::iota(places.begin(), places.end(), chunk.begin);
    const auto& slots = chunks_.slots();
    const auto key = [&](Eigen::Index place) {
      std::array<int, kNodes> numbers;
      for (int corner = 1; corner < kNodes; ++corner) {
        numbers[static_cast<std::size_t>(corner - 1)] = slots(corner, place) - slots(0, place);
      }
      numbers.back() = slots(0, place);
      return numbers;
    };
    std::stable_sort(places.begin(), places.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return key(a) < key(b); });
    chunks_.reorder(chunk, places);
    for (Eigen::Index place = chunk.begin; place < chunk.end; ++place) {
      for (std::size_t corner = 0; corner < kNodes; ++corner) {
        slots_[corner][static_cast<std::size_t>(place)] =
            slots(static_cast<Eigen::Index>(corner), place) - static_cast<int>(chunk.first_slot);
      }
    }
    append_runs(static_cast<int>(chunk.begin), static_cast<int>(chunk.end));
    first_run_.push_back(runs_.size());
  }
}

/// Cuts places [begin, end) into runs.
template <int kNodes>
void ElementRuns<kNodes>::append_runs(int begin, int end) {
  const auto follows = [&](int next, int place) {
    return std::all_of(slots_.begin(), slots_.end(), [&](const std::vector<int>& slots) {
      return slots[static_cast<std::size_t>(next)] ==
             slots[static_cast<std::size_t>(place)] + (next - place);
    });
  };
  int place = begin;
  while (place < end) {
    int next = place + 1;
    while (next < end && next - place < kElementBatch && follows(next, place)) ++next;
    if (next - place >= kShortestRun) {
      runs_.push_back({place, next - place, true});
    } else if (runs_.empty() || runs_.back().is_consecutive || runs_.back().begin < begin ||
               runs_.back().count + (next - place) > kElementBatch) {
      runs_.push_back({place, next - place, false});
    } else {
      runs_.back().count += next - place;
    }
    place = next;
  }
}

template <int kNodes>
ElementRunsView<kNodes> ElementRuns<kNodes>::view(const ElementChunks::Chunk& chunk) const {
  const auto c = static_cast<std::size_t>(&chunk - chunks_.chunks().data());
  ElementRunsView<kNodes> runs;
  runs.begin = runs_.data() + first_run_[c];
  runs.end = runs_.data() + first_run_[c + 1];
  for (std::size_t corner = 0; corner < kNodes; ++corner)
    runs.slots[corner] = slots_[corner].data();
  runs.num_slots = chunk.num_slots();
  return runs;
}

template class ElementRuns<2>;
template class ElementRuns<3>;
template class ElementRuns<4>;

}  // namespace weft::forces
