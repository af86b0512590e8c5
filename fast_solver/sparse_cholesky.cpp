#include <weft/fast_solver/sparse_cholesky.hpp>

#include <algorithm>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>
#include <Eigen/Cholesky>

#include <weft/custom_forces/core/error.hpp>
#include <weft/fast_solver/panel_kernel.hpp>

namespace weft::fast {
namespace {

/// Multiplications below which a subtree is not worth a task of its own: a few microseconds.
constexpr double kSmallestTask = 20000;
/// Subtrees of one size that together make the work of the threads even.
constexpr int kMostTasks = 16;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

int round_up(int n) {
  return (n + kPanelBlock - 1) / kPanelBlock * kPanelBlock;
}

/// A stiff network that only its mass holds would not be positive definite in single precision.
using Dense = Eigen::MatrixXd;

}  // namespace

SparseCholesky::SparseCholesky(const SymmetricMatrix& matrix, const std::vector<int>& order,
                               const std::vector<int>& names)
    : SparseCholesky(matrix, eliminate(matrix, order), names) {}

SparseCholesky::SparseCholesky(const SymmetricMatrix& matrix, Elimination elimination,
                               const std::vector<int>& names)
    : elimination_(std::move(elimination)) {
  lay_out();
  divide_work();
  factorize(matrix);
  names_ = elimination_.order;
  if (names.empty()) return;
  for (int& name : names_) name = names.at(at(name));
}

std::size_t SparseCholesky::num_bytes() const {
  return (panels_.size() + vectors_.size()) * sizeof(float);
}

void SparseCholesky::lay_out() {
  const auto& nodes = elimination_.supernodes;
  fronts_.resize(nodes.size());
  std::size_t num_panel = 0;
  std::size_t num_vector = 0;
  int longest = 0;
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    Front& front = fronts_[s];
    const auto num_rows = static_cast<int>(nodes[s].rows.size());
    front.num_below = num_rows;
    front.num_rows = round_up(nodes[s].width + num_rows);
    front.panel = num_panel;
    front.vector = num_vector;
    num_panel += at(front.num_rows) * at(nodes[s].width);
    num_vector += 3 * at(front.num_rows);
    longest = std::max(longest, front.num_rows);
    num_entries_ +=
        at(nodes[s].width) * at(nodes[s].width + 1) / 2 + at(nodes[s].width) * at(num_rows);
    if (nodes[s].parent >= 0) ++fronts_[at(nodes[s].parent)].num_children;
    front.into_parent = into_parent_.size();
    if (nodes[s].parent < 0) continue;
    const Supernode& parent = nodes[at(nodes[s].parent)];
    for (const int row : nodes[s].rows) {
      const int column = row - parent.first;
      into_parent_.push_back(
          column < parent.width
              ? column
              : parent.width +
                    static_cast<int>(std::lower_bound(parent.rows.begin(), parent.rows.end(), row) -
                                     parent.rows.begin()));
    }
  }
  int first = 0;
  for (Front& front : fronts_) {
    front.first_child = first;
    first += front.num_children;
  }
  children_.resize(at(first));
  std::vector<int> next(fronts_.size());
  for (std::size_t s = 0; s < nodes.size(); ++s) next[s] = fronts_[s].first_child;
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    if (nodes[s].parent >= 0) children_[at(next[at(nodes[s].parent)]++)] = static_cast<int>(s);
  }
  panels_.assign(num_panel, 0.0F);
  vectors_.assign(num_vector, 0.0F);
  scratch_stride_ = 3 * at(longest);
}

