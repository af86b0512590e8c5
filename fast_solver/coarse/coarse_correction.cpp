#include <weft/fast_solver/coarse/coarse_correction.hpp>

#include <weft/core/index.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

namespace weft::fast {
namespace {

/// There are at least so many coarse basis functions, or 2.5 sqrt(nodes). Then the cost of the factor grows slower than the network.
constexpr int kLeastBasis = 24;
constexpr double kBasisPerRoot = 2.5;
/// Coefficients of a spring below this share of its largest one are added to others [-].
constexpr float kLeastCoefficient = 0.1F;
/// A sum of coefficients below this share of the largest one is rounding [-].
constexpr float kLeastSum = 1e-5F;
/// A coupling below this share of the largest one of each of its two coarse basis functions is taken for none [-].
constexpr float kLeastCoupling = 0.003F;
/// A spring whose coefficients have at least this sum couples basis functions to fixed nodes. All such springs count.
constexpr float kLeastBound = 0.05F;
/// Springs of a coarse basis function that are enough to know the stiffness between it and its neighbors, about.
constexpr int kSpringsOfBasis = 60;
/// At least one spring in so many of a network is looked at: about one at each node.
constexpr double kMostForOne = 6;

float sum_of(const BasisWeights& of_node) {
  return of_node.weights[0] + of_node.weights[1] + of_node.weights[2];
}

/// Adds a number of a node to those of its basis functions, by its weights.
void add_lumped(AlignedVector<float>& sums, const BasisWeights& of_node, float number) {
  for (int k = 0; k < kMostWeights; ++k)
    sums[at(of_node.basis_functions[k])] += number * of_node.weights[k];
}

int basis_size_for(int num_unknowns) {
  return std::max(kLeastBasis, static_cast<int>(kBasisPerRoot * std::sqrt(num_unknowns)));
}

}  // namespace

CoarseCorrection::CoarseCorrection(const ConnectivityGraph& network, const EdgeSlots& slots)
    : num_nodes_(network.matrix.size()), parts_(num_nodes_), weights_(at(padded_size(num_nodes_))) {
  alone_.change().resize(weights_.size());
  aggregates_ = find_aggregates(network, basis_size_for(num_nodes_));
  num_basis_ = aggregates_.count;
  if (num_basis_ == 0) return;
  const Prolongation basis_functions =
      smoothed_aggregation(network, std::vector<bool>(at(num_nodes_), true), aggregates_);
  for (int node = 0; node < num_nodes_; ++node) set_basis_weights(node, basis_functions, node);
  const double of_basis = 0.5 * static_cast<double>(network.matrix.columns.size()) / num_basis_;
  springs_for_one_ = std::clamp(of_basis / kSpringsOfBasis, 1.0, kMostForOne);
  std::vector<int> node_ids(at(num_nodes_));
  std::iota(node_ids.begin(), node_ids.end(), 0);
  find_pairs(couplings_of(network, node_ids));
  pairs_of_free_ = pairs_;
  make_factor();
  note_springs(slots, {});
}

// Rebuilds what depends on the pairs of coupled basis functions.
void CoarseCorrection::make_factor() {
  first_pairs_.clear();
  for (int basis = 0; basis <= num_basis_; ++basis) {
    const auto first = std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(basis, 0));
    first_pairs_.push_back(static_cast<int>(first - pairs_.begin()));
  }
  factor_ = DissectedCholesky(num_basis_, pairs_);
  solution_.setZero(4, num_basis_);
  translation_residual_.setZero(4, num_basis_);
  sums_.assign(at(factor_.num_blocks()) * kBlockNumbers, 0.0F);
  for (auto* numbers : {&masses_, &inertia_}) numbers->assign(at(num_basis_), 0.0F);
  for (int node = 0; node < num_nodes_; ++node) note_alone(node);
  blocks_.change().clear();
}

