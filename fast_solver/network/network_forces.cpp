#include <weft/fast_solver/network/network_forces.hpp>

#include <weft/core/index.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace weft::fast {
namespace {

/// Memory for more slots than there are, over theirs: nothing is touched until blocks grow.
constexpr double kRoom = 2.0;
/// Slots that a block which has grown may grow by again.
constexpr int kSpareSlots = 6;
/// Half precision ends a little below 2^16.
constexpr int kMostHalfExponent = 14;

/// By first, then by second node, and the lane of the first before that of the second.
std::uint64_t place_of(const EdgeLane& lane) {
  const auto low = static_cast<std::uint64_t>(std::min(lane.node, lane.other));
  const auto high = static_cast<std::uint64_t>(std::max(lane.node, lane.other));
  return low << 32U | high << 1U | (lane.node > lane.other ? 1U : 0U);
}

}  // namespace

template <class Scalar>
void NetworkForces<Scalar>::reserve(std::size_t num_slots) {
  const std::size_t num_lanes = num_slots * kNodeBlock;
  EdgeSlots& slots = slots_.change();
  slots.slots.reserve(num_slots);
  for (std::vector<int>* lanes : {&slots.others, &slots.edges}) lanes->reserve(num_lanes);
  springs_.change().reserve(3 * num_lanes);
  if (has_damping_) {
    damping_.reserve(num_lanes);
    dampers_.reserve(2 * num_lanes);
  }
  if (has_bending_) bending_.reserve(num_lanes);
  linear_.reserve(4 * num_lanes);
}

template <class Scalar>
NetworkForces<Scalar>::NetworkForces(const SpringNetwork& network, int num_nodes)
    : slots_(make_edge_slots(network.edges, num_nodes)) {
  has_damping_ = (network.damping.array() != 0).any();
  has_bending_ = (network.bending.array() != 0).any();
  note_stiffest(network);
  reserve(static_cast<std::size_t>(kRoom * slots_->num_slots()));
  resize_arrays();
  for (std::size_t place = 0; place < slots_->edges.size(); ++place) {
    const int e = slots_->edges[place];
    if (e < 0) continue;
    write(place, {0,
                  {},
                  static_cast<Scalar>(network.rest_lengths[e]),
                  static_cast<Scalar>(network.stiffness[e]),
                  static_cast<Scalar>(network.compressed_stiffness[e] - network.stiffness[e]),
                  static_cast<Scalar>(network.damping[e]),
                  static_cast<float>(network.bending[e])});
  }
  for (const SlotRange& range : slots_->blocks) room_.push_back(range.end - range.begin);
}

template <class Scalar>
void NetworkForces<Scalar>::note_stiffest(const SpringNetwork& springs) {
  if (springs.edges.cols() == 0) return;
  const double most = springs.stiffness.cwiseMax(springs.compressed_stiffness).maxCoeff();
  stiffest_ = std::max(stiffest_, most + springs.bending.maxCoeff());
  most_damped_ = std::max(most_damped_, springs.damping.maxCoeff());
}

/// A power of two, so that no number of a linearization is too large for half precision, and few are too small.
template <class Scalar>
void NetworkForces<Scalar>::choose_scale(double time_step) {
  const double most = stiffest_ + most_damped_ / time_step;
  root_scale_ = 1;
  if (most > 0 && std::isfinite(most)) {
    root_scale_ = std::ldexp(1.0F, (kMostHalfExponent - std::ilogb(most)) >> 1);
  }
}

/// Gives arrays the lanes that slots_ has: new ones are empty.
template <class Scalar>
void NetworkForces<Scalar>::resize_arrays() {
  const std::size_t block = kNodeBlock;
  const std::size_t num_lanes = slots_->edges.size();
  AlignedVector<Scalar>& springs = springs_.change();
  const std::size_t num_before = springs.size() / 3;
  springs.resize(3 * num_lanes, Scalar(0));
  for (std::size_t place = num_before; place < num_lanes; ++place) {
    springs[place / block * 3 * block + place % block] = Scalar(1);
  }
  if (has_damping_) {
    damping_.resize(num_lanes, Scalar(0));
    dampers_.resize(2 * num_lanes, Scalar(0));
  }
  if (has_bending_) bending_.resize(num_lanes, 0.0F);
  linear_.resize(4 * num_lanes, 0);
  const int num_rows = rows_for(num_nodes());
  if (diagonal_.rows() != num_rows) diagonal_.setZero(num_rows, 6);
}

template <class Scalar>
void NetworkForces<Scalar>::write(std::size_t place, const Spring& values) {
  const std::size_t block = kNodeBlock;
  Scalar* const spring = springs_.change().data() + place / block * 3 * block + place % block;
  spring[0] = values.rest_length, spring[block] = values.stiffness;
  spring[2 * block] = values.compressed;
  if (has_damping_) damping_[place] = values.damping;
  if (has_bending_) bending_[place] = values.bending;
}

