#pragma once

#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Follows the program's changes to the links of a body whose springs are solved for in their place. A new rest length
/// (btSoftBody::Link::m_rl) is followed by the spring between the same nodes. Links that come or go have no spring that
/// could follow.
class FollowedLinks {
 public:
  /// The nodes of a link whose rest length has changed.
  struct Change {
    int first = 0;
    int second = 0;
    double rest_length = 0;  ///< [m]
  };

  /// The links as they are now are those that springs stand in for.
  void note(const btSoftBody& body);
  /// To be noted by the next changes(): the body has been torn.
  void forget() { is_noted_ = false; }
  /// Changes since the last call, in the order of links. Valid until the next call.
  [[nodiscard]] const std::vector<Change>& changes(const btSoftBody& body);
  /// The rest lengths that springs have, for a body whose links Bullet has just measured anew (m_bUpdateRtCst): after setMass()
  /// alone it would take a stretched link to be at rest.
  void restore(btSoftBody& body) const;
  /// Why springs do not stand in for the links any more; nothing if they do.
  [[nodiscard]] std::optional<std::string> reason_against(const btSoftBody& body) const;

 private:
  bool is_noted_ = false;
  std::vector<btScalar> rest_lengths_;  ///< of each link [m]
  int unusable_ = -1;                   ///< the first link whose rest length no spring can have
  std::vector<Change> changes_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
