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

/// The reference's cloth in motion, with the distance of every engine on it: one view, or none if there
/// is nothing to compare or the cloth is torn.
[[nodiscard]] std::vector<DistanceView> scene_distance_views(const SceneMetrics& metrics,
                                                             const std::vector<History>& histories);

}  // namespace weft::validation
