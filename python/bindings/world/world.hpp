#pragma once

// Tested by tests/python/test_world.py, tests/python/test_lifetimes.py.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <weft/bridge/soft_world.hpp>
#include <weft/python/bindings/records.hpp>
#include <weft/python/bindings/world/soft_bodies.hpp>

namespace weft::python {

/// What the steps of one call did.
struct StepSummary {
  double largest_error = 0.0;  ///< [m] of a step of implicit springs: bridge::StepError::distance
  int unfinished_steps = 0;    ///< whose budget ended before the tolerance was met
  int num_tears = 0;           ///< nodes that tears have added
};

/// Bullet's classic soft-body world with Weft's solver, and all bodies in it. Threads: one at a time; begin() says so.
class World {
 public:
  /// gravity [m/s^2] of rigid bodies; voxel: SoftWorldSettings::distance_field_voxel [m].
  World(const Vector3<double>& gravity, double voxel);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  [[nodiscard]] const Vector3<double>& gravity() const { return gravity_; }
  [[nodiscard]] double time() const { return time_; }  ///< [s] of all steps
  [[nodiscard]] const std::vector<std::shared_ptr<ClothRecord>>& cloths() const { return cloths_; }
  [[nodiscard]] const std::vector<std::shared_ptr<BodyRecord>>& bodies() const { return bodies_; }
  [[nodiscard]] bridge::SoftBodySolver& solver() { return world_.solver(); }

  /// Throws InvalidArgument for a name that is taken or empty.
  void check_name(const std::string& name) const;
  /// Throws InvalidArgument as make_cloth() and attach_laws(); the world is as it was then.
  std::shared_ptr<ClothRecord> add_cloth(const std::string& name, const ClothMesh& mesh,
                                         const ClothOptions& options);
  /// Throws InvalidArgument as make_adopted(); the world is as it was then.
  std::shared_ptr<ClothRecord> adopt(const std::string& name, const Matrix3X<double>& vertices,
                                     const Triangles& triangles, const BulletBodyOptions& options,
                                     const bridge::AdoptionSettings& settings);
  void add(std::shared_ptr<BodyRecord> body);
  /// Takes it out; nothing happens to one that is out already.
  void remove(ClothRecord& cloth);
  /// Throws InvalidArgument for a body to which a cloth is anchored. Cloths that sleep wake.
  void remove(BodyRecord& body);

  /// One step of time_step [s] of Bullet, tears included. Throws InvalidArgument for a step out of its domain.
  void step(double time_step, StepSummary& summary);
  /// A cut by a blade, between two steps; the number of nodes that it added. Throws InvalidArgument for a cloth without room
  /// for more nodes, and as bridge::cut().
  int cut(ClothRecord& cloth, const Blade& blade);

  /// The name of a body of this world, or of one that has left it since the last step; empty for others.
  [[nodiscard]] std::string name_of(const btCollisionObject* object) const;

  /// Whether a step is in progress, on whatever thread.
  [[nodiscard]] bool is_stepping() const { return is_stepping_; }
  void set_stepping(bool is_stepping) { is_stepping_ = is_stepping; }

 private:
  void lead_pins(double time_step);
  void place_pins(double time_step);
  void tear_cloths(StepSummary& summary);
  void summarize(StepSummary& summary);

  Vector3<double> gravity_;
  double time_ = 0.0;
  bridge::SoftWorld world_;
  std::vector<std::shared_ptr<ClothRecord>> cloths_;
  std::vector<std::shared_ptr<BodyRecord>> bodies_;
  /// Left the world; until the end of the next step contacts name them.
  std::vector<std::shared_ptr<BodyRecord>> removed_;
  /// Caches of Bullet and Weft know shapes by their address, which no other shape may get.
  std::vector<std::shared_ptr<btCollisionShape>> removed_shapes_;
  std::atomic<bool> is_stepping_ = false;
};

}  // namespace weft::python
