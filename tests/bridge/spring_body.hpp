#pragma once

#include <memory>

#include <weft/bridge/deformable/deformable_world.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bridge::testing {

inline constexpr double kTimeStep = 1.0 / 128;  // [s] exact in single precision

/// num_nodes nodes of 1 kg on the x axis, 1 m apart, springs between neighbors in the edge set
/// "spring", no triangles; the first num_pinned nodes are pinned.
inline ClothMesh spring_chain(int num_nodes, int num_pinned) {
  ClothMesh mesh;
  mesh.rest_positions.setZero(3, num_nodes);
  mesh.rest_positions.row(0).setLinSpaced(num_nodes, 0.0, num_nodes - 1.0);
  mesh.triangles.resize(3, 0);
  Edges edges(2, num_nodes - 1);
  for (int e = 0; e + 1 < num_nodes; ++e) edges.col(e) << e, e + 1;
  mesh.edge_sets.push_back({"spring", edges});
  mesh.masses = VectorX<double>::Ones(num_nodes);
  for (int i = 0; i < num_pinned; ++i) mesh.pinned.push_back(i);
  return mesh;
}

inline forces::LawSpecification law(const std::string& id, const std::string& parameter,
                                    std::vector<double> values) {
  return {id, {}, {{parameter, std::move(values)}}};
}

/// A body in the world with laws attached.
inline btSoftBody& add_body(DeformableWorld& world, const ClothMesh& mesh,
                            const std::vector<forces::LawSpecification>& laws) {
  btSoftBody& body = world.add(make_cloth_body(world.info(), mesh, {}));
  world.forces().attach(body, mesh, laws);
  return body;
}

/// Moves a node before the first step: m_q is the trial position.
inline void displace(btSoftBody& body, int node, const btVector3& by) {
  body.m_nodes[node].m_x += by;
  body.m_nodes[node].m_q = body.m_nodes[node].m_x;
}

/// Sets a velocity before a step: m_vn is the velocity at the start of an implicit step.
inline void set_velocity(btSoftBody& body, int node, const btVector3& velocity) {
  body.m_nodes[node].m_v = velocity;
  body.m_nodes[node].m_vn = velocity;
}

}  // namespace weft::bridge::testing
