#pragma once

#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// "Starts where the scene starts": the first frame of a recording that stands in for an engine, with a frame of the reference that is
/// one too late as what must fail. Engines start there by construction.
[[nodiscard]] CheckResult start_check(const CaseInfo& info, const scenes::Scene& scene,
                                      const History& recorded, const Frames& reference);

}  // namespace weft::validation
