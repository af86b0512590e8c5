#include <weft/fast_solver/elimination.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace weft::fast {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[at(order[k])] = static_cast<int>(k);
  return place;
}

/// Parent of each column in the elimination tree, -1 for roots (Liu 1986, with path compression).
std::vector<int> elimination_tree(const SymmetricMatrix& matrix, const std::vector<int>& order) {
  const std::vector<int> place = inverse_of(order);
  std::vector<int> parent(order.size(), -1);
  std::vector<int> ancestor(order.size(), -1);
  for (int k = 0; k < matrix.size(); ++k) {
    const int unknown = order[at(k)];
    for (int e = matrix.starts[at(unknown)]; e < matrix.starts[at(unknown) + 1]; ++e) {
      int i = place[at(matrix.columns[at(e)])];
      while (i != -1 && i < k) {
        const int next = ancestor[at(i)];
        ancestor[at(i)] = k;
        if (next == -1) parent[at(i)] = k;
        i = next;
      }
    }
  }
  return parent;
}

/// Columns such that children come right before their parents.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(parent.size(), -1);
  std::vector<int> next_sibling(parent.size(), -1);
  std::vector<int> stack;
  for (int k = n - 1; k >= 0; --k) {
    if (parent[at(k)] == -1) continue;
    next_sibling[at(k)] = first_child[at(parent[at(k)])];
    first_child[at(parent[at(k)])] = k;
  }
  for (int k = n - 1; k >= 0; --k) {
    if (parent[at(k)] == -1) stack.push_back(k);
  }
  std::vector<int> result;
  while (!stack.empty()) {
    const int k = stack.back();
    if (first_child[at(k)] == -1) {
      result.push_back(k);
      stack.pop_back();
    } else {
      stack.push_back(first_child[at(k)]);
      first_child[at(k)] = next_sibling[at(first_child[at(k)])];
    }
  }
  return result;
}

/// Supernodes of columns whose rows agree exactly.
class FundamentalSupernodes {
 public:
  FundamentalSupernodes(const SymmetricMatrix& matrix, const std::vector<int>& order)
      : matrix_(matrix),
        order_(order),
        place_(inverse_of(order)),
        mark_(order.size(), -1),
        num_children_(order.size(), 0) {}

  std::vector<Supernode> run() {
    const int n = matrix_.size();
    std::vector<Supernode> result;
    std::vector<std::vector<int>> pending(order_.size());  // rows that children hand on
    for (int k = 0; k < n; ++k) {
      std::vector<int> rows = rows_of(k, pending[at(k)]);
      const bool joins = !result.empty() && !result.back().rows.empty() &&
                         result.back().rows.front() == k &&
                         result.back().rows.size() == rows.size() + 1 && num_children_[at(k)] == 1;
      if (!rows.empty()) {
        std::vector<int>& to = pending[at(rows.front())];
        ++num_children_[at(rows.front())];
        to.insert(to.end(), rows.begin() + 1, rows.end());
      }
      if (joins) {
        ++result.back().width;
        result.back().rows = std::move(rows);
      } else {
        result.push_back({k, 1, std::move(rows), -1});
      }
      std::vector<int>().swap(pending[at(k)]);
    }
    return result;
  }

 private:
  std::vector<int> rows_of(int k, const std::vector<int>& from_children) {
    std::vector<int> rows;
    const auto add = [&](int row) {
      if (row <= k || mark_[at(row)] == k) return;
      mark_[at(row)] = k;
      rows.push_back(row);
    };
    const int unknown = order_[at(k)];
    for (int e = matrix_.starts[at(unknown)]; e < matrix_.starts[at(unknown) + 1]; ++e) {
      add(place_[at(matrix_.columns[at(e)])]);
    }
    for (const int row : from_children) add(row);
    std::sort(rows.begin(), rows.end());
    return rows;
  }

  const SymmetricMatrix& matrix_;
  const std::vector<int>& order_;
  std::vector<int> place_;
  std::vector<int> mark_;
  std::vector<int> num_children_;
};

double stored(std::ptrdiff_t width, std::size_t num_rows) {
  const auto w = static_cast<double>(width);
  return w * (w + 1) / 2 + w * static_cast<double>(num_rows);
}

/// Whether a supernode may become one with its parent: a dense kernel reads a few zeros faster than it
/// changes from one panel to the next. As in CHOLMOD, wider ones tolerate less; the numbers are
/// measured on grids of 50 x 50 to 200 x 200.
bool is_worth_merging(int width, double zeros, double total) {
  const double share = zeros / total;
  if (width <= 8) return share < 0.6;
  if (width <= 24) return share < 0.25;
  if (width <= 64) return share < 0.1;
  return share < 0.03;
}

void set_parents(std::vector<Supernode>& supernodes, std::size_t num_columns) {
  std::vector<int> of_column(num_columns, -1);
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    for (int c = 0; c < supernodes[s].width; ++c) {
      of_column[at(supernodes[s].first + c)] = static_cast<int>(s);
    }
  }
  for (Supernode& s : supernodes) s.parent = s.rows.empty() ? -1 : of_column[at(s.rows.front())];
}

std::vector<int> merged_rows(const Supernode& child, const Supernode& parent) {
  std::vector<int> rows;
  std::set_union(child.rows.begin(), child.rows.end(), parent.rows.begin(), parent.rows.end(),
                 std::back_inserter(rows));
  const int end = parent.first + parent.width;
  rows.erase(std::remove_if(rows.begin(), rows.end(), [&](int r) { return r < end; }), rows.end());
  return rows;
}

/// Only with the last child, whose columns end where those of the parent begin.
std::vector<Supernode> merge(std::vector<Supernode> fundamental) {
  std::vector<Supernode> result;
  std::vector<double> zeros;
  for (Supernode& next : fundamental) {
    Supernode current = std::move(next);
    double current_zeros = 0;
    while (!result.empty()) {
      const Supernode& last = result.back();
      if (last.first + last.width != current.first || last.rows.empty() ||
          last.rows.front() >= current.first + current.width) {
        break;
      }
      std::vector<int> rows = merged_rows(last, current);
      const int width = last.width + current.width;
      const double total = stored(width, rows.size());
      const double new_zeros = total - stored(last.width, last.rows.size()) -
                               stored(current.width, current.rows.size()) + zeros.back() +
                               current_zeros;
      if (!is_worth_merging(width, new_zeros, total)) break;
      current = {last.first, width, std::move(rows), -1};
      current_zeros = new_zeros;
      result.pop_back();
      zeros.pop_back();
    }
    result.push_back(std::move(current));
    zeros.push_back(current_zeros);
  }
  return result;
}

}  // namespace

Elimination eliminate(const SymmetricMatrix& matrix, const std::vector<int>& order) {
  const std::vector<int> post = postorder(elimination_tree(matrix, order));
  Elimination result;
  result.order.reserve(order.size());
  for (const int k : post) result.order.push_back(order[at(k)]);
  result.supernodes = merge(FundamentalSupernodes(matrix, result.order).run());
  set_parents(result.supernodes, order.size());
  return result;
}

}  // namespace weft::fast
