#pragma once

#include <weft/bridge/bullet/precision.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// What decides how stiff a Bullet link of a given kLST really is.
struct LinkContext {
  double reduced_mass;  ///< [kg] 1 / (1/m_a + 1/m_b); a pinned end has 1/m = 0
  int iterations;       ///< btSoftBody::m_cfg.piterations, >= 1
  double time_step;     ///< [s], > 0
};

/// Bullet's links have no unit: kLST in [0, 1] is the fraction of a link's stretch that one visit
/// removes, and a step visits a link `iterations` times. These two functions are the exact map
/// between kLST and a stiffness.
///
/// Derivation, for one link with stretch s and reduced mass mu, time step h, n visits: Bullet moves
/// the nodes freely to s* = s + h s' (+ h^2 f / mu for an outer force f) and n visits leave s_new =
/// (1 - kLST)^n s*; the velocity is then (s_new - s) / h. An implicit Euler step of a spring with
/// stiffness k gives s_new = s* / (1 + h^2 k / mu). Both are the same step, for every s and s',
/// when
///
///   k = (mu / h^2) ((1 - kLST)^-n - 1)          kLST = 1 - (1 + k h^2 / mu)^(-1/n)
///
/// Validity: exact for one link that nobody else touches, to first order in the strain (Bullet's
/// link is a quadratic approximation of the length). In a mesh the visits of neighboring links
/// undo one another in part; the map holds there for k h^2 / mu << 1, and a softer answer must be
/// expected above. kLST = 1 is a rigid link.

/// kLST in [0, 1] for a stiffness [N/m] >= 0. Throws InvalidArgument for values out of their
/// domain.
[[nodiscard]] double link_factor_from_stiffness(double stiffness, const LinkContext& context);

/// Stiffness [N/m] of a link with kLST in [0, 1). Throws InvalidArgument for values out of their
/// domain, also for kLST = 1, which has no finite stiffness.
[[nodiscard]] double stiffness_from_link_factor(double link_factor, const LinkContext& context);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
