#pragma once

// Tested by tests/bridge/snapshot_test.cpp.

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/core/state_archive.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// The objects of a world by their numbers, because an address means nothing to another process.
class ObjectTable {
 public:
  explicit ObjectTable(const btCollisionWorld& world) : objects_(world.getCollisionObjectArray()) {}

  /// A reference to an object of the world, or to none: also to one that has left it, which nothing meets any more.
  void serialize(StateArchive& archive, const btCollisionObject*& object) const {
    int number = number_of(object);
    archive.value(number);
    if (!archive.is_reading()) return;
    if (number < -1 || number >= objects_.size()) {
      archive.refuse("object " + std::to_string(number) + ", expected one of the " +
                     std::to_string(objects_.size()) + " of the world");
    }
    object = number < 0 ? nullptr : objects_[number];
  }

 private:
  // By comparison alone: the object may have been deleted.
  [[nodiscard]] int number_of(const btCollisionObject* object) const {
    for (int i = 0; i < objects_.size(); ++i) {
      if (objects_[i] == object) return i;
    }
    return -1;
  }

  const btCollisionObjectArray& objects_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
