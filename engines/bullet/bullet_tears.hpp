#pragma once

// Tested by tests/scenes/catalog/tear_test.cpp.

#include <vector>

#include <weft/bridge/cloth_body.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/engines/bullet/bullet_bodies.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace weft::scenes {

/// The cloths of a scene that tear, in Bullet's classic world.
class BulletTears {
 public:
  /// Cloth number `cloth` of bodies; settings and laws are those it was made with.
  void add(std::size_t cloth, const ClothTear& tear, const ClothMesh& mesh,
           bridge::ClothSettings settings, std::vector<forces::LawSpecification> laws);
  /// Makes the cuts before the first step.
  void make_first_cuts(bridge::SoftBodySolver& solver, BulletBodies& bodies);
  /// Tears what is beyond its limit in bodies.state(); read_state() must follow if that is true.
  [[nodiscard]] bool tear(bridge::SoftBodySolver& solver, BulletBodies& bodies);

  /// Writes the tears so far. A reader makes the tears that the cloths of the scene do not have yet.
  void serialize(StateArchive& archive, bridge::SoftBodySolver& solver, BulletBodies& bodies);
  /// Gives torn cloths their laws anew, by their names: what their solvers know of the steps before is lost.
  void renew_laws(bridge::SoftBodySolver& solver, const BulletBodies& bodies) const;

 private:
  struct Entry {
    std::size_t cloth;
    TornCloth torn;
    bridge::ClothSettings settings;
    std::vector<forces::LawSpecification> laws;
  };
  static void apply(const Tear& tear, Entry& entry, bridge::SoftBodySolver& solver,
                    BulletBodies& bodies);

  std::vector<Entry> entries_;
};

}  // namespace weft::scenes
