#pragma once

// Tested by tests/bridge/adoption/adoption_test.cpp.

#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The links of one material of a body, those of generateBendingConstraints() (m_bbending) apart.
struct LinkedEdges {
  const btSoftBody::Material* material = nullptr;
  bool is_bending = false;
  std::string name;                ///< of the edge set
  int num_links = 0;               ///< that the edge set has
  int num_left_out = 0;            ///< links between the same nodes as another one, or of no length
  double mean_reduced_mass = 0.0;  ///< 1 / (1/m_a + 1/m_b), of links that can move [kg]
};

/// A body as Weft's laws see it.
struct BodyMesh {
  ClothMesh mesh;                  ///< rest positions are where the nodes are now
  std::vector<LinkedEdges> links;  ///< one for each edge set, in the order of the body's materials
};

/// Reads nodes, faces, masses, pins and links of a body. Faces are wound alike (wound_alike()). A pinned node, which has no mass in Bullet, gets the mean of the others.
[[nodiscard]] BodyMesh mesh_of(const btSoftBody& body);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
