#include <weft/bridge/classic/nodes/node_normals.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include <weft/core/index.hpp>
#include <weft/fast_solver/threads/node_partition.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
// Bullet has no mark for a change of topology (nodes that move in memory, faces that are cut): corners are compared.
bool NodeNormals::cross_edges(btSoftBody& body, fast::WorkerTeam& team) {
  const int num_faces = body.m_faces.size();
  const bool is_known = num_nodes_ == body.m_nodes.size() && corners_.size() == at(num_faces) &&
                        (num_nodes_ == 0 || first_node_ == &body.m_nodes[0]);
  corners_.resize(at(num_faces));
  crossings_.resize(at(num_faces));
  std::array<bool, fast::WorkerTeam::kMostParts> is_same;
  is_same.fill(is_known);
  fast::run_parts(team, num_faces, [&](int range, int begin, int end) {
    bool same = is_known;
    for (int f = begin; f < end; ++f) {
      btSoftBody::Face& face = body.m_faces[f];
      Corners& corners = corners_[at(f)];
      for (std::size_t k = 0; k < 3; ++k) {
        same = same && corners[k] == face.m_n[k];
        corners[k] = face.m_n[k];
      }
      const btVector3& corner = corners[0]->m_x;
      const btVector3 crossing = btCross(corners[1]->m_x - corner, corners[2]->m_x - corner);
      crossings_[at(f)] = crossing;
      btVector3 normal = crossing;
      normal.safeNormalize();
      face.m_normal = normal;
    }
    is_same[at(range)] = same;
  });
  return std::all_of(is_same.begin(), is_same.end(), [](bool same) { return same; });
}

void NodeNormals::list_faces(const btSoftBody& body) {
  num_nodes_ = body.m_nodes.size();
  first_node_ = num_nodes_ > 0 ? &body.m_nodes[0] : nullptr;
  const auto number_of = [&](const btSoftBody::Node* node) {
    return static_cast<std::size_t>(node - first_node_);
  };
  first_of_node_.assign(at(num_nodes_) + 1, 0);
  for (const Corners& corners : corners_) {
    for (const btSoftBody::Node* node : corners) ++first_of_node_[number_of(node) + 1];
  }
  std::partial_sum(first_of_node_.begin(), first_of_node_.end(), first_of_node_.begin());
  std::vector<int> next(first_of_node_.begin(), first_of_node_.end() - 1);
  faces_of_nodes_.resize(3 * corners_.size());
  for (std::size_t face = 0; face < corners_.size(); ++face) {
    for (const btSoftBody::Node* node : corners_[face]) {
      faces_of_nodes_[at(next[number_of(node)]++)] = static_cast<int>(face);
    }
  }
}

void NodeNormals::update(btSoftBody& body, fast::WorkerTeam& team) {
  if (!cross_edges(body, team)) list_faces(body);
  fast::run_parts(team, body.m_nodes.size(), [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      btVector3 sum(0, 0, 0);
      for (int k = first_of_node_[at(i)]; k < first_of_node_[at(i) + 1]; ++k) {
        sum += crossings_[at(faces_of_nodes_[at(k)])];
      }
      const btScalar length = sum.length();
      if (length > SIMD_EPSILON) sum /= length;
      body.m_nodes[i].m_n = sum;
    }
  });
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