// Subtrees are ranges, for children come right before their parents.
void SparseCholesky::divide_work() {
  const auto& nodes = elimination_.supernodes;
  std::vector<double> work(nodes.size());
  std::vector<int> first(nodes.size());
  double total = 0;
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    work[s] += static_cast<double>(fronts_[s].num_rows) * nodes[s].width;
    total += static_cast<double>(fronts_[s].num_rows) * nodes[s].width;
    first[s] = static_cast<int>(s);
    if (fronts_[s].num_children > 0) first[s] = first[at(children_[at(fronts_[s].first_child)])];
    if (nodes[s].parent >= 0) work[at(nodes[s].parent)] += work[s];
  }
  const double largest = std::max(kSmallestTask, total / kMostTasks);
  for (int s = static_cast<int>(nodes.size()) - 1; s >= 0;) {
    if (work[at(s)] <= largest) {
      subtrees_.push_back({first[at(s)], s + 1});
      s = first[at(s)] - 1;
    } else {
      top_.push_back(s--);
    }
  }
  std::reverse(subtrees_.begin(), subtrees_.end());
  std::reverse(top_.begin(), top_.end());
  scratch_.assign(scratch_stride_ * (subtrees_.size() + 1), 0.0F);
}

void SparseCholesky::factorize(const SymmetricMatrix& matrix) {
  const auto& nodes = elimination_.supernodes;
  std::vector<int> place(elimination_.order.size());
  for (std::size_t k = 0; k < place.size(); ++k)
    place[at(elimination_.order[k])] = static_cast<int>(k);
  std::vector<Dense> updates(nodes.size());  // what a supernode takes from its parent's front
  const auto eliminate_one = [&](int s) {
    const Supernode& node = nodes[at(s)];
    const Front& front = fronts_[at(s)];
    const Eigen::Index w = node.width;
    const Eigen::Index n = w + front.num_below;
    Dense f = Dense::Zero(n, n);
    for (int c = 0; c < node.width; ++c) {
      const int unknown = elimination_.order[at(node.first + c)];
      f(c, c) += matrix.diagonal[at(unknown)];
      for (int e = matrix.starts[at(unknown)]; e < matrix.starts[at(unknown) + 1]; ++e) {
        const int k = place[at(matrix.columns[at(e)])];
        if (k < node.first + c) continue;
        const auto row =
            k < node.first + node.width
                ? k - node.first
                : w + (std::lower_bound(node.rows.begin(), node.rows.end(), k) - node.rows.begin());
        f(row, c) += matrix.values[at(e)];
      }
    }
    for (int i = 0; i < front.num_children; ++i) {
      const int child = children_[at(front.first_child + i)];
      const int* const into = into_parent_.data() + fronts_[at(child)].into_parent;
      Dense& update = updates[at(child)];
      for (Eigen::Index b = 0; b < update.cols(); ++b) {
        for (Eigen::Index a = b; a < update.rows(); ++a) f(into[a], into[b]) += update(a, b);
      }
      Dense().swap(update);
    }
    const Eigen::LLT<Dense> llt(f.topLeftCorner(w, w));
    if (llt.info() != Eigen::Success) {
      throw InvalidArgument("sparse Cholesky: the matrix is not positive definite at unknown " +
                            std::to_string(elimination_.order[at(node.first)]));
    }
    Eigen::Map<Eigen::MatrixXf> panel(panels_.data() + front.panel, front.num_rows, w);
    Dense inverse = Dense::Identity(w, w);
    llt.matrixL().solveInPlace(inverse);
    panel.topRows(w) = inverse.cast<float>();
    if (front.num_below == 0) return;
    const Eigen::Index m = front.num_below;
    // L21 = F21 L11^-T
    const Dense below =
        f.bottomLeftCorner(m, w) * inverse.transpose().triangularView<Eigen::Upper>();
    panel.middleRows(w, m) = Dense(below * inverse.triangularView<Eigen::Lower>()).cast<float>();
    updates[at(s)] = f.bottomRightCorner(m, m);
    updates[at(s)].selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
  };
  tbb::parallel_for(std::size_t{0}, subtrees_.size(), [&](std::size_t t) {
    for (int s = subtrees_[t].begin; s < subtrees_[t].end; ++s) eliminate_one(s);
  });
  for (const int s : top_) eliminate_one(s);
}

