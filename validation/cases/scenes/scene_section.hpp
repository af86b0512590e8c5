#pragma once

// Tested by tests/apps/CMakeLists.txt.

#include <vector>

#include <weft/validation/cases/scenes/scene_metrics.hpp>
#include <weft/validation/report/report.hpp>

namespace weft::validation {

/// What the report shows of a scene: plots over time, a table per engine, pictures side by side.
/// histories: every engine, the reference last.
[[nodiscard]] Section scene_section(const SceneMetrics& metrics,
                                    const std::vector<History>& histories, bool pictures);

/// Pictures of every engine on the way and at the end, its strain and, without a view in 3D that shows it, its
/// distance to the reference; the reference's wireframe.
[[nodiscard]] std::vector<PictureRow> scene_pictures(const SceneMetrics& metrics,
                                                     const std::vector<History>& histories,
                                                     bool has_view);

/// The reference's cloth in motion, with the distance of every engine on it: one view, or none if there
/// is nothing to compare or the cloth is torn.
[[nodiscard]] std::vector<DistanceView> scene_distance_views(const SceneMetrics& metrics,
                                                             const std::vector<History>& histories);

}  // namespace weft::validation
