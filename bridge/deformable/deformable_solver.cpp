#include <weft/bridge/deformable/deformable_solver.hpp>

#include <string>

#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

namespace {

// In place of btSoftBody::initializeFaceTree(), which also rebuilds the tree of nodes by joining
// nodes that share a link until one is left: without links that never ends.
void build_face_tree(btSoftBody& body) {
  body.m_fdbvt.clear();
  for (int f = 0; f < body.m_faces.size(); ++f) {
    btSoftBody::Face& face = body.m_faces[f];
    const btVector3 points[] = {face.m_n[0]->m_x, face.m_n[1]->m_x, face.m_n[2]->m_x};
    face.m_leaf = body.m_fdbvt.insert(btDbvtVolume::FromPoints(points, 3), &face);
  }
}

}  // namespace

void prepare_for_deformable_world(btSoftBody& body) {
  if (body.m_links.size() > 0) {
    throw InvalidArgument("deformable world: the body has " + std::to_string(body.m_links.size()) +
                          " links, which this world ignores; expected none and a tension law");
  }
  body.m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
  body.setSelfCollision(false);
  body.forceActivationState(DISABLE_DEACTIVATION);
  for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_vn = body.m_nodes[i].m_v;
  build_face_tree(body);
}

void DeformableSolver::set_newton_iterations(int iterations) {
  if (iterations < 1) {
    throw InvalidArgument("deformable solver: newton_iterations = " + std::to_string(iterations) +
                          ", expected >= 1");
  }
  m_maxNewtonIterations = iterations;
}

// The world has told us by now whether it wants the projection; an implicit step needs it.
void DeformableSolver::predictMotion(btScalar time_step) {
  if (m_implicit && !m_useProjection) {
    m_useProjection = true;
    setStrainLimiting(true);
    setPreconditioner(btDeformableBackwardEulerObjective::Mass_preconditioner);
  }
  for (int b = 0; b < m_softBodies.size(); ++b) {
    btSoftBody& body = *m_softBodies[b];
    if (!body.isActive() || !body.m_bUpdateRtCst || body.m_links.size() > 0) continue;
    body.m_bUpdateRtCst = false;
    body.updateConstants();
    build_face_tree(body);
  }
  m_objective->m_massPreconditioner->reinitialize(true);
  btDeformableBodySolver::predictMotion(time_step);
  if (m_implicit) predict_positions(time_step);
}

void DeformableSolver::setLagrangeMultiplier() {
  if (m_implicit) {
    setProjection();
  } else {
    btDeformableBodySolver::setLagrangeMultiplier();
  }
}

// Bullet looks for contacts of an implicit step where the nodes are, one step too late; here, as in
// explicit mode, where they will be.
void DeformableSolver::predict_positions(btScalar time_step) {
  for (int b = 0; b < m_softBodies.size(); ++b) {
    btSoftBody& body = *m_softBodies[b];
    if (!body.isActive()) continue;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      body.m_nodes[i].m_q = body.m_nodes[i].m_x + time_step * body.m_nodes[i].m_v;
    }
  }
}

// Gravity moves the prediction of the bodies it was added to, free nodes only.
void DeformableSolver::add_gravity() {
  for (int f = 0; f < m_objective->m_lf.size(); ++f) {
    if (m_objective->m_lf[f]->getForceType() != BT_GRAVITY_FORCE) continue;
    const auto& gravity = static_cast<const btDeformableGravityForce&>(*m_objective->m_lf[f]);
    for (int b = 0; b < gravity.m_softBodies.size(); ++b) {
      btSoftBody& body = *gravity.m_softBodies[b];
      if (!body.isActive()) continue;
      const btVector3 change = m_dt * body.m_gravityFactor * gravity.m_gravity;
      for (int i = 0; i < body.m_nodes.size(); ++i) {
        if (body.m_nodes[i].m_im > 0) body.m_nodes[i].m_v += change;
      }
    }
  }
}

void DeformableSolver::apply_predicting_impulses() {
  for (int b = 0; b < m_softBodies.size(); ++b) {
    btSoftBody& body = *m_softBodies[b];
    if (!body.isActive()) continue;
    for (int i = 0; i < body.m_nodes.size(); ++i) {
      btSoftBody::Node& node = body.m_nodes[i];
      if (node.m_im == 0) continue;
      node.m_effectiveMass_inv = node.m_effectiveMass.inverse();
      node.m_v += node.m_effectiveMass_inv * m_residual[node.index];
    }
  }
  for (int i = 0; i < m_residual.size(); ++i) m_residual[i].setZero();
}

void DeformableSolver::applyExplicitForce() {
  if (!m_implicit) {
    btDeformableBodySolver::applyExplicitForce();
    return;
  }
  for (int b = 0; b < m_softBodies.size(); ++b) m_softBodies[b]->advanceDeformation();
  for (int f = 0; f < m_objective->m_lf.size(); ++f) {
    btDeformableLagrangianForce& force = *m_objective->m_lf[f];
    if (force.getForceType() != BT_GRAVITY_FORCE) force.addScaledForces(m_dt, m_residual);
  }
  for (int f = 0; f < m_objective->m_lf.size(); ++f) m_objective->m_lf[f]->addScaledHessian(m_dt);
  add_gravity();
  apply_predicting_impulses();
  forces_.find_explosions(m_dt);
}

void DeformableSolver::applyTransforms(btScalar time_step) {
  btDeformableBodySolver::applyTransforms(time_step);
  forces_.advance_time(static_cast<double>(time_step));
  for (int b = 0; b < m_softBodies.size(); ++b) {
    btSoftBody& body = *m_softBodies[b];
    for (int a = 0; a < body.m_deformableAnchors.size(); ++a) {
      btSoftBody::Node& node = *body.m_deformableAnchors[a].m_node;
      node.m_q = node.m_x;
    }
    if (!forces_.has_laws(body)) continue;
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_f.setZero();
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
