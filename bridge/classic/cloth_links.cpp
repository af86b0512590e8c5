#include <weft/bridge/classic/cloth_links.hpp>

#include <map>

#include <weft/bridge/link_stiffness.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

double inverse_mass(const btSoftBody& body, int node) {
  return static_cast<double>(body.m_nodes[node].m_im);
}

/// The first material is the body's own, which an application may change.
btSoftBody::Material& material_of(btScalar factor, btSoftBody& body) {
  for (int i = 1; i < body.m_materials.size(); ++i) {
    if (body.m_materials[i]->m_kLST == factor) return *body.m_materials[i];
  }
  btSoftBody::Material& material = *body.appendMaterial();
  material.m_kLST = factor;
  return material;
}

/// In Bullet's precision, as Bullet measures it.
btScalar rest_length(const ClothMesh& mesh, int a, int b) {
  const auto position = [&](int node) {
    const Vector3<btScalar> x = mesh.rest_positions.col(node).cast<btScalar>();
    return btVector3(x[0], x[1], x[2]);
  };
  return (position(a) - position(b)).length();
}

}  // namespace

void append_links(const ClothMesh& mesh, const ClothSettings& settings, btSoftBody& body) {
  for (const LinkSet& set : settings.links) {
    std::vector<std::string> names = set.edge_sets;
    if (names.empty()) {
      for (const EdgeSet& edge_set : mesh.edge_sets) names.push_back(edge_set.name);
    }
    const Edges edges = mesh.edges_of(names);
    // Links between nodes of the same masses share a material: a grid has a handful.
    std::map<double, btSoftBody::Material*> materials;
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      const double inverse_sum = inverse_mass(body, edges(0, e)) + inverse_mass(body, edges(1, e));
      if (inverse_sum == 0.0) continue;  // between two pinned nodes nothing can move
      auto [entry, is_new] = materials.try_emplace(inverse_sum, nullptr);
      if (is_new) {
        const double factor = link_factor_from_stiffness(
            set.stiffness, {1.0 / inverse_sum, settings.position_iterations, settings.time_step});
        entry->second = &material_of(static_cast<btScalar>(factor), body);
      }
      body.appendLink(edges(0, e), edges(1, e), entry->second);
      btSoftBody::Link& link = body.m_links[body.m_links.size() - 1];
      link.m_rl = rest_length(mesh, edges(0, e), edges(1, e));
      link.m_c1 = link.m_rl * link.m_rl;  // updateLinkConstants() leaves this one as it is
    }
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
