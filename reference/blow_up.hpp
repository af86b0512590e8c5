#pragma once

#include <optional>
#include <string>

#include <weft/reference/contact/contact_model.hpp>
#include <weft/reference/system.hpp>

namespace weft::reference {

/// Where a state left the range in which numbers mean anything.
struct BlowUp {
  std::string body;    ///< of the cloth or the collider
  int node = 0;        ///< of the cloth; 0 for a collider
  std::string reason;  ///< "position is not finite", "speed 3.1e+08 m/s is over 1e+06 m/s"
};

/// Speed beyond which a state counts as blown up [m/s]: a thousand times any cloth, far below
/// overflow.
inline constexpr double kBlowUpSpeed = 1e6;
/// The same of a rigid body's rotation [rad/s]: a hundred times the fastest centrifuge.
inline constexpr double kBlowUpAngularSpeed = 1e6;

/// The first body that has blown up, in the order of the system.
[[nodiscard]] std::optional<BlowUp> find_blow_up(const System& system);

/// The first body whose motion over a step has blown up, before contact looks at it: what is not
/// finite or too fast, and a rigid body that tumbles by more than kMaxTumbling.
[[nodiscard]] std::optional<BlowUp> find_blow_up(const System& system, const SystemStep& step);

}  // namespace weft::reference
