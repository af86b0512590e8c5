#pragma once

// Tested by tests/fast_solver/implicit_solver_test.cpp, tests/bridge/implicit/fast_body_impact_test.cpp.

#include <cstddef>
#include <vector>

#include <weft/fast_solver/linked_body.hpp>
#include <weft/fast_solver/network/node_arrays.hpp>

namespace weft::fast {

/// A vector of all bodies: a member of each.
template <class Body>
using BodyVector = typename Body::Floats6 Body::*;

template <class Body>
Body& body_of(const BodyLink& link, std::vector<Body>& bodies) {
  return bodies[static_cast<std::size_t>(link.body)];
}

/// Adds each linked node's part of a motion of its body to its row, and the whole motion to a dragged node's.
template <class Body>
void add_carried(const std::vector<BodyLink>& links, std::vector<Body>& bodies,
                 BodyVector<Body> motion, NodeArrays<float>& displacements) {
  for (const BodyLink& link : links) {
    displacements.row(link.node) += link.motion_carried(body_of(link, bodies).*motion).transpose();
  }
}

/// The transpose for one body: the rows of nodes that it carries.
inline void gather_carried(const std::vector<BodyLink>& links, int body,
                           const NodeArrays<float>& forces, BodyLink::Vector6& sum) {
  for (const BodyLink& link : links) {
    if (link.body == body) link.add_force_carried(at_node(forces, link.node), sum);
  }
}

/// Adds the rows of linked nodes to the forces on their bodies: the transpose of what links enforce.
template <class Body>
void gather(const std::vector<BodyLink>& links, const NodeArrays<float>& forces,
            std::vector<Body>& bodies, BodyVector<Body> sum) {
  for (const BodyLink& link : links) {
    link.add_force(at_node(forces, link.node), body_of(link, bodies).*sum);
  }
}

/// The friction of nodes that slide on bodies, a drag between both. drag: of each node [N/m].
template <class Body, class Drags>
void add_drags(const std::vector<BodyLink>& links, const Drags& drag,
               const NodeArrays<float>& displacements, BodyVector<Body> motion,
               NodeArrays<float>& product, std::vector<Body>& bodies,
               BodyVector<Body> body_product) {
  for (const BodyLink& link : links) {
    if (!link.is_dragged) continue;
    Body& body = body_of(link, bodies);
    const Vector3<float> slip =
        link.along_surface(at_node(displacements, link.node) - link.motion_there(body.*motion));
    const Vector3<float> force = static_cast<float>(drag[link.node]) * slip;
    product.row(link.node) += force.transpose();
    link.add_force_there(-force, body.*body_product);
  }
}

/// The bodies' part of the preconditioner: corrections for their residuals with those of the nodes that they carry along.
template <class Body>
void correct_bodies(const std::vector<BodyLink>& links, const NodeArrays<float>& residual,
                    std::vector<Body>& bodies) {
  for (Body& body : bodies) body.carried_residual = body.residual;
  for (const BodyLink& link : links) {
    if (!link.is_dragged) continue;
    link.add_force_there(at_node(residual, link.node), body_of(link, bodies).carried_residual);
  }
  for (Body& body : bodies) body.correction = body.stiffness.solve(body.carried_residual);
}

}  // namespace weft::fast
