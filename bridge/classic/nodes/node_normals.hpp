#pragma once

#include <array>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// btSoftBody::updateNormals by a team, to the same bits: normals of faces, and of nodes as their sums weighted by area.
/// Bullet adds each face to its corners, which only one thread can; here each node collects from its faces, in Bullet's
/// order.
class NodeNormals {
 public:
  void update(btSoftBody& body, fast::WorkerTeam& team);

 private:
  using Corners = std::array<const btSoftBody::Node*, 3>;

  /// False if nodes or corners of faces are not those of the last time.
  [[nodiscard]] bool cross_edges(btSoftBody& body, fast::WorkerTeam& team);
  void list_faces(const btSoftBody& body);

  const btSoftBody::Node* first_node_ = nullptr;
  int num_nodes_ = 0;
  std::vector<Corners> corners_;     ///< of each face
  std::vector<int> first_of_node_;   ///< in faces_of_nodes_; one more than there are nodes
  std::vector<int> faces_of_nodes_;  ///< of each node in ascending order
  std::vector<btVector3>
      crossings_;  ///< of each face's edges: its normal times twice its area [m^2]
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
