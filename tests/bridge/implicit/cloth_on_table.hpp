#pragma once

#include <cmath>
#include <vector>

#include "tests/bridge/fast_scene.hpp"

namespace weft::bridge {

inline constexpr double kGravityOfEarth = 9.81;  // [m/s^2]

inline double speed_of(const btRigidBody& body) {
  return static_cast<double>(body.getLinearVelocity().length());
}

inline double height_of(const btRigidBody& body) {
  return static_cast<double>(body.getCenterOfMassPosition().y());
}

inline double energy_of(const btRigidBody& body) {
  const auto mass = static_cast<double>(body.getMass());
  return 0.5 * mass * speed_of(body) * speed_of(body) + mass * kGravityOfEarth * height_of(body);
}

/// A cloth of 0.2 kg on a table, whose top is as far below it as the margins of both are wide.
class Table {
 public:
  explicit Table(double stiffness, double friction_of_table = 0.3)
      : scene_(cloth(21, 0.8, 0, 0.2), {kGravity, law("tension", "stiffness", stiffness)}, 1.0) {
    table_ = &scene_.add(box(1.6, 0.04, 0.6), 0, at(0, kTop - 0.04, 0));
    table_->setFriction(btScalar(friction_of_table));
  }
  btRigidBody& add_box(double mass, double friction = 0.3) {
    btRigidBody& body = scene_.add(box(0.1, 0.1, 0.1), mass, at(0.03, 0.1 + kMargin, 0.02));
    body.setFriction(btScalar(friction));
    return body;
  }
  Scene& scene() { return scene_; }
  /// [N] That the table bears in a step.
  double load(double time_step) {
    double sum = 0;
    for (const NodeContact& contact : scene_.solver().rigid_contacts(scene_.body())) {
      if (contact.object == table_) sum += static_cast<double>(contact.impulse.y());
    }
    return sum / time_step;
  }
  /// Pulls one edge along the table.
  void pull(double velocity, double time_step, double time) {
    std::vector<int> edge;
    for (int i = 0; i < scene_.body().m_nodes.size(); ++i) {
      if (scene_.body().m_nodes[i].m_x.x() > 0.39) edge.push_back(i);
    }
    for (const int i : edge) scene_.body().setMass(i, 0);
    const int num_steps = static_cast<int>(std::lround(time / time_step));
    for (int step = 0; step < num_steps; ++step) {
      for (const int i : edge) {
        scene_.body().m_nodes[i].m_x += btVector3(btScalar(velocity * time_step), 0, 0);
      }
      scene_.step(1, time_step);
    }
  }
  static constexpr double kTop = -kMargin;

 private:
  Scene scene_;
  btRigidBody* table_;
};

}  // namespace weft::bridge
