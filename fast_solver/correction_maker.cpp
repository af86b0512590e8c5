#include <weft/fast_solver/correction_maker.hpp>

#include <algorithm>
#include <utility>

#include <weft/fast_solver/minimum_degree.hpp>
#include <weft/fast_solver/node_parts.hpp>

namespace weft::fast {
namespace {

/// Unknowns up to which the inverse takes their factor's place.
constexpr int kMostDense = 600;
/// Coarse unknowns up to which no coarser ones are looked for: so many, or this share of all. Every further level leaves
/// out more than one smoothing can do, but so few are solved for in a fraction of the time that the other parts of an
/// iteration take.
constexpr int kFewEnough = kMostDense;
constexpr double kSmallShare = 0.05;
/// The next coarser ones must be fewer by this to be worth it.
constexpr double kLeastGain = 0.7;

/// Parts that the rows of a coarse matrix are made in, and the columns of an inverse.
constexpr int kRowParts = 6;
constexpr int kInverseParts = 6;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

CorrectionMaker::CorrectionMaker(SymmetricMatrix matrix, std::vector<int> names, int num_nodes)
    : matrix_(std::move(matrix)),
      names_(std::move(names)),
      num_nodes_(num_nodes),
      num_unknowns_(matrix_.size()) {}

// The first level is always made.
void CorrectionMaker::begin_level() {
  const bool is_first = total_.starts.empty();
  const bool is_small = matrix_.size() <= std::max<double>(kFewEnough, kSmallShare * num_unknowns_);
  if (is_first || !is_small) {
    next_ = make_interpolation(matrix_);
    if (is_first || next_.num_coarse <= kLeastGain * matrix_.size()) {
      rows_ = std::make_unique<CoarseMatrixMaker>(matrix_, next_);
      part_ = Part::kRows;
      return;
    }
  }
  order_ = minimum_degree_order(matrix_);
  part_ = Part::kElimination;
}

void CorrectionMaker::end_level() {
  SymmetricMatrix coarse = rows_->take();
  rows_.reset();
  total_ = total_.starts.empty() ? std::move(next_) : composed(total_, next_);
  matrix_ = std::move(coarse);
  part_ = Part::kInterpolation;
}

bool CorrectionMaker::advance() {
  switch (part_) {
    case Part::kInterpolation:
      begin_level();
      break;
    case Part::kRows:
      if (rows_->add_rows(next_.num_coarse / kRowParts + 1)) end_level();
      break;
    case Part::kElimination:
      elimination_ = eliminate(matrix_, order_);
      part_ = Part::kFactor;
      break;
    case Part::kFactor:
      result_.factor_ = SparseCholesky(matrix_, std::move(elimination_));
      part_ = Part::kSums;
      if (matrix_.size() == 0 || matrix_.size() > kMostDense) break;
      inverse_ = std::make_unique<DenseInverseMaker>(matrix_, result_.factor_);
      part_ = Part::kInverse;
      break;
    case Part::kInverse:
      if (!inverse_->add_columns(matrix_.size() / kInverseParts + 1)) break;
      if (auto inverse = inverse_->take()) {
        result_.inverse_ = std::move(*inverse);
        result_.factor_ = SparseCholesky();
      }
      inverse_.reset();
      part_ = Part::kSums;
      break;
    case Part::kSums:
      make_sums();
      part_ = Part::kDone;
      break;
    case Part::kDone:
      break;
  }
  return part_ == Part::kDone;
}

void CorrectionMaker::make_sums() {
  const int num_coarse = matrix_.size();
  const int num_filled = std::max(num_coarse, result_.inverse_.filled_size());
  result_.size_ = num_coarse;
  result_.right_.setZero(3, num_coarse);
  result_.solution_.setZero(3, num_coarse);
  result_.coarse_.setZero(4, num_filled);
  result_.coarse_sums_.setZero(4, num_filled);
  result_.num_nodes_ = num_nodes_;
  result_.parts_ = NodeParts(num_nodes_);
  result_.nodes_.setZero(4, fill_up(num_nodes_));
  std::vector<WeightedSums::Row> of_coarse(at(num_coarse));
  std::vector<WeightedSums::Row> of_node(at(num_nodes_));
  for (int u = 0; u < static_cast<int>(names_.size()); ++u) {
    const int node = names_[at(u)];
    for (int e = total_.starts[at(u)]; e < total_.starts[at(u) + 1]; ++e) {
      const auto weight = static_cast<float>(total_.values[at(e)]);
      of_node[at(node)].emplace_back(total_.columns[at(e)], weight);
      of_coarse[at(total_.columns[at(e)])].emplace_back(node, weight);
    }
  }
  const int num_parts = result_.parts_.count();
  std::vector<int> node_ends;
  std::vector<int> coarse_ends;
  for (int part = 0; part < num_parts; ++part) {
    node_ends.push_back(std::min(result_.parts_[part].end, num_nodes_));
    coarse_ends.push_back(num_coarse * (part + 1) / num_parts);
  }
  result_.refine_ = WeightedSums(of_node, node_ends);
  result_.coarsen_ = WeightedSums(of_coarse, coarse_ends);
}

GlobalCorrection CorrectionMaker::take() {
  return std::move(result_);
}

SymmetricMatrix isotropic_matrix(const ChangedNetwork& network, const VectorX<double>& masses,
                                 const std::vector<int>& names, double inertia_step) {
  std::vector<int> unknown_of(at(static_cast<int>(masses.size())), -1);
  SymmetricMatrix matrix;
  for (const int node : names) {
    unknown_of[at(node)] = matrix.size();
    matrix.diagonal.push_back(masses[node] / (inertia_step * inertia_step));
  }
  const auto ends = [&](const SpringNetwork& of, Eigen::Index e) {
    return std::pair(unknown_of[at(of.edges(0, e))], unknown_of[at(of.edges(1, e))]);
  };
  matrix.starts.assign(names.size() + 1, 0);
  network.for_each([&](const SpringNetwork& of, Eigen::Index e) {
    const auto [a, b] = ends(of, e);
    if (a < 0 || b < 0) return;
    ++matrix.starts[at(a) + 1];
    ++matrix.starts[at(b) + 1];
  });
  for (std::size_t i = 0; i < names.size(); ++i) matrix.starts[i + 1] += matrix.starts[i];
  matrix.columns.resize(at(matrix.starts.back()));
  matrix.values.resize(matrix.columns.size());
  std::vector<int> next(matrix.starts.begin(), matrix.starts.end() - 1);
  const auto add = [&](int row, int column, double value) {
    const std::size_t place = at(next[at(row)]++);
    matrix.columns[place] = column;
    matrix.values[place] = value;
  };
  // Columns come in ascending order: of lower nodes before those that have the node as their first one.
  network.for_each([&](const SpringNetwork& of, Eigen::Index e) {
    const double weight = of.stiffness[e] + of.damping[e] / inertia_step + of.stabiliser[e];
    const auto [a, b] = ends(of, e);
    if (a >= 0) matrix.diagonal[at(a)] += weight;
    if (b >= 0) matrix.diagonal[at(b)] += weight;
    if (a < 0 || b < 0) return;
    add(a, b, -weight);
    add(b, a, -weight);
  });
  return matrix;
}

}  // namespace weft::fast
