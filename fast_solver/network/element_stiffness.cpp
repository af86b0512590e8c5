#include <weft/fast_solver/network/element_stiffness.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include <weft/core/index.hpp>

namespace weft::fast {

void ElementStiffness::set_elements(const Elements& elements, int num_nodes) {
  elements_ = elements;
  gradients_.setZero(12, elements.cols());
  strains_.assign(at(elements.cols()), 0);
  first_.assign(at(num_nodes) + 1, 0);
  for (const int node : elements.reshaped()) ++first_[at(node) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  corners_.resize(at(elements.size()));
  std::vector<int> next = first_;
  for (int place = 0; place < static_cast<int>(elements.size()); ++place) {
    corners_[at(next[at(elements(place % 4, place / 4))]++)] = place;
  }
}

void ElementStiffness::find_strains(int part, int num_parts,
                                    const NodeArrays<float>& displacements) {
  const auto count = static_cast<std::int64_t>(elements_.cols());
  const Eigen::Index rows = displacements.rows();
  const float* const x = displacements.data();
  for (Eigen::Index e = count * part / num_parts; e < count * (part + 1) / num_parts; ++e) {
    const float* const gradient = gradients_.data() + 12 * e;
    float sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const float* const of_node = x + elements_(corner, e);
      for (int axis = 0; axis < 3; ++axis) {
        sum += gradient[3 * corner + axis] * of_node[axis * rows];
      }
    }
    strains_[at(e)] = sum;
  }
}

// Nodes behind the last are padding.
int ElementStiffness::last_of(NodeRange nodes) const {
  return std::min(nodes.end, static_cast<int>(first_.size()) - 1);
}

void ElementStiffness::add_products(NodeRange nodes, NodeArrays<float>& product) const {
  for (int node = nodes.begin; node < last_of(nodes); ++node) {
    Vector3<float> sum = Vector3<float>::Zero();
    for (int k = first_[at(node)]; k < first_[at(node) + 1]; ++k) {
      const int place = corners_[at(k)];
      sum += strains_[at(place / 4)] * gradients_.col(place / 4).segment<3>(3 * (place % 4));
    }
    product.row(node) += sum.transpose();
  }
}

void ElementStiffness::add_blocks(NodeRange nodes, BlockArrays& blocks) const {
  for (int node = nodes.begin; node < last_of(nodes); ++node) {
    for (int k = first_[at(node)]; k < first_[at(node) + 1]; ++k) {
      const int place = corners_[at(k)];
      const Vector3<float> g = gradients_.col(place / 4).segment<3>(3 * (place % 4));
      blocks.row(node) += Eigen::Matrix<float, 1, 6>(g[0] * g[0], g[1] * g[1], g[2] * g[2],
                                                     g[0] * g[1], g[1] * g[2], g[2] * g[0]);
    }
  }
}

}  // namespace weft::fast