void CoarseCorrection::set_free(const ConnectivityGraph& network, const Neighborhood& neighborhood,
                                const std::vector<bool>& is_free, const EdgeSlots& slots) {
  const std::vector<int>& node_ids = neighborhood.nodes;
  if (num_basis_ == 0) return;
  Aggregates aggregates{num_basis_, {}};
  for (const int node : node_ids) aggregates.of_unknown.push_back(aggregates_.of_unknown[at(node)]);
  const Prolongation basis_functions =
      smoothed_aggregation(network, is_free, aggregates, neighborhood.ends);
  for (int k = 0; k < basis_functions.size(); ++k)
    set_basis_weights(node_ids[at(k)], basis_functions, k);
  for (int k = 0; k < basis_functions.size(); ++k) note_alone(node_ids[at(k)]);
  std::vector<char> blocks(at(slots.num_blocks()), 0);
  for (int k = 0; k < neighborhood.ends[kBasisReach + 1]; ++k)
    blocks[at(node_ids[at(k)] / kNodeBlock)] = 1;
  note_springs(slots, blocks);
}

void CoarseCorrection::couple(const ConnectivityGraph& network, const std::vector<int>& nodes,
                              const EdgeSlots& slots) {
  if (num_basis_ == 0) return;
  std::vector<std::pair<int, int>> pairs = pairs_of_free_;
  const Couplings couplings = couplings_of(network, nodes);
  for (int basis = 0; basis < num_basis_; ++basis) {
    for (const auto& [other, coupling] : couplings[at(basis)]) {
      if (is_strong(basis, other, coupling)) pairs.emplace_back(basis, other);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (pairs == pairs_) return;
  pairs_ = std::move(pairs);
  make_factor();
  note_springs(slots, {});
}

void CoarseCorrection::set_basis_weights(int node, const Prolongation& basis_functions,
                                         int unknown) {
  BasisWeights& of_node = weights_[at(node)];
  of_node = {};
  int k = 0;
  for (int e = basis_functions.starts[at(unknown)]; e < basis_functions.starts[at(unknown) + 1];
       ++e, ++k) {
    of_node.basis_functions[k] = basis_functions.columns[at(e)];
    of_node.weights[k] = static_cast<float>(basis_functions.values[at(e)]);
  }
}

// Points unused entries to a basis function nearby, so that those of a node range stay in a narrow interval.
void CoarseCorrection::fill_gaps(NodeRange nodes) {
  const auto begin = weights_.begin() + nodes.begin;
  const auto end = weights_.begin() + nodes.end;
  const auto first =
      std::find_if(begin, end, [](const BasisWeights& of_node) { return of_node.weights[0] != 0; });
  int last = first != end ? first->basis_functions[0] : 0;
  for (auto of_node = begin; of_node != end; ++of_node) {
    if (of_node->weights[0] != 0) last = of_node->basis_functions[0];
    for (int k = 0; k < kMostWeights; ++k) {
      if (of_node->weights[k] == 0) of_node->basis_functions[k] = last;
    }
  }
}

CoarseCorrection::Row CoarseCorrection::row_of(int node) const {
  const BasisWeights& of_node = weights_[at(node)];
  Row row;
  for (int k = 0; k < kMostWeights; ++k) {
    if (of_node.weights[k] != 0) row.add(of_node.basis_functions[k], of_node.weights[k]);
  }
  return row;
}

CoarseCorrection::Couplings CoarseCorrection::couplings_of(const ConnectivityGraph& springs,
                                                           const std::vector<int>& node_ids) const {
  const SymmetricMatrix& matrix = springs.matrix;
  Couplings higher(at(num_basis_));
  for (int i = 0; i < matrix.size(); ++i) {
    for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
      if (matrix.columns[at(e)] < i) continue;
      const Row row = difference(node_ids[at(i)], node_ids[at(matrix.columns[at(e)])]);
      const auto stiffness = static_cast<float>(-matrix.values[at(e)]);
      for (const Row::Entry* one = row.begin(); one != row.end(); ++one) {
        for (const Row::Entry* two = one + 1; two != row.end(); ++two) {
          const auto [low, high] = std::minmax(one->basis, two->basis);
          auto& list = higher[at(low)];
          auto found = std::find_if(list.begin(), list.end(), [h = high](const auto& coupling) {
            return coupling.first == h;
          });
          if (found == list.end()) found = list.insert(list.end(), {high, 0.0F});
          found->second -= stiffness * one->coefficient * two->coefficient;
        }
      }
    }
  }
  for (auto& list : higher) std::sort(list.begin(), list.end());
  return higher;
}

bool CoarseCorrection::is_strong(int basis, int other, float coupling) const {
  return std::abs(coupling) >
         kLeastCoupling * std::min(largest_couplings_[at(basis)], largest_couplings_[at(other)]);
}

// Pairs of coarse basis functions that springs couple, except for those that others couple much more: aggregates that are not next to each other.
void CoarseCorrection::find_pairs(const Couplings& couplings) {
  largest_couplings_.assign(at(num_basis_), 0.0F);
  for (int basis = 0; basis < num_basis_; ++basis) {
    for (const auto& [other, coupling] : couplings[at(basis)]) {
      for (const int one : {basis, other}) {
        largest_couplings_[at(one)] = std::max(largest_couplings_[at(one)], coupling);
      }
    }
  }
  for (int basis = 0; basis < num_basis_; ++basis) {
    for (const auto& [other, coupling] : couplings[at(basis)]) {
      if (is_strong(basis, other, coupling)) pairs_.emplace_back(basis, other);
    }
  }
}

/// The difference between the rows of two nodes.
CoarseCorrection::Row CoarseCorrection::difference(int node, int other) const {
  Row row = row_of(node);
  for (const auto& [basis, weight] : row_of(other)) row.add(basis, -weight);
  return row;
}

/// Returns -1 for coarse basis functions that are not coupled.
int CoarseCorrection::pair_of(int a, int b) const {
  const std::pair<int, int> both = std::minmax(a, b);
  const auto end = pairs_.begin() + first_pairs_[at(both.first) + 1];
  const auto found = std::lower_bound(pairs_.begin() + first_pairs_[at(both.first)], end, both);
  return found != end && *found == both ? static_cast<int>(found - pairs_.begin()) : -1;
}

// Expands the energy of a spring with the difference sum d_a x_a into springs between basis functions and to fixed points.
void CoarseCorrection::add_terms(const Row& of_spring, std::vector<CoarseTerm>& terms) const {
  const Row row = of_spring.merged(
      kLeastCoefficient, [this](int basis, int other) { return pair_of(basis, other) >= 0; });
  float sum = 0;
  for (const auto& [basis, d] : row) sum += d;
  const float least = kLeastSum * std::abs(row.count > 0 ? row.begin()->coefficient : 0.0F);
  for (const Row::Entry* one = row.begin(); one != row.end(); ++one) {
    const auto [basis, d] = *one;
    for (const Row::Entry* two = one + 1; two != row.end(); ++two) {
      terms.push_back({factor_.pair_block(pair_of(basis, two->basis)), -d * two->coefficient});
    }
    if (std::abs(sum) > least) terms.push_back({factor_.own_block(basis), d * sum});
  }
}

void CoarseCorrection::note_alone(int node) {
  std::vector<CoarseTerm> terms;
  add_terms(row_of(node), terms);
  CoarseNode& alone = alone_.change()[at(node)];
  alone.num_terms = static_cast<int>(terms.size());
  std::copy(terms.begin(), terms.end(), alone.terms);
}

void CoarseCorrection::add_copies(const std::vector<int>& origins) {
  parts_ = NodePartition(num_nodes_ + static_cast<int>(origins.size()));
  of_parts_.clear();
  for (const int origin : origins) {
    const int node = num_nodes_++;
    weights_.resize(at(padded_size(num_nodes_)));
    alone_.change().resize(weights_.size());
    weights_[at(node)] = weights_[at(origin)];
    aggregates_.of_unknown.push_back(aggregates_.of_unknown[at(origin)]);
    note_alone(node);
  }
}

// One slot of a node in springs_for_one_ is taken, so that each node has its part; which ones is a multiple of the golden
// section: even over nodes in a row, and over rows of whatever length.
bool CoarseCorrection::is_in_sample(int node, int slot) const {
  constexpr double kGolden = 0.6180339887498949;
  const double number = kGolden * node + slot / springs_for_one_;
  return springs_for_one_ * (number - std::floor(number)) < 1;
}

void CoarseCorrection::note_springs(const EdgeSlots& slots, const std::vector<char>& blocks) {
  if (num_basis_ == 0) return;
  std::vector<Block>& all = blocks_.change();
  const auto num_before = all.size();
  const auto is_changed = [&](int b) { return at(b) >= num_before || blocks[at(b)] != 0; };
  all.resize(at(slots.num_blocks()));
  for (int b = 0; b < slots.num_blocks(); ++b) {
    if (!is_changed(b)) continue;
    Block& block = all[at(b)];
    block.springs.clear();
    block.terms.clear();
    const SlotRange& range = slots.blocks[at(b)];
    for (int slot = range.begin; slot < range.end; ++slot) {
      for (int lane = 0; lane < kNodeBlock; ++lane) {
        const auto place = at(slot) * kNodeBlock + at(lane);
        const int node = b * kNodeBlock + lane;
        const int other = slots.others[place];
        if (slots.edges[place] < 0 || node >= slots.num_nodes || other <= node) continue;
        const bool is_bound =
            std::abs(sum_of(weights_[at(node)]) - sum_of(weights_[at(other)])) > kLeastBound;
        if (!is_bound && !is_in_sample(node, slot - range.begin)) continue;
        const std::size_t first = block.terms.size();
        add_terms(difference(node, other), block.terms);
        block.springs.push_back({slot, lane, node, other,
                                 static_cast<int>(block.terms.size() - first),
                                 is_bound ? 1.0F : static_cast<float>(springs_for_one_)});
      }
    }
  }
  const bool are_new = of_parts_.empty();
  of_parts_.resize(at(parts_.count()));
  for (int p = 0; p < parts_.count(); ++p) {
    bool any = are_new;
    for (int b = parts_[p].begin / kNodeBlock; b < parts_[p].end / kNodeBlock; ++b) {
      any = any || (b < slots.num_blocks() && is_changed(b));
    }
    if (any) find_ranges(p);
  }
}

// Finds the interval of basis functions of a node range. It is narrow because the nodes are well ordered.
void CoarseCorrection::find_ranges(int p) {
  Part& part = of_parts_[at(p)];
  part.basis_functions = {num_basis_, 0};
  part.sums = {factor_.num_blocks(), 0};
  const auto include = [](int number, Range& range) {
    range.begin = std::min(range.begin, number);
    range.end = std::max(range.end, number + 1);
  };
  const NodeRange nodes = parts_[p];
  fill_gaps(nodes);
  for (int i = nodes.begin; i < nodes.end; ++i) {
    for (const int basis : weights_[at(i)].basis_functions) include(basis, part.basis_functions);
    const CoarseNode& alone = (*alone_)[at(i)];
    for (int k = 0; k < alone.num_terms; ++k) include(alone.terms[k].sum, part.sums);
  }
  for (int b = nodes.begin / kNodeBlock; b < nodes.end / kNodeBlock; ++b) {
    if (at(b) >= blocks_->size()) break;
    for (const CoarseTerm& term : (*blocks_)[at(b)].terms) include(term.sum, part.sums);
    for (const CoarseSpring& spring : (*blocks_)[at(b)].springs) {
      for (const int node : {spring.node, spring.other}) {
        const CoarseNode& alone = (*alone_)[at(node)];
        for (int k = 0; k < alone.num_terms; ++k) include(alone.terms[k].sum, part.sums);
      }
    }
  }
  const auto num_basis =
      static_cast<std::size_t>(std::max(0, part.basis_functions.end - part.basis_functions.begin));
  const auto num_sums = static_cast<std::size_t>(std::max(0, part.sums.end - part.sums.begin));
  part.blocks.assign(num_sums * kBlockNumbers, 0.0F);
  for (Fours* sums : {&part.residual, &part.other_residual}) sums->setZero(4, long(num_basis));
}

void CoarseCorrection::set_bending(const EdgeSlots& slots,
                                   const std::function<double(std::size_t)>& stiffness) {
  if (num_basis_ == 0) return;
  std::vector<double> sums(at(factor_.num_blocks()), 0.0);
  for (int b = 0; b < slots.num_blocks(); ++b) {
    for (int slot = slots.blocks[at(b)].begin; slot < slots.blocks[at(b)].end; ++slot) {
      for (int lane = 0; lane < kNodeBlock; ++lane) {
        const auto place = at(slot) * kNodeBlock + at(lane);
        const int node = b * kNodeBlock + lane;
        const int other = slots.others[place];
        if (slots.edges[place] < 0 || node >= slots.num_nodes || other <= node) continue;
        const double w = stiffness(place);
        const Row row = difference(node, other);
        double sum = 0;
        for (const auto& [basis, d] : row) sum += static_cast<double>(d);
        for (const Row::Entry* one = row.begin(); one != row.end(); ++one) {
          const auto d = static_cast<double>(one->coefficient);
          sums[at(factor_.own_block(one->basis))] += w * d * sum;
          for (const Row::Entry* two = one + 1; two != row.end(); ++two) {
            const int pair = pair_of(one->basis, two->basis);
            if (pair >= 0)
              sums[at(factor_.pair_block(pair))] -= w * d * static_cast<double>(two->coefficient);
          }
        }
      }
    }
  }
  bending_.assign(sums.begin(), sums.end());
}

void CoarseCorrection::set_masses(const VectorX<float>& masses) {
  std::fill(masses_.begin(), masses_.end(), 0.0F);
  for (int i = 0; i < num_nodes_ && num_basis_ > 0; ++i)
    add_lumped(masses_, weights_[at(i)], masses[i]);
}

void CoarseCorrection::factorize(const unsigned short* linear, float root_scale,
                                 std::span<const char> is_held,
                                 std::span<const SlidingNode> sliding, float inertia_over_mass,
                                 WorkerTeam& team) {
  if (num_basis_ == 0) return;
  const CoarseKernel& kernel = coarse_kernel();
  const float scale = 1 / (root_scale * root_scale);
  team.run(parts_.count(), [&](int p) {
    Part& part = of_parts_[at(p)];
    std::fill(part.blocks.begin(), part.blocks.end(), 0.0F);
    const NodeRange nodes = parts_[p];
    for (int b = nodes.begin / kNodeBlock; b < nodes.end / kNodeBlock; ++b) {
      if (at(b) >= blocks_->size()) break;
      const Block& block = (*blocks_)[at(b)];
      kernel.add_springs(
          {block.springs.data(), static_cast<int>(block.springs.size()), block.terms.data(),
           alone_->data(), is_held.data(), linear, scale, part.sums.begin},
          part.blocks.data());
    }
    const auto is_before = [](const SlidingNode& one, int node) { return one.node < node; };
    for (auto one = std::lower_bound(sliding.begin(), sliding.end(), nodes.begin, is_before);
         one != sliding.end() && one->node < nodes.end; ++one) {
      const Vector3<float>& n = one->normal;
      const std::array<float, 6> numbers = {n[0] * n[0], n[1] * n[1], n[2] * n[2],
                                            n[0] * n[1], n[1] * n[2], n[2] * n[0]};
      const CoarseNode& alone = (*alone_)[at(one->node)];
      for (int k = 0; k < alone.num_terms; ++k) {
        const CoarseTerm& term = alone.terms[k];
        float* const sum = &part.blocks[at(term.sum - part.sums.begin) * kBlockNumbers];
        for (std::size_t number = 0; number < numbers.size(); ++number) {
          sum[number] += term.factor * one->stiffness * numbers[number];
        }
      }
    }
  });
  const std::int64_t num_numbers = std::ssize(sums_);
  team.run(parts_.count(), [&](int share) {
    const std::int64_t begin = num_numbers * share / parts_.count();
    const std::int64_t end = num_numbers * (share + 1) / parts_.count();
    std::fill(sums_.begin() + begin, sums_.begin() + end, 0.0F);
    for (const Part& part : of_parts_) {
      const std::int64_t first = std::int64_t{part.sums.begin} * kBlockNumbers;
      const std::int64_t last = std::min(end, first + std::ssize(part.blocks));
      for (std::int64_t k = std::max(begin, first); k < last; ++k) {
        sums_[static_cast<std::size_t>(k)] += part.blocks[static_cast<std::size_t>(k - first)];
      }
    }
  });
  for (std::size_t block = 0; block < bending_.size(); ++block) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sums_[block * kBlockNumbers + axis] += bending_[block];
    }
  }
  for (std::size_t k = 0; k < masses_.size(); ++k) inertia_[k] = inertia_over_mass * masses_[k];
  for (const SlidingNode& one : sliding) add_lumped(inertia_, weights_[at(one.node)], one.drag);
  factor_.factorize(sums_.data(), inertia_.data(), team);
}

