#include <weft/fast_solver/global_correction.hpp>

#include <utility>

#include <weft/fast_solver/correction_maker.hpp>
#include <weft/fast_solver/network_kernel.hpp>

namespace weft::fast {

GlobalCorrection::GlobalCorrection(const SymmetricMatrix& matrix, const std::vector<int>& names,
                                   int num_nodes) {
  CorrectionMaker maker(matrix, names, num_nodes);
  while (!maker.advance()) {
  }
  *this = maker.take();
}

void GlobalCorrection::add_copies(const std::vector<int>& origins) {
  for (const int origin : origins) {
    const int node = num_nodes_++;
    WeightedSums::Row row;
    refine_.for_each_term(origin, [&](int coarse, float weight) {
      row.emplace_back(coarse, weight);
      coarsen_.add_term(coarse, node, weight);
    });
    refine_.append(std::move(row));
  }
  nodes_.setZero(4, fill_up(num_nodes_));
}

std::size_t GlobalCorrection::num_bytes() const {
  return factor_.num_bytes() + inverse_.num_bytes() + coarsen_.num_bytes() + refine_.num_bytes();
}

void GlobalCorrection::set_residual(NodeRange nodes, const NodeArrays<float>& a,
                                    const NodeArrays<float>& b) {
  vector_kernel().to_fours(a.data(), b.data(), static_cast<int>(a.rows()), nodes, nodes_.data());
}

void GlobalCorrection::solve(ThreadTeam& team) {
  team.run(coarsen_.num_parts(), [&](int part) { coarsen_.multiply(part, nodes_, coarse_sums_); });
  coarsen_.add_late_terms(nodes_, coarse_sums_);
  if (inverse_.size() > 0) {
    inverse_.multiply(coarse_sums_, coarse_, team);
    return;
  }
  right_ = coarse_sums_.topRows<3>();
  factor_.solve(right_, solution_, team);
  coarse_.topRows<3>() = solution_;
}

// The last part has the copies, which come behind all nodes.
NodeRange GlobalCorrection::nodes_of(int part) const {
  NodeRange nodes = parts_[part];
  if (part == parts_.count() - 1) nodes.end = fill_up(num_nodes_);
  return nodes;
}

void GlobalCorrection::interpolate(int part, NodeArrays<float>& correction) {
  refine_.multiply(part, coarse_, nodes_);
  if (part == parts_.count() - 1) refine_.multiply_appended(coarse_, nodes_);
  vector_kernel().from_fours(nodes_.data(), static_cast<int>(correction.rows()), nodes_of(part),
                             correction.data());
}

}  // namespace weft::fast
