#include <weft/bridge/tearing.hpp>

#include <string>
#include <utility>

#include <weft/bridge/classic/cloth_links.hpp>
#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/classic/torn_laws.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

void require_tearing(bool ok, const std::string& message) {
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
  require_tearing(body.m_nodes.size() == num_before(tear),
                  std::to_string(body.m_nodes.size()) + " nodes in the body, expected " +
                      std::to_string(num_before(tear)) + " as in the mesh");
  require_tearing(body.m_faces.size() == tear.mesh.triangles.cols(),
                  std::to_string(body.m_faces.size()) + " faces in the body, expected " +
                      std::to_string(tear.mesh.triangles.cols()) + " as in the mesh");
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const int expected = origin_of(tear, tear.mesh.triangles(corner, f));
      if (body.m_faces[f].m_n[corner] == &body.m_nodes[expected]) continue;
      throw InvalidArgument("tearing: face " + std::to_string(f) +
                            " of the body has other nodes than in the mesh");
    }
  }
  require_tearing(body.m_tetras.size() == 0, "the body has tetrahedra, expected cloth");
  require_tearing(body.m_clusters.size() == 0, "the body has clusters, expected none");
  require_tearing(!body.m_pose.m_bvolume && !body.m_pose.m_bframe,
                  "the body has a pose to match, expected none");
}

/// Moves the nodes to where there is room for some more tears. Bullet would take twice the memory, and all nodes
/// would have to be copied there at once; links and faces are led to their nodes afterwards.
void make_room(int num_nodes, btSoftBody& body) {
  if (num_nodes <= body.m_nodes.capacity()) return;
  std::vector<int> anchored;
  for (int a = 0; a < body.m_anchors.size(); ++a) {
    anchored.push_back(index_of(body, body.m_anchors[a].m_node));
  }
  std::vector<int> anchored_to_links;
  for (int a = 0; a < body.m_deformableAnchors.size(); ++a) {
    anchored_to_links.push_back(index_of(body, body.m_deformableAnchors[a].m_node));
  }
  std::vector<int> noted;
  for (int i = 0; i < body.m_notes.size(); ++i) {
    for (int k = 0; k < body.m_notes[i].m_rank; ++k) {
      noted.push_back(index_of(body, body.m_notes[i].m_nodes[k]));
    }
  }
  body.m_nodes.reserve(num_nodes + num_nodes / 8);
  for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_leaf->data = &body.m_nodes[i];
  for (int a = 0; a < body.m_anchors.size(); ++a) {
    body.m_anchors[a].m_node = &body.m_nodes[anchored[static_cast<std::size_t>(a)]];
  }
  for (int a = 0; a < body.m_deformableAnchors.size(); ++a) {
    body.m_deformableAnchors[a].m_node =
        &body.m_nodes[anchored_to_links[static_cast<std::size_t>(a)]];
  }
  auto next = noted.begin();
  for (int i = 0; i < body.m_notes.size(); ++i) {
    for (int k = 0; k < body.m_notes[i].m_rank; ++k) {
      body.m_notes[i].m_nodes[k] = &body.m_nodes[*next++];
    }
  }
}

void append_nodes(const Tear& tear, btSoftBody& body) {
  make_room(tear.mesh.num_nodes(), body);
  for (const int origin : tear.origins) {
    const btVector3 position = body.m_nodes[origin].m_x;  // a copy: the nodes may move in memory
    body.appendNode(position, 1);
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

/// Areas and normals of the nodes that were split: as btSoftBody::updateArea(), which would measure the shape as
/// it is now, and as btSoftBody::updateNormals(), which would go through all nodes.
void update_split_nodes(const Tear& tear, btSoftBody& body) {
  std::vector<int> counts(static_cast<std::size_t>(body.m_nodes.size()), -1);  // -1: not split
  std::vector<int> split = tear.origins;
  for (int node = num_before(tear); node < body.m_nodes.size(); ++node) split.push_back(node);
  for (const int node : split) {
    counts[static_cast<std::size_t>(node)] = 0;
    body.m_nodes[node].m_area = 0;
    body.m_nodes[node].m_n.setZero();
  }
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (const int node : tear.mesh.triangles.col(f)) {
      if (counts[static_cast<std::size_t>(node)] < 0) continue;
      const btSoftBody::Face& face = body.m_faces[f];
      body.m_nodes[node].m_area += btFabs(face.m_ra);
      body.m_nodes[node].m_n +=
          btCross(face.m_n[1]->m_x - face.m_n[0]->m_x, face.m_n[2]->m_x - face.m_n[0]->m_x);
      ++counts[static_cast<std::size_t>(node)];
    }
  }
  for (const int node : split) {
    int& count = counts[static_cast<std::size_t>(node)];
    if (count > 0) body.m_nodes[node].m_area /= static_cast<btScalar>(count);
    if (count > 0) body.m_nodes[node].m_n.safeNormalize();
    count = 0;  // a node with several copies is there more than once
  }
}

Matrix3X<double> positions_of(const btSoftBody& body) {
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  read_nodes(body, positions, velocities);
  return positions.cast<double>();
}

/// The same tear, of the body and the mesh too.
Tear apply(Tear tear, SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh,
           const ClothSettings& settings, const std::vector<forces::LawSpecification>& laws) {
  if (!tear.any()) return tear;
  apply_tear(tear, settings, laws, solver, body);
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
  update_split_nodes(tear, body);
  body.m_bUpdateRtCst = false;
}

void apply_tear(const Tear& tear, const ClothSettings& settings,
                const std::vector<forces::LawSpecification>& laws, SoftBodySolver& solver,
                btSoftBody& body) {
  // Laws that do not fit are noticed before the body is touched.
  TornLaws new_laws;
  const bool has_laws = solver.has_laws(body);
  if (has_laws) new_laws = solver.laws_after(body, tear, laws);
  apply_tear(tear, settings, body);
  solver.add_copies(body, tear.origins);
  if (has_laws) solver.replace_laws(body, tear, std::move(new_laws));
}

Tear tear(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
          const std::vector<forces::LawSpecification>& laws, const TearRule& rule) {
  if (solver.blow_up(body)) return {mesh, {}};
  return apply(tear_now(mesh, positions_of(body), rule), solver, body, mesh, settings, laws);
}

Tear cut(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
         const std::vector<forces::LawSpecification>& laws, const Blade& blade) {
  if (solver.blow_up(body)) return {mesh, {}};
  return apply(cut_along(mesh, edges_under(blade, mesh, positions_of(body))), solver, body, mesh,
               settings, laws);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
