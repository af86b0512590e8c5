#pragma once

#include <vector>

#include <weft/validation/cases/scene_metrics.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// What the report shows of a scene: plots over time, a table per engine, pictures side by side.
/// histories: every engine, the reference last.
[[nodiscard]] Section scene_section(const SceneMetrics& metrics,
                                    const std::vector<History>& histories, bool pictures);

/// Pictures of the last frame of every engine: shaded, wireframe, strain, and the distance to the
/// reference.
[[nodiscard]] std::vector<PictureRow> scene_pictures(const SceneMetrics& metrics,
                                                     const std::vector<History>& histories);

}  // namespace weft::validation