template <class Scalar>
void NetworkForces<Scalar>::set_rest_length(int first, int second, double rest_length) {
  const std::size_t block = kNodeBlock;
  for (const auto& [node, other] : {std::pair(first, second), std::pair(second, first)}) {
    const SlotRange& range = slots_->blocks[at(node / kNodeBlock)];
    for (int slot = range.begin; slot < range.end; ++slot) {
      const std::size_t place = at(slot) * block + at(node % kNodeBlock);
      if (slots_->edges[place] < 0 || slots_->others[place] != other) continue;
      springs_.change()[place / block * 3 * block + place % block] = Scalar(rest_length);
    }
  }
}

template <class Scalar>
std::vector<char> NetworkForces<Scalar>::replace(const SpringNetwork& springs,
                                                 const std::vector<char>& is_changed,
                                                 int num_nodes) {
  has_damping_ = has_damping_ || (springs.damping.array() != 0).any();
  has_bending_ = has_bending_ || (springs.bending.array() != 0).any();
  note_stiffest(springs);
  std::vector<char> blocks = blocks_to_change(springs, is_changed);
  std::vector<std::vector<Spring>> of_block(blocks.size());
  for (int block = 0; block < slots_->num_blocks(); ++block) {
    if (blocks[at(block)] != 0) keep_springs(block, is_changed, of_block[at(block)]);
  }
  for (int e = 0; e < static_cast<int>(springs.edges.cols()); ++e) {
    Spring spring{0,
                  {},
                  static_cast<Scalar>(springs.rest_lengths[e]),
                  static_cast<Scalar>(springs.stiffness[e]),
                  static_cast<Scalar>(springs.compressed_stiffness[e] - springs.stiffness[e]),
                  static_cast<Scalar>(springs.damping[e]),
                  static_cast<float>(springs.bending[e])};
    for (int end = 0; end < 2; ++end) {
      spring.lane = {springs.edges(end, e), springs.edges(1 - end, e), 0};
      spring.place = place_of(spring.lane);
      const int block = spring.lane.node / kNodeBlock;
      if (blocks[at(block)] != 0) of_block[at(block)].push_back(spring);
    }
  }
  EdgeSlots& slots = slots_.change();
  slots.num_nodes = num_nodes;
  const int end = slots.num_slots();
  slots.blocks.resize(blocks.size(), SlotRange{end, end, end});
  room_.resize(blocks.size(), 0);
  for (int block = 0; block < static_cast<int>(blocks.size()); ++block) {
    if (blocks[at(block)] != 0) lay_out(block, of_block[at(block)]);
  }
  resize_arrays();
  return blocks;
}

/// Flags, of the new number of blocks.
template <class Scalar>
std::vector<char> NetworkForces<Scalar>::blocks_to_change(
    const SpringNetwork& springs, const std::vector<char>& is_changed) const {
  std::vector<char> blocks(at(padded_size(static_cast<int>(is_changed.size())) / kNodeBlock), 0);
  for (std::size_t node = 0; node < is_changed.size(); ++node) {
    if (is_changed[node] != 0) blocks[node / kNodeBlock] = 1;
  }
  if (!has_bending_) return blocks;
  const std::vector<char> changed = blocks;
  for (const int node : springs.edges.reshaped()) blocks[at(node / kNodeBlock)] = 1;
  for (int block = 0; block < slots_->num_blocks();
       ++block) {  // neighbors that may be none any more
    if (changed[at(block)] == 0) continue;
    const SlotRange& range = slots_->blocks[at(block)];
    for (int place = range.begin * kNodeBlock; place < range.end * kNodeBlock; ++place) {
      const int node = block * kNodeBlock + place % kNodeBlock;
      if (node >= num_nodes() || is_changed[at(node)] == 0) continue;
      blocks[at(slots_->others[at(place)] / kNodeBlock)] = 1;
    }
  }
  return blocks;
}

/// Those of a block's nodes of which no end is changed.
template <class Scalar>
void NetworkForces<Scalar>::keep_springs(int block, const std::vector<char>& is_changed,
                                         std::vector<Spring>& result) const {
  const SlotRange& range = slots_->blocks[at(block)];
  result.reserve(at((range.end - range.begin) * kNodeBlock));
  for (int slot = range.begin; slot < range.end; ++slot) {
    for (int lane = 0; lane < kNodeBlock; ++lane) {
      const int node = block * kNodeBlock + lane;
      const std::size_t place = at(slot * kNodeBlock + lane);
      const int other = slots_->others[place];
      if (node >= num_nodes() || slots_->edges[place] < 0) continue;
      if (is_changed[at(node)] != 0 || is_changed[at(other)] != 0) continue;
      const Scalar* const spring = springs_->data() + at(slot * 3 * kNodeBlock + lane);
      result.push_back({place_of({node, other, 0}),
                        {node, other, 0},
                        spring[0],
                        spring[kNodeBlock],
                        spring[2 * kNodeBlock],
                        damping_.empty() ? Scalar(0) : damping_[place],
                        bending_.empty() ? 0.0F : bending_[place]});
    }
  }
}

