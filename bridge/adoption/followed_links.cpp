#include <weft/bridge/adoption/followed_links.hpp>

#include <cmath>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void FollowedLinks::note(const btSoftBody& body) {
  is_noted_ = true;
  rest_lengths_.resize(static_cast<std::size_t>(body.m_links.size()));
  for (int l = 0; l < body.m_links.size(); ++l) {
    rest_lengths_[static_cast<std::size_t>(l)] = body.m_links[l].m_rl;
  }
}

const std::vector<FollowedLinks::Change>& FollowedLinks::changes(const btSoftBody& body) {
  changes_.clear();
  unusable_ = -1;
  const auto num_links = static_cast<std::size_t>(body.m_links.size());
  if (!is_noted_) note(body);
  if (rest_lengths_.size() != num_links) return changes_;  // reason_against() says so
  for (std::size_t l = 0; l < num_links; ++l) {
    const btSoftBody::Link& link = body.m_links[static_cast<int>(l)];
    if (link.m_rl == rest_lengths_[l]) continue;
    if (!(link.m_rl > 0) || !std::isfinite(link.m_rl)) {
      if (unusable_ < 0) unusable_ = static_cast<int>(l);
      continue;
    }
    rest_lengths_[l] = link.m_rl;
    const btSoftBody::Node* const nodes = &body.m_nodes[0];
    changes_.push_back({static_cast<int>(link.m_n[0] - nodes),
                        static_cast<int>(link.m_n[1] - nodes), static_cast<double>(link.m_rl)});
  }
  return changes_;
}

void FollowedLinks::restore(btSoftBody& body) const {
  if (!is_noted_ || rest_lengths_.size() != static_cast<std::size_t>(body.m_links.size())) return;
  for (int l = 0; l < body.m_links.size(); ++l) {
    body.m_links[l].m_rl = rest_lengths_[static_cast<std::size_t>(l)];
  }
  body.updateLinkConstants();
}

std::optional<std::string> FollowedLinks::reason_against(const btSoftBody& body) const {
  if (!is_noted_) return std::nullopt;
  const auto num_links = static_cast<std::size_t>(body.m_links.size());
  if (rest_lengths_.size() != num_links) {
    return "it has " + std::to_string(num_links) + " links, expected the " +
           std::to_string(rest_lengths_.size()) +
           " that springs stand in for; call replace_laws() with a mesh that has the others";
  }
  if (unusable_ < 0) return std::nullopt;
  return "link " + std::to_string(unusable_) +
         " has m_rl = " + std::to_string(body.m_links[unusable_].m_rl) +
         " [m], expected > 0 and finite";
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
