#include <weft/bridge/tearing.hpp>

#include <string>
#include <utility>

#include <weft/bridge/cloth_links.hpp>
#include <weft/bridge/node_state.hpp>
#include <weft/custom_forces/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

void require(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("tearing: " + message);
}

int index_of(const btSoftBody& body, const btSoftBody::Node* node) {
  return static_cast<int>(node - &body.m_nodes[0]);
}

int num_before(const Tear& tear) {
  return tear.mesh.num_nodes() - static_cast<int>(tear.origins.size());
}

/// The node before the cut.
int origin_of(const Tear& tear, int node) {
  const int old = num_before(tear);
  return node < old ? node : tear.origins[static_cast<std::size_t>(node - old)];
}

void check(const Tear& tear, const btSoftBody& body) {
  require(body.m_nodes.size() == num_before(tear),
          std::to_string(body.m_nodes.size()) + " nodes in the body, expected " +
              std::to_string(num_before(tear)) + " as in the mesh");
  require(body.m_faces.size() == tear.mesh.triangles.cols(),
          std::to_string(body.m_faces.size()) + " faces in the body, expected " +
              std::to_string(tear.mesh.triangles.cols()) + " as in the mesh");
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      require(index_of(body, body.m_faces[f].m_n[corner]) ==
                  origin_of(tear, tear.mesh.triangles(corner, f)),
              "face " + std::to_string(f) + " of the body has other nodes than in the mesh");
    }
  }
  require(body.m_tetras.size() == 0, "the body has tetrahedra, expected cloth");
  require(body.m_clusters.size() == 0, "the body has clusters, expected none");
  require(!body.m_pose.m_bvolume && !body.m_pose.m_bframe,
          "the body has a pose to match, expected none");
}

void append_nodes(const Tear& tear, btSoftBody& body) {
  for (const int origin : tear.origins) {
    const btVector3 place = body.m_nodes[origin].m_x;  // a copy: the nodes may move in memory
    body.appendNode(place, 1);
    btSoftBody::Node& node = body.m_nodes[body.m_nodes.size() - 1];
    btDbvtNode* const leaf = node.m_leaf;
    node = body.m_nodes[origin];
    node.m_leaf = leaf;
    node.m_battach = 0;
  }
  const auto set_mass = [&](int node) {
    btSoftBody::Node& n = body.m_nodes[node];
    if (n.m_im > 0) n.m_im = 1 / static_cast<btScalar>(tear.mesh.masses[node]);
  };
  for (std::size_t k = 0; k < tear.origins.size(); ++k) {
    set_mass(tear.origins[k]);
    set_mass(num_before(tear) + static_cast<int>(k));
  }
}

void lead_faces(const Tear& tear, btSoftBody& body) {
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      body.m_faces[f].m_n[corner] = &body.m_nodes[tear.mesh.triangles(corner, f)];
    }
  }
}

/// As btSoftBody::updateArea(), which would measure the shape as it is now.
void update_areas(const Tear& tear, btSoftBody& body) {
  std::vector<bool> is_split(static_cast<std::size_t>(body.m_nodes.size()), false);
  for (std::size_t k = 0; k < tear.origins.size(); ++k) {
    is_split[static_cast<std::size_t>(tear.origins[k])] = true;
    is_split[static_cast<std::size_t>(num_before(tear)) + k] = true;
  }
  std::vector<int> counts(is_split.size(), 0);
  for (std::size_t i = 0; i < is_split.size(); ++i) {
    if (is_split[i]) body.m_nodes[static_cast<int>(i)].m_area = 0;
  }
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (const int node : tear.mesh.triangles.col(f)) {
      if (!is_split[static_cast<std::size_t>(node)]) continue;
      body.m_nodes[node].m_area += btFabs(body.m_faces[f].m_ra);
      ++counts[static_cast<std::size_t>(node)];
    }
  }
  for (std::size_t i = 0; i < is_split.size(); ++i) {
    if (counts[i] > 0) body.m_nodes[static_cast<int>(i)].m_area /= static_cast<btScalar>(counts[i]);
  }
}

Matrix3X<double> positions_of(const btSoftBody& body) {
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  read_nodes(body, positions, velocities);
  return positions.cast<double>();
}

Tear part(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
          const std::vector<forces::LawSpecification>& laws, const Edges& edges) {
  if (edges.cols() == 0) return {mesh, {}};
  Tear tear = cut_along(mesh, edges);
  if (!tear.any()) return tear;
  // Laws that do not fit are noticed before the body is touched.
  forces::LawSet<btScalar> new_laws = make_laws(tear.mesh, laws);
  apply_tear(tear, settings, body);
  solver.add_copies(body, tear.origins);
  if (solver.is_fast(body)) {
    solver.replace_laws(body, tear.mesh, laws);
  } else if (solver.has_laws(body)) {
    solver.replace_laws(body, std::move(new_laws), tear.mesh.masses.cast<btScalar>());
  }
  mesh = tear.mesh;
  return tear;
}

}  // namespace

void apply_tear(const Tear& tear, const ClothSettings& settings, btSoftBody& body) {
  check(tear, body);
  // Contacts point to nodes that are about to move in memory.
  body.m_rcontacts.resizeNoInitialize(0);
  body.m_scontacts.resizeNoInitialize(0);
  append_nodes(tear, body);
  lead_faces(tear, body);
  body.m_links.resizeNoInitialize(0);
  append_links(tear.mesh, settings, body);
  body.updateLinkConstants();
  update_areas(tear, body);
  body.updateNormals();
  body.m_bUpdateRtCst = false;
}

Tear tear(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
          const std::vector<forces::LawSpecification>& laws, const TearRule& rule) {
  if (solver.blow_up(body)) return {mesh, {}};
  return part(solver, body, mesh, settings, laws, edges_to_tear(mesh, positions_of(body), rule));
}

Tear cut(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
         const std::vector<forces::LawSpecification>& laws, const Blade& blade) {
  if (solver.blow_up(body)) return {mesh, {}};
  return part(solver, body, mesh, settings, laws, edges_under(blade, mesh, positions_of(body)));
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
