#pragma once

// Tested by tests/fast_solver/prepared_solvers_test.cpp.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include <weft/fast_solver/implicit_solver.hpp>

namespace weft::fast {

/// Solvers for bodies that may be alike: equal springs to the precision of the solver, masses and pins. Coarse functions,
/// layout and the structure of the factor are then found once, and a copy costs a tenth. The second body of a kind leaves a solver
/// behind for those that follow; a body that is like no other costs no memory here. The bits are those of a solver of one's own.
/// Threads  any may call make().
template <class Scalar>
class PreparedSolvers {
 public:
  using Solver = ImplicitSolver<Scalar>;

  /// A new solver, with arguments and errors as its constructor.
  [[nodiscard]] std::unique_ptr<Solver> make(const SpringNetwork& network,
                                             const VectorX<double>& masses,
                                             const std::vector<bool>& is_free);
  /// How many of them were copies.
  [[nodiscard]] int num_shared() const { return num_shared_; }

 private:
  /// All that a new solver depends on.
  struct Kind {
    SpringNetwork network;  ///< rest lengths as rounded
    VectorX<Scalar> masses;
    std::vector<bool> is_free;

    [[nodiscard]] bool operator==(const Kind& other) const;
    [[nodiscard]] std::uint64_t hash() const;
  };
  struct Prepared {
    std::uint64_t hash = 0;
    std::shared_ptr<const Kind> kind;  ///< none: of which there has been one body
    std::shared_ptr<const Solver> solver;
  };
  /// The kinds that are kept, those of the last bodies: another kind costs its set-up once more.
  static constexpr std::size_t kMostKinds = 16;

  [[nodiscard]] Prepared find(std::uint64_t hash);
  void leave(const Prepared& prepared);

  std::atomic<int> num_shared_ = 0;
  std::mutex mutex_;
  std::vector<Prepared> list_;  ///< the last one was asked for last
};

extern template class PreparedSolvers<float>;
extern template class PreparedSolvers<double>;

}  // namespace weft::fast
