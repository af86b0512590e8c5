#pragma once

// Tested by tests/bridge/implicit/fast_body_test.cpp, tests/bridge/solver_checks_test.cpp.

#include <weft/fast_solver/solver_settings.hpp>

namespace weft::bridge {

/// How a body with implicit springs is stepped.
struct FastSettings {
  fast::SolverSettings solver = {};  ///< work per step, against error (docs/fast_solver.md)
  /// Second order (BDF2) while nothing touches the body; implicit Euler with contacts and at
  /// changes. Off: always implicit Euler, which takes much more energy out of a motion.
  bool is_second_order = true;
  /// A body of which no node has been faster than sleep_speed [m/s] for sleep_time [s] is not stepped any
  /// more, until something disturbs it (BodySleep).
  bool may_sleep = true;
  double sleep_speed = 0.005;  ///< [m/s] >= 0
  double sleep_time = 1.0;     ///< [s] >= 0
  /// Normals (Node::m_n, Face::m_normal) and the tree of the nodes (m_ndbvt) at the end of each step, as btSoftBody has
  /// them. Weft reads neither, and Bullet only for wind, pressure and VF_SS: bodies with these have what they need in any
  /// case. A program that needs neither saves the time; btSoftBody::updateNormals() gives normals whenever it is called.
  bool keeps_normals = true;
  bool keeps_node_tree = true;
};

/// Throws InvalidArgument for fewer than one iteration and for a speed or time that is negative or not finite.
void check(const FastSettings& settings);

}  // namespace weft::bridge