void SparseCholesky::go_up(int s, ConstMatrix3XRef<float> right, float* scratch) {
  const Supernode& node = elimination_.supernodes[at(s)];
  const Front& front = fronts_[at(s)];
  const int n = front.num_rows;
  float* const v = vectors_.data() + front.vector;
  for (int c = 0; c < node.width; ++c) {
    const float* const b =
        right.data() + 3 * static_cast<std::ptrdiff_t>(names_[at(node.first + c)]);
    v[c] = b[0];
    v[n + c] = b[1];
    v[2 * n + c] = b[2];
  }
  for (int axis = 0; axis < 3; ++axis) {
    std::fill(v + axis * n + node.width, v + axis * n + n, 0.0F);
  }
  for (int i = 0; i < front.num_children; ++i) {
    const Front& child = fronts_[at(children_[at(front.first_child + i)])];
    const int* const into = into_parent_.data() + child.into_parent;
    const int width = elimination_.supernodes[at(children_[at(front.first_child + i)])].width;
    for (int axis = 0; axis < 3; ++axis) {
      const float* const from = vectors_.data() + child.vector + axis * child.num_rows + width;
      float* const to = v + axis * n;
      for (int r = 0; r < child.num_below; ++r) to[into[r]] += from[r];
    }
  }
  panel_kernel().times({panels_.data() + front.panel, n, node.width}, v, n, scratch);
  for (int axis = 0; axis < 3; ++axis) {
    float* const to = v + axis * n;
    const float* const product = scratch + axis * n;
    for (int r = 0; r < node.width; ++r) to[r] = product[r];
    for (int r = node.width; r < n; ++r) to[r] -= product[r];
  }
}

void SparseCholesky::go_down(int s, Matrix3XRef<float> result, float* scratch) {
  const Supernode& node = elimination_.supernodes[at(s)];
  const Front& front = fronts_[at(s)];
  const int n = front.num_rows;
  float* const v = vectors_.data() + front.vector;
  if (front.num_below > 0) {
    const Front& parent = fronts_[at(node.parent)];
    const int* const into = into_parent_.data() + front.into_parent;
    for (int axis = 0; axis < 3; ++axis) {
      const float* const from = vectors_.data() + parent.vector + axis * parent.num_rows;
      float* const to = v + axis * n + node.width;
      for (int r = 0; r < front.num_below; ++r) to[r] = -from[into[r]];
    }
  }
  panel_kernel().transposed_times({panels_.data() + front.panel, n, node.width}, v, scratch, n);
  for (int axis = 0; axis < 3; ++axis) {
    float* const to = v + axis * n;
    for (int r = 0; r < node.width; ++r) to[r] = scratch[axis * n + r];
    for (int r = node.width; r < node.width + front.num_below; ++r) to[r] = -to[r];
  }
  for (int c = 0; c < node.width; ++c) {
    float* const x = result.data() + 3 * static_cast<std::ptrdiff_t>(names_[at(node.first + c)]);
    x[0] = v[c];
    x[1] = v[n + c];
    x[2] = v[2 * n + c];
  }
}

void SparseCholesky::solve(ConstMatrix3XRef<float> right, Matrix3XRef<float> result,
                           ThreadTeam& team) {
  float* const top_scratch = scratch_.data() + scratch_stride_ * subtrees_.size();
  const auto scratch = [&](std::size_t t) { return scratch_.data() + scratch_stride_ * t; };
  const int num_parts = std::min(static_cast<int>(subtrees_.size()), ThreadTeam::kMostParts);
  const auto for_each_subtree = [&](const auto& work) {
    team.run(num_parts, [&](int part) {
      const std::size_t begin = subtrees_.size() * at(part) / at(num_parts);
      const std::size_t end = subtrees_.size() * at(part + 1) / at(num_parts);
      for (std::size_t t = begin; t < end; ++t) work(t);
    });
  };
  for_each_subtree([&](std::size_t t) {
    for (int s = subtrees_[t].begin; s < subtrees_[t].end; ++s) go_up(s, right, scratch(t));
  });
  for (const int s : top_) go_up(s, right, top_scratch);
  for (auto s = top_.rbegin(); s != top_.rend(); ++s) go_down(*s, result, top_scratch);
  for_each_subtree([&](std::size_t t) {
    for (int s = subtrees_[t].end - 1; s >= subtrees_[t].begin; --s) go_down(s, result, scratch(t));
  });
}

}  // namespace weft::fast
