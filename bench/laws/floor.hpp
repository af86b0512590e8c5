#pragma once

#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

#include "bench/laws/floor_kernel.hpp"

namespace weft::bench {

/// The springs of a mesh for the floor kernels, evaluated on one or two threads.
template <class Scalar>
class Floor {
 public:
  enum class Order {
    kGrid,      ///< as the mesh lists them
    kDiagonal,  ///< by the distance of their node numbers, then by the first node
  };
  Floor(const ClothMesh& mesh, Order order);
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  [[nodiscard]] int num_springs() const { return static_cast<int>(first_.size()); }
  /// The arithmetic alone.
  void evaluate(int num_threads);
  /// From the nodes' positions to the nodes' forces, which start at zero.
  void evaluate_between_nodes(int num_threads);
  /// Likewise with whole vectors loaded and stored; in diagonal order only.
  void evaluate_in_runs(int num_threads);
  /// 3 x num_nodes, component by component [N].
  [[nodiscard]] const std::vector<Scalar>& node_forces() const { return node_forces_; }

 private:
  [[nodiscard]] FloorArrays<Scalar> arrays();
  /// Both halves of something, each with its own sums, on one or two threads.
  template <class Part>
  void add_up(int num_threads, int num_items, const Part& part);

  int num_nodes_;
  std::vector<int> first_, second_, run_begins_;
  std::vector<Scalar> rest_lengths_, differences_, spring_forces_, positions_;
  std::vector<Scalar> node_forces_, other_node_forces_;
};

}  // namespace weft::bench
