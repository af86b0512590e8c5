#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>
#include <Eigen/LU>

#include <weft/fast_solver/network/node_arrays.hpp>
#include <weft/fast_solver/network/spring_network.hpp>

namespace weft::fast {

/// Anderson acceleration of a fixed-point iteration x -> g(x) (Anderson 1965; type II as in Walker and Ni 2011; for simulation
/// Peng et al. 2018). It combines the last results so that the combined step g(x) - x is shortest. Newton's method needs it
/// here because the linearization omits negative stiffness, so that plain iterations converge only linearly.
///
/// Steps are single precision, which suffices because they are small compared with positions. Node ranges may be added by any
/// thread.
template <class Scalar>
class AndersonHistory {
 public:
  static constexpr int kMemory = 2;
  using Nodes = NodeArrays<Scalar>;
  using Floats = NodeArrays<float>;
  /// The products of the changes of steps with each other, and those with the present step.
  using Products = Eigen::Matrix<double, kMemory, kMemory + 1>;
  using Weights = Eigen::Matrix<double, kMemory, 1>;

  void resize(Eigen::Index rows) {
    last_step_.setZero(rows, 3);
    for (int k = 0; k < kMemory; ++k) {
      step_changes_[index(k)].setZero(rows, 3);
      result_changes_[index(k)].setZero(rows, 3);
    }
  }
  /// Restarts the acceleration, with the first slot: nothing that slots hold from before is read again.
  void forget() {
    has_last_ = false;
    count_ = 0;
    newest_ = kMemory - 1;
  }
  /// Slots that have something, after next().
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int newest() const { return newest_; }
  [[nodiscard]] bool has_last() const { return has_last_; }

  /// A further iteration is to be added: to add() for all parts.
  void next() {
    if (!has_last_) return;
    newest_ = (newest_ + 1) % kMemory;
    count_ = std::min(count_ + 1, kMemory);
  }
  /// before: x, after: g(x), last_result: g of the iteration before.
  Products add(NodeRange nodes, const Nodes& before, const Nodes& after, const Nodes& last_result) {
    const int size = nodes.end - nodes.begin;
    const auto of = [&](auto& array) { return array.middleRows(nodes.begin, size); };
    Products products = Products::Zero();
    Floats& step_change = step_changes_[index(newest_)];
    if (has_last_) {
      of(step_change) = (of(after) - of(before)).template cast<float>() - of(last_step_);
      of(result_changes_[index(newest_)]) = (of(after) - of(last_result)).template cast<float>();
    }
    of(last_step_) = (of(after) - of(before)).template cast<float>();
    for (int a = 0; a < count_; ++a) {
      for (int b = 0; b <= a; ++b) {
        const double product = dot(nodes, step_changes_[index(a)], step_changes_[index(b)]);
        products(a, b) = product;
        products(b, a) = product;
      }
      products(a, kMemory) = dot(nodes, step_changes_[index(a)], last_step_);
    }
    return products;
  }
  void added() { has_last_ = true; }
  /// The least-squares coefficient of each change of results.
  [[nodiscard]] Weights weights(const Products& products) const {
    constexpr double kRegularization = 1e-8;
    Eigen::Matrix<double, kMemory, kMemory> system = products.template leftCols<kMemory>();
    for (int k = 0; k < kMemory; ++k) {
      system(k, k) = k < count_ ? (1 + kRegularization) * system(k, k) : 1;
      if (!(system(k, k) > 0)) return Weights::Zero();
    }
    const Weights result = system.partialPivLu().solve(products.col(kMemory));
    return result.allFinite() ? result : Weights(Weights::Zero());
  }
  /// positions -= what the weights say.
  void combine(NodeRange nodes, const Weights& weights, Nodes& positions) const {
    const int size = nodes.end - nodes.begin;
    for (int k = 0; k < count_; ++k) {
      positions.middleRows(nodes.begin, size) -=
          static_cast<Scalar>(weights[k]) *
          result_changes_[index(k)].middleRows(nodes.begin, size).template cast<Scalar>();
    }
  }

 private:
  static constexpr std::size_t index(int k) { return static_cast<std::size_t>(k); }
  [[nodiscard]] static double dot(NodeRange nodes, const Floats& a, const Floats& b) {
    const int size = nodes.end - nodes.begin;
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      sum += static_cast<double>(
          a.col(axis).segment(nodes.begin, size).dot(b.col(axis).segment(nodes.begin, size)));
    }
    return sum;
  }

  bool has_last_ = false;
  int count_ = 0;
  int newest_ = kMemory - 1;
  Floats last_step_;
  std::array<Floats, kMemory> step_changes_, result_changes_;
};

}  // namespace weft::fast
