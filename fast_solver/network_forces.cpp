#include <weft/fast_solver/network_forces.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include <tbb/parallel_for.h>

namespace weft::fast {
namespace {

/// Blocks of nodes of a task at least: 1280 nodes, some 5 to 20 us. Tasks of one network are alike, so that
/// threads end together.
constexpr int kFewestBlocks = 75;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

template <class Scalar>
NetworkForces<Scalar>::NetworkForces(const SpringNetwork& network, int num_nodes)
    : slots_(make_edge_slots(network.edges, num_nodes)), edges_(network.edges) {
  const auto num_lanes = slots_.edges.size();
  const bool has_damping = (network.damping.array() != 0).any();
  const bool has_stabiliser = (network.stabiliser.array() != 0).any();
  springs_.resize(3 * num_lanes);
  if (has_damping) {
    damping_.assign(num_lanes, Scalar(0));
    dampers_.assign(2 * num_lanes, Scalar(0));
  }
  if (has_stabiliser) stabilisers_.assign(num_lanes, Scalar(0));
  for (std::size_t place = 0; place < num_lanes; ++place) {
    const std::size_t block = kNodeBlock;
    Scalar* const spring = springs_.data() + place / block * 3 * block + place % block;
    const int e = slots_.edges[place];
    spring[0] = e < 0 ? Scalar(1) : static_cast<Scalar>(network.rest_lengths[e]);
    if (e < 0) continue;
    spring[block] = static_cast<Scalar>(network.stiffness[e]);
    spring[2 * block] = static_cast<Scalar>(network.compressed_stiffness[e] - network.stiffness[e]);
    if (has_damping) damping_[place] = static_cast<Scalar>(network.damping[e]);
    if (has_stabiliser) stabilisers_[place] = static_cast<Scalar>(network.stabiliser[e]);
  }
  linear_.assign(4 * num_lanes, 0.0F);
  for (NodeArrays<Scalar>* arrays : {&starts_, &places_, &forces_}) {
    arrays->setZero(fill_up(num_nodes), 3);
  }
  diagonal_.setZero(fill_up(num_nodes), 6);
  task_sums_.resize(at(std::max(1, slots_.num_blocks() / kFewestBlocks)));
}

template <class Scalar>
NetworkView<Scalar> NetworkForces<Scalar>::view() const {
  return {slots_.blocks.data(),
          slots_.slots.data(),
          slots_.others.data(),
          static_cast<int>(places_.rows()),
          springs_.data(),
          dampers_.empty() ? nullptr : dampers_.data(),
          stabilisers_.empty() ? nullptr : stabilisers_.data(),
          least_across_,
          linear_.data()};
}

template <class Scalar>
template <class Run>
void NetworkForces<Scalar>::for_each_task(const Run& run) const {
  const auto num_tasks = static_cast<int>(task_sums_.size());
  const auto first_block = [&](int task) {
    return static_cast<int>(std::int64_t{slots_.num_blocks()} * task / num_tasks);
  };
  const auto run_task = [&](int task) { run(task, first_block(task), first_block(task + 1)); };
  if (num_tasks == 1) {
    run_task(0);
  } else {
    tbb::parallel_for(0, num_tasks, run_task);
  }
}

template <class Scalar>
void NetworkForces<Scalar>::begin_step(ConstMatrix3XRef<Scalar> starts, Scalar time_step) {
  to_arrays<Scalar>(starts, starts_);
  if (damping_.empty()) return;
  const std::size_t block = kNodeBlock;
  for (std::size_t place = 0; place < damping_.size(); ++place) {
    const int e = slots_.edges[place];
    if (e < 0) continue;
    Scalar* const damper = dampers_.data() + place / block * 2 * block + place % block;
    damper[0] = damping_[place] / time_step;
    damper[block] = (starts.col(edges_(1, e)) - starts.col(edges_(0, e))).norm();
  }
}

template <class Scalar>
void NetworkForces<Scalar>::add_forces(ConstMatrix3XRef<Scalar> places,
                                       Matrix3XRef<Scalar> forces) {
  to_arrays<Scalar>(places, places_);
  to_arrays<Scalar>(forces, forces_);
  for_each_task([&](int, int begin, int end) {
    network_kernel<Scalar>().forces(view(), begin, end, places_.data(), starts_.data(),
                                    forces_.data(), diagonal_.data());
  });
  for (int axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < forces.cols(); ++i) forces(axis, i) = forces_(i, axis);
  }
}

template <class Scalar>
double NetworkForces<Scalar>::potential(ConstMatrix3XRef<Scalar> places) {
  to_arrays<Scalar>(places, places_);
  for_each_task([&](int task, int begin, int end) {
    task_sums_[at(task)] =
        network_kernel<Scalar>().energy(view(), begin, end, places_.data(), starts_.data());
  });
  return std::accumulate(task_sums_.begin(), task_sums_.end(), 0.0);
}

template <class Scalar>
void NetworkForces<Scalar>::multiply(const VectorX<float>& inertia,
                                     const NodeArrays<float>& displacements,
                                     NodeArrays<float>& product) const {
  for_each_task([&](int, int begin, int end) {
    network_kernel<Scalar>().multiply(view(), begin, end, inertia.data(), displacements.data(),
                                      product.data());
  });
  // What is not a number must not get stuck behind the nodes.
  product.bottomRows(product.rows() - num_nodes()).setZero();
}

template class NetworkForces<float>;
template class NetworkForces<double>;

}  // namespace weft::fast
