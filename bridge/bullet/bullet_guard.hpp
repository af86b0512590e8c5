#pragma once

// Tested by tests/bridge/solver_test.cpp.

#include <cstddef>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// What a translation unit believes Bullet looks like.
struct BulletLayout {
  std::size_t scalar_size;     ///< sizeof(btScalar)
  std::size_t soft_body_size;  ///< sizeof(btSoftBody)
  std::size_t node_size;       ///< sizeof(btSoftBody::Node)
  int version;                 ///< BT_BULLET_VERSION
};

/// The layout as the including file was compiled; inline on purpose.
[[nodiscard]] inline BulletLayout bullet_layout_here() {
  return {sizeof(btScalar), sizeof(btSoftBody), sizeof(btSoftBody::Node), BT_BULLET_VERSION};
}

/// Refuses to work with a Bullet that is not the one the bridge was compiled for. Bullet's single-
/// and double-precision libraries export the same symbols with different layouts: mixing them
/// links, and then corrupts memory without a word. Throws Error if caller differs from the bridge's
/// own layout, and if the libraries of both precisions are loaded in this process.
void require_matching_bullet(const BulletLayout& caller);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