/// In the order of a network's edges, so that sums are those of a network made anew.
template <class Scalar>
void NetworkForces<Scalar>::lay_out(int block, std::vector<Spring>& springs) {
  std::sort(springs.begin(), springs.end(),
            [](const Spring& a, const Spring& b) { return a.place < b.place; });
  std::vector<EdgeLane> lanes;
  lanes.reserve(springs.size());
  for (const Spring& spring : springs) {
    lanes.push_back({spring.lane.node, spring.lane.other, static_cast<int>(lanes.size())});
  }
  EdgeSlots laid_out;
  laid_out.num_nodes = num_nodes();
  maker_.append(block, lanes, laid_out);
  EdgeSlots& slots = slots_.change();
  SlotRange& range = slots.blocks[at(block)];
  const int num_slots = laid_out.num_slots();
  if (num_slots > room_[at(block)]) {  // to the end, with room to grow
    range.begin = slots.num_slots();
    room_[at(block)] = num_slots + kSpareSlots;
    slots.slots.resize(at(range.begin + room_[at(block)]), EdgeSlot{0, true});
    slots.others.resize(slots.slots.size() * kNodeBlock, 0);
    slots.edges.resize(slots.others.size(), -1);
    resize_arrays();
  }
  range.rows_end = range.begin + laid_out.blocks[0].rows_end;
  range.end = range.begin + num_slots;
  const std::size_t first = at(range.begin) * kNodeBlock;
  std::copy(laid_out.slots.begin(), laid_out.slots.end(), slots.slots.begin() + range.begin);
  for (std::size_t lane = 0; lane < laid_out.edges.size(); ++lane) {
    const int e = laid_out.edges[lane];
    slots.others[first + lane] = laid_out.others[lane];
    slots.edges[first + lane] = e < 0 ? -1 : 0;
    write(first + lane, e < 0 ? Spring{0, {}, 1, 0, 0, 0, 0} : springs[at(e)]);
  }
}

template <class Scalar>
double NetworkForces<Scalar>::unused_share() const {
  int used = 0;
  for (const SlotRange& range : slots_->blocks) used += range.end - range.begin;
  return slots_->num_slots() > 0 ? 1.0 - static_cast<double>(used) / slots_->num_slots() : 0.0;
}

template <class Scalar>
NetworkView<Scalar> NetworkForces<Scalar>::view() const {
  return {slots_->blocks.data(),
          slots_->slots.data(),
          slots_->others.data(),
          static_cast<int>(diagonal_.rows()),
          springs_->data(),
          dampers_.empty() ? nullptr : dampers_.data(),
          bending_.empty() || is_bending_out_ ? nullptr : bending_.data(),
          least_transverse_,
          root_scale_,
          linear_.data()};
}

template <class Scalar>
void NetworkForces<Scalar>::set_time_step(Scalar time_step) {
  time_step_ = time_step;
  choose_scale(static_cast<double>(time_step));
}

template <class Scalar>
void NetworkForces<Scalar>::begin_step(NodeRange nodes, const NodeArrays<Scalar>& starts) {
  if (!has_damping_) return;
  network_kernel<Scalar>().note_lengths(view(), nodes, starts.data(), damping_.data(), time_step_,
                                        dampers_.data());
}

template <class Scalar>
void NetworkForces<Scalar>::add_forces(NodeRange nodes, const NodeArrays<Scalar>& positions,
                                       NodeArrays<Scalar>& forces, bool linearizes) {
  network_kernel<Scalar>().forces(view(), nodes, positions.data(), forces.data(),
                                  linearizes ? diagonal_.data() : nullptr);
}

template <class Scalar>
double NetworkForces<Scalar>::potential(NodeRange nodes,
                                        const NodeArrays<Scalar>& positions) const {
  return network_kernel<Scalar>().energy(view(), nodes, positions.data());
}

template <class Scalar>
void NetworkForces<Scalar>::note_bending(CoarseCorrection& correction) const {
  if (!has_bending_) return;
  correction.set_bending(
      *slots_, [this](std::size_t place) { return static_cast<double>(bending_[place]); });
}

template <class Scalar>
void NetworkForces<Scalar>::multiply(NodeRange nodes, const VectorX<float>& inertia,
                                     const NodeArrays<float>& displacements,
                                     NodeArrays<float>& product) const {
  network_kernel<Scalar>().multiply(view(), nodes, inertia.data(), displacements.data(),
                                    product.data());
  // A NaN must not stay in the padding behind the nodes.
  const int num_beyond = nodes.end - std::max(nodes.begin, num_nodes());
  if (num_beyond > 0) product.middleRows(nodes.end - num_beyond, num_beyond).setZero();
}

template class NetworkForces<float>;
template class NetworkForces<double>;

}  // namespace weft::fast