void CoarseCorrection::restrict_residual(int part, const std::vector<int>& held,
                                         const NodeArrays<float>& residual) {
  if (num_basis_ == 0) return;
  Part& of_part = of_parts_[at(part)];
  of_part.residual.setZero();
  of_part.other_residual.setZero();
  const NodeRange nodes = parts_[part];
  coarse_kernel().restrict_residual(weights_.data(), nodes.begin, nodes.end, residual.data(),
                                    residual.rows(), of_part.basis_functions.begin,
                                    of_part.residual.data(), of_part.other_residual.data());
  of_part.residual += of_part.other_residual;
  for (const int i : in_range(held, nodes)) {
    const BasisWeights& of_node = weights_[at(i)];
    for (int k = 0; k < kMostWeights; ++k) {
      of_part.residual.col(of_node.basis_functions[k] - of_part.basis_functions.begin).head<3>() -=
          of_node.weights[k] * residual.row(i).transpose();
    }
  }
}

void CoarseCorrection::solve(WorkerTeam& team) {
  if (num_basis_ == 0) return;
  std::array<DissectedCholesky::Summand, WorkerTeam::kMostParts + 1> residuals;
  std::size_t count = 0;
  for (const Part& part : of_parts_) {
    residuals[count++] = {part.residual.data(), part.basis_functions.begin,
                          part.basis_functions.end};
  }
  if (translation_inertia_ > 0) {
    split_translation();
    residuals[count++] = {translation_residual_.data(), 0, num_basis_};
  }
  factor_.solve(std::span(residuals).first(count), solution_.data(), team);
  if (translation_inertia_ > 0) join_translation();
}

