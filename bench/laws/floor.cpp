#include "bench/laws/floor.hpp"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

namespace weft::bench {

template <class Scalar>
Floor<Scalar>::Floor(const ClothMesh& mesh, Order order) : num_nodes_(mesh.num_nodes()) {
  std::vector<std::pair<int, int>> springs;
  for (const EdgeSet& set : mesh.edge_sets) {
    for (const auto edge : set.edges.colwise()) springs.emplace_back(edge[0], edge[1]);
  }
  if (order == Order::kDiagonal) {
    std::sort(springs.begin(), springs.end(), [](const auto& a, const auto& b) {
      return std::pair(a.second - a.first, a.first) < std::pair(b.second - b.first, b.first);
    });
  }
  const std::size_t n = springs.size();
  const auto num_nodes = static_cast<std::size_t>(num_nodes_);
  const double stretch = 1.01;
  differences_.resize(3 * n);
  spring_forces_.resize(3 * n);
  positions_.resize(3 * num_nodes);
  node_forces_.resize(3 * num_nodes);
  other_node_forces_.resize(3 * num_nodes);
  for (std::size_t s = 0; s < n; ++s) {
    const auto [i, j] = springs[s];
    first_.push_back(i);
    second_.push_back(j);
    const Vector3<double> d = mesh.rest_positions.col(j) - mesh.rest_positions.col(i);
    rest_lengths_.push_back(static_cast<Scalar>(d.norm()));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      differences_[axis * n + s] =
          static_cast<Scalar>(stretch * d[static_cast<Eigen::Index>(axis)]);
    }
  }
  for (std::size_t s = 0; s < n; ++s) {
    const bool follows =
        s > 0 && first_[s] == first_[s - 1] + 1 && second_[s] == second_[s - 1] + 1;
    if (!follows) run_begins_.push_back(static_cast<int>(s));
  }
  run_begins_.push_back(static_cast<int>(n));
  for (std::size_t node = 0; node < num_nodes; ++node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      positions_[axis * num_nodes + node] =
          static_cast<Scalar>(stretch * mesh.rest_positions(static_cast<Eigen::Index>(axis),
                                                            static_cast<Eigen::Index>(node)));
    }
  }
}

template <class Scalar>
FloorArrays<Scalar> Floor<Scalar>::arrays() {
  return {.num_springs = num_springs(),
          .num_nodes = num_nodes_,
          .stiffness = Scalar(1),
          .rest_lengths = rest_lengths_.data(),
          .differences = differences_.data(),
          .spring_forces = spring_forces_.data(),
          .first = first_.data(),
          .second = second_.data(),
          .positions = positions_.data(),
          .run_begins = run_begins_.data(),
          .num_runs = static_cast<int>(run_begins_.size()) - 1,
          .node_forces = node_forces_.data()};
}

template <class Scalar>
void Floor<Scalar>::evaluate(int num_threads) {
  const int half = num_springs() / 2;
  if (num_threads == 1) {
    evaluate_springs(arrays(), 0, num_springs());
    return;
  }
  tbb::parallel_for(0, 2, [&](int part) {
    evaluate_springs(arrays(), part * half, part == 0 ? half : num_springs());
  });
}

template <class Scalar>
template <class Part>
void Floor<Scalar>::add_up(int num_threads, int num_items, const Part& part) {
  const int half = num_items / 2;
  std::fill(node_forces_.begin(), node_forces_.end(), Scalar(0));
  if (num_threads == 1) {
    part(node_forces_.data(), 0, num_items);
    return;
  }
  tbb::parallel_for(0, 2, [&](int p) {
    std::vector<Scalar>& sums = p == 0 ? node_forces_ : other_node_forces_;
    if (p == 1) std::fill(sums.begin(), sums.end(), Scalar(0));
    part(sums.data(), p * half, p == 0 ? half : num_items);
  });
  for (std::size_t i = 0; i < node_forces_.size(); ++i) node_forces_[i] += other_node_forces_[i];
}

template <class Scalar>
void Floor<Scalar>::evaluate_between_nodes(int num_threads) {
  add_up(num_threads, num_springs(), [this](Scalar* sums, int begin, int end) {
    gather_evaluate_scatter(arrays(), sums, begin, end);
  });
}

template <class Scalar>
void Floor<Scalar>::evaluate_in_runs(int num_threads) {
  const FloorArrays<Scalar> a = arrays();
  add_up(num_threads, a.num_runs,
         [&a](Scalar* sums, int begin, int end) { evaluate_runs(a, sums, begin, end); });
}

template class Floor<float>;
template class Floor<double>;

}  // namespace weft::bench
