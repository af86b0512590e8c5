#pragma once

// Tested by tests/python/test_world.py, tests/python/test_tearing.py.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>
#include <btBulletDynamicsCommon.h>

#include <weft/bridge/adoption/adoption.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/bridge/cloth_body.hpp>
#include <weft/mesh/cloth_mesh.hpp>
#include <weft/mesh/cutting/tear_rule.hpp>

namespace weft::python {

/// A cloth of a world, owned by the world and by all that Python has of it.
struct ClothRecord {
  std::string name;
  std::unique_ptr<btSoftBody> body;
  bridge::Cloth handle;
  /// As the cloth is now; none of a body that was adopted.
  std::optional<ClothMesh> mesh = std::nullopt;
  bridge::ClothSettings settings = {};
  std::vector<forces::LawSpecification> laws = {};  ///< as they act
  std::optional<TearRule> tear_rule = std::nullopt;
  bool can_be_cut = false;  ///< there is room for all nodes that cuts may add
  std::vector<bridge::AdoptedProperty> adopted = {};
  std::vector<int> led_nodes = {};     ///< pinned nodes that the next step moves
  Matrix3X<double> led_targets = {};   ///< [m] where to, 3 x led_nodes.size()
  std::vector<int> forced_nodes = {};  ///< nodes that forces of the program act on in the next step
  Matrix3X<double> forces = {};        ///< [N], 3 x forced_nodes.size()
  /// How often the cloth has got other nodes, or has left its world: arrays of an earlier generation are refused.
  int generation = 0;
  bool is_removed = false;
};

/// A rigid body of a world, likewise.
struct BodyRecord {
  std::string name;
  std::shared_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> body;
  Vector3<double> offset{0, 0, 0};  ///< [m] of Bullet's origin in the frame that Python sees
  bool is_removed = false;
};

}  // namespace weft::python
