#pragma once

// Tested by tests/bridge/deformable/deformable_forces_test.cpp.

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <weft/bridge/classic/body_life.hpp>
#include <weft/bridge/classic/law_attachment.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The laws of one body of the deformable world, with the memory they need. DeformableForces has one
/// for each body.
struct DeformableAttachment {
  using Stack = btAlignedObjectArray<btVector3>;
  using NodeVector = btVector3 btSoftBody::Node::*;

  btSoftBody* body;
  std::shared_ptr<BodyLife> life;
  forces::LawSet<btScalar> laws;
  FollowedMasses followed;
  Matrix3X<btScalar> positions;
  Matrix3X<btScalar> velocities;
  Matrix3X<btScalar> forces;
  Matrix3X<btScalar> direction;
  Matrix3X<btScalar> still_positions;  ///< where still_forces were evaluated
  Matrix3X<btScalar> still_forces;     ///< f(x, 0) [N]
  Matrix3X<btScalar> no_velocities;
  std::vector<std::vector<int>> colors;  ///< see node_colors(); empty if the mesh is not known
  std::optional<BodyBlowUp> blow_up;
  bool is_reported = false;  ///< to DeformableForces::set_on_blow_up()
  double time = 0.0;         ///< [s] of the steps since the body was attached
  double still_time = 0.0;   ///< when still_forces were evaluated [s]

  [[nodiscard]] forces::State<btScalar> state() const {
    return {positions, velocities, followed.values(), time};
  }
  [[nodiscard]] bool is_movable(int node) const { return body->m_nodes[node].m_im > 0; }
  /// Reads m_v and either m_x or m_q.
  void read(NodeVector position);
  /// forces = f(x, v). False if the state or a force is not finite; the body is then frozen.
  bool evaluate();
  /// still_forces = f(x, 0), unless they are known for these positions and time; as
  /// evaluate().
  bool evaluate_still();
  /// forces = f(x, v) - f(x, 0): zero to the last bit where nothing depends on velocity.
  bool evaluate_velocity_part();
  /// out += scale forces, and scale m_f, for the nodes that can move.
  void write(btScalar scale, Stack& out) const;
  void write_node_forces(btScalar scale, Stack& out) const;
  /// Adds the part of the diagonal blocks of -h^2 df/dx - h df/dv that makes a node heavier to
  /// m_effectiveMass, if anything rigid is near.
  void add_effective_mass(btScalar time_step);
  /// Speed [m/s] to which Bullet's explicit step clamps: the diagonal of the body's bounds per step.
  [[nodiscard]] double clamp_speed(btScalar time_step) const;
  /// The first node that a step of time_step [s] at its velocity takes beyond what the distance field
  /// of the world covers: a billion voxels from the origin.
  [[nodiscard]] std::optional<BodyBlowUp> beyond_distance_field(btScalar time_step) const;
  /// Reports, stops the body and takes it out of the simulation.
  void explode(int node, std::string reason);
  /// work(), whose exceptions explode the body and leave no step half-way. False if there was one.
  template <class Work>
  bool guard(const Work& work) {
    try {
      work();
      return true;
    } catch (const std::exception& error) {
      explode(-1, error.what());
    } catch (...) {
      explode(-1, "an exception that is no std::exception");
    }
    return false;
  }

 private:
  bool evaluate_at(const Matrix3X<btScalar>& at_velocities, Matrix3X<btScalar>& result);
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