// Basis functions add up to one: restricted residuals add up to that of all nodes. Their part that moves all alike is taken out.
void CoarseCorrection::split_translation() {
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (const Part& part : of_parts_) sum += part.residual.rowwise().sum();
  Vector3<float> along = sum.head<3>();
  along -= translation_normal_.dot(along) * translation_normal_;
  translation_ = along / translation_inertia_;
  const Eigen::Map<const Eigen::RowVectorXf> inertia(inertia_.data(), num_basis_);
  translation_residual_.topRows<3>().noalias() = -along * (inertia / inertia.sum());
}

void CoarseCorrection::join_translation() {
  const Eigen::Map<const VectorX<float>> inertia(inertia_.data(), num_basis_);
  Vector3<float> mean = solution_.topRows<3>() * inertia / inertia.sum();
  mean -= translation_normal_.dot(mean) * translation_normal_;
  solution_.topRows<3>().colwise() += translation_ - mean;
}

void CoarseCorrection::prolongate(int part, const std::vector<int>& held,
                                  NodeArrays<float>& correction) const {
  const NodeRange nodes = parts_[part];
  const auto stride = correction.rows();
  if (num_basis_ == 0) {
    correction.middleRows(nodes.begin, nodes.end - nodes.begin).setZero();
    return;
  }
  coarse_kernel().prolongate(weights_.data(), nodes.begin, nodes.end, solution_.data(),
                             correction.data(), stride);
  for (const int i : in_range(held, nodes)) correction.row(i).setZero();
}

}  // namespace weft::fast
