#pragma once

#include <memory>
#include <vector>

#include <weft/fast_solver/coarse_nodes.hpp>
#include <weft/fast_solver/dense_inverse.hpp>
#include <weft/fast_solver/elimination.hpp>
#include <weft/fast_solver/global_correction.hpp>
#include <weft/fast_solver/spring_network.hpp>

namespace weft::fast {

/// Makes a GlobalCorrection in parts of about the same time, so that it can be spread over the frames of a
/// world that must not stall: some twenty parts, of up to a millisecond each for ten thousand nodes. What it
/// makes does not depend on what is done between them.
class CorrectionMaker {
 public:
  /// As GlobalCorrection's.
  CorrectionMaker(SymmetricMatrix matrix, std::vector<int> names, int num_nodes);
  CorrectionMaker(const CorrectionMaker&) = delete;  // its parts point to each other
  CorrectionMaker& operator=(const CorrectionMaker&) = delete;
  CorrectionMaker(CorrectionMaker&&) = delete;
  CorrectionMaker& operator=(CorrectionMaker&&) = delete;
  ~CorrectionMaker() = default;

  /// The next part. True if it was the last. Throws InvalidArgument as GlobalCorrection.
  bool advance();
  /// After the last part.
  [[nodiscard]] GlobalCorrection take();

 private:
  enum class Part { kInterpolation, kRows, kElimination, kFactor, kInverse, kSums, kDone };
  void begin_level();
  void end_level();
  void make_sums();

  SymmetricMatrix matrix_;  ///< of the present level
  std::vector<int> names_;
  int num_nodes_;
  int num_unknowns_;
  Part part_ = Part::kInterpolation;
  Interpolation total_;  ///< from the unknowns to those of the present level
  Interpolation next_;
  std::unique_ptr<CoarseMatrixMaker> rows_;
  std::vector<int> order_;
  Elimination elimination_;
  GlobalCorrection result_;
  std::unique_ptr<DenseInverseMaker> inverse_;  ///< of result_'s factor
};

/// The matrix of a network whose springs resist as much across as along, over the nodes names, ascending.
/// network: by first, then by second node. masses: n [kg]; inertia_step [s].
[[nodiscard]] SymmetricMatrix isotropic_matrix(const ChangedNetwork& network,
                                               const VectorX<double>& masses,
                                               const std::vector<int>& names, double inertia_step);

}  // namespace weft::fast
