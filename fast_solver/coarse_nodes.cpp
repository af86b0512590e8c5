#include <weft/fast_solver/coarse_nodes.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace weft::fast {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Number among the coarse unknowns, or -1. In the order of the unknowns, which on a grid keeps
/// distances even.
std::vector<int> choose_coarse(const SymmetricMatrix& matrix, int& num_coarse) {
  std::vector<int> coarse(at(matrix.size()), -1);
  std::vector<char> is_decided(at(matrix.size()), 0);
  for (int i = 0; i < matrix.size(); ++i) {
    if (is_decided[at(i)] != 0) continue;
    is_decided[at(i)] = 1;
    coarse[at(i)] = num_coarse++;
    for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
      if (matrix.values[at(e)] < 0) is_decided[at(matrix.columns[at(e)])] = 1;
    }
  }
  return coarse;
}

}  // namespace

Interpolation make_interpolation(const SymmetricMatrix& matrix) {
  Interpolation result;
  const std::vector<int> coarse = choose_coarse(matrix, result.num_coarse);
  result.starts.push_back(0);
  for (int i = 0; i < matrix.size(); ++i) {
    if (coarse[at(i)] >= 0) {
      result.columns.push_back(coarse[at(i)]);
      result.values.push_back(1);
    } else {
      // What masses and pinned nodes hold, and what coarse neighbours hold.
      double held = matrix.diagonal[at(i)];
      double by_coarse = 0;
      for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
        held += matrix.values[at(e)];
        const bool is_coarse = coarse[at(matrix.columns[at(e)])] >= 0;
        if (is_coarse && matrix.values[at(e)] < 0) by_coarse -= matrix.values[at(e)];
      }
      const double sum = by_coarse + std::max(held, 0.0);
      for (int e = matrix.starts[at(i)]; e < matrix.starts[at(i) + 1]; ++e) {
        const int column = coarse[at(matrix.columns[at(e)])];
        if (column < 0 || !(matrix.values[at(e)] < 0)) continue;
        result.columns.push_back(column);
        result.values.push_back(-matrix.values[at(e)] / sum);
      }
    }
    result.starts.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

CoarseMatrixMaker::CoarseMatrixMaker(const SymmetricMatrix& matrix, const Interpolation& p)
    : matrix_(&matrix), p_(&p), parts_(at(p.num_coarse)), sum_(p.num_coarse) {
  for (int i = 0; i < p.size(); ++i) {
    for (int e = p.starts[at(i)]; e < p.starts[at(i) + 1]; ++e) {
      parts_[at(p.columns[at(e)])].emplace_back(i, p.values[at(e)]);
    }
  }
  result_.diagonal.assign(at(p.num_coarse), 0.0);
  result_.starts.push_back(0);
}

bool CoarseMatrixMaker::add_rows(int count) {
  const Interpolation& p = *p_;
  const auto add_row = [&](int unknown, double factor) {
    for (int e = p.starts[at(unknown)]; e < p.starts[at(unknown) + 1]; ++e) {
      sum_.add(p.columns[at(e)], factor * p.values[at(e)]);
    }
  };
  for (const int end = std::min(p.num_coarse, next_ + count); next_ < end; ++next_) {
    for (const auto& [i, weight] : parts_[at(next_)]) {
      add_row(i, weight * matrix_->diagonal[at(i)]);
      for (int e = matrix_->starts[at(i)]; e < matrix_->starts[at(i) + 1]; ++e) {
        add_row(matrix_->columns[at(e)], weight * matrix_->values[at(e)]);
      }
    }
    sum_.flush([&](int column, double value) {
      if (column == next_) {
        result_.diagonal[at(next_)] = value;
      } else {
        result_.columns.push_back(column);
        result_.values.push_back(value);
      }
    });
    result_.starts.push_back(static_cast<int>(result_.columns.size()));
  }
  return next_ == p.num_coarse;
}

SymmetricMatrix coarse_matrix(const SymmetricMatrix& matrix, const Interpolation& p) {
  CoarseMatrixMaker maker(matrix, p);
  (void)maker.add_rows(p.num_coarse);
  return maker.take();
}

Interpolation composed(const Interpolation& first, const Interpolation& second) {
  Interpolation result;
  result.num_coarse = second.num_coarse;
  result.starts.push_back(0);
  RowSum sum(second.num_coarse);
  for (int i = 0; i < first.size(); ++i) {
    for (int e = first.starts[at(i)]; e < first.starts[at(i) + 1]; ++e) {
      const int middle = first.columns[at(e)];
      for (int k = second.starts[at(middle)]; k < second.starts[at(middle) + 1]; ++k) {
        sum.add(second.columns[at(k)], first.values[at(e)] * second.values[at(k)]);
      }
    }
    sum.flush([&](int column, double value) {
      result.columns.push_back(column);
      result.values.push_back(value);
    });
    result.starts.push_back(static_cast<int>(result.columns.size()));
  }
  return result;
}

}  // namespace weft::fast
