#pragma once

#include <vector>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/mesh/cutting/tear.hpp>
#include <weft/mesh/cutting/tear_rule.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Tearing of a btSoftBody made by make_cloth_body() in Bullet's classic world, between two steps:
///
///   for (;;) {
///     world.stepSimulation(h, 0);
///     weft::bridge::tear(solver, *cloth, mesh, settings, laws, {.strain = 0.4});
///   }

/// Makes a cut (cut_along()) in a body that has the nodes and faces of the mesh before it.
///
/// Nodes are appended with position, velocity and all else of their origin, and their share of its
/// mass; what is pinned (m_im = 0) stays so. Faces are led to the copies. Links are made anew from
/// settings.links, with rest lengths from the mesh; the area of split nodes from their faces'.
/// Contacts are dropped: Bullet finds them anew in every step; one with set_cloth_contact() needs
/// SoftBodySolver::add_copies() afterwards. An anchor stays with the old node.
/// No rest length is taken from the shape as it is now (m_bUpdateRtCst is clear afterwards).
/// m_nodes may move in memory: pointers to nodes that the application keeps are void.
/// Throws InvalidArgument, and changes nothing, for a body with other nodes or faces than the mesh
/// had, or with tetrahedra, clusters or a pose to match.
void apply_tear(const Tear& tear, const ClothSettings& settings, btSoftBody& body);

/// The same for a body with its laws, contacts with cloth and all that the solver knows of it. Throws
/// InvalidArgument as make_laws() too; nothing changes then.
void apply_tear(const Tear& tear, const ClothSettings& settings,
                const std::vector<forces::LawSpecification>& laws, SoftBodySolver& solver,
                btSoftBody& body);

/// Looks whether a body tears now, and tears it: nodes, faces, links, and the laws, which are made
/// anew for the torn mesh; mesh becomes that. laws are those of attach(). A body without attached
/// laws is torn alike. One that has blown up is not.
/// Bits are those of the run without this call, as long as nothing tears.
/// Throws InvalidArgument as edges_to_tear(), make_laws() and apply_tear(); nothing changes then.
Tear tear(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
          const std::vector<forces::LawSpecification>& laws, const TearRule& rule);

/// The same for a blade, through the cloth as it lies now.
Tear cut(SoftBodySolver& solver, btSoftBody& body, ClothMesh& mesh, const ClothSettings& settings,
         const std::vector<forces::LawSpecification>& laws, const Blade& blade);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
