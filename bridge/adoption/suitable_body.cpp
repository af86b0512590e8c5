#include <weft/bridge/adoption/suitable_body.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

std::optional<std::string> reason_against_implicit(const btSoftBody& body) {
  if (body.m_clusters.size() > 0) return "it has clusters";
  if (body.m_pose.m_bframe && body.m_cfg.kMT > 0) return "it is matched to a pose";
  if (body.m_cfg.timescale != btScalar(1)) return "its m_cfg.timescale is not 1";
  return std::nullopt;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
