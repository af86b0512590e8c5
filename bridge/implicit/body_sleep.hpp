#pragma once

// Tested by tests/bridge/implicit/fast_body_test.cpp, tests/bridge/implicit/outside_changes_test.cpp.

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/fast_settings.hpp>
#include <weft/core/state_archive.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

class ObjectTable;

/// Whether a body has come to rest and is not stepped any more, and what wakes it: a node that anybody has moved, pushed,
/// given a velocity or another mass; another gravity or wind; an object that its bounds meet, leave, or that moves
/// there; an anchor that moves; cloth that moves and meets it.
class BodySleep {
 public:
  [[nodiscard]] bool is_asleep() const { return is_asleep_; }
  [[nodiscard]] bool is_at_rest(const FastSettings& settings) const {
    return is_asleep_ || rest_time_ >= settings.sleep_time;
  }

  /// Before a step. True if the body has just woken.
  bool begin_step(const btSoftBody& body);
  /// In a step: what the body's bounds meet.
  void meet(const btCollisionObject& object, const btTransform& pose);
  /// In a step: cloth that its bounds meet.
  void notify_cloth(bool is_at_rest);
  /// After a step of time_step [s]. A body that falls asleep loses what velocities it has left.
  void end_step(btSoftBody& body, btScalar time_step, const FastSettings& settings);
  void wake();
  void serialize(StateArchive& archive, const ObjectTable& objects);

 private:
  struct Neighbor {
    const btCollisionObject* object;  ///< only compared
    btTransform pose;
  };
  [[nodiscard]] bool is_disturbed(const btSoftBody& body) const;
  void remember(const btSoftBody& body);

  bool is_asleep_ = false;
  bool meets_motion_ = false;  ///< in the present step
  double rest_time_ = 0;       ///< [s]
  std::vector<Neighbor> met_;
  // When it fell asleep:
  std::vector<Neighbor> neighbors_;
  std::vector<Neighbor> anchors_;
  std::vector<btVector3> positions_;
  std::vector<btScalar> inverse_masses_;
  btVector3 gravity_{0, 0, 0};
  btVector3 wind_{0, 0, 0};
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
