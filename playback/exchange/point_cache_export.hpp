#pragma once

#include <filesystem>
#include <functional>

#include <weft/scenes/output/output_folder.hpp>
#include <weft/scenes/recording/recording.hpp>

namespace weft::scenes {

/// The folder for OBJ files and point caches; belongs to Weft once it is filled.
[[nodiscard]] output::OutputFolder point_cache_folder(const std::filesystem::path& path);

struct PointCacheReport {
  int num_bodies = 0;
  int num_samples = 0;            ///< of each cache
  double frame_interval = 0.0;    ///< [s] between samples
  double largest_rounding = 0.0;  ///< [m] by which single precision moved a coordinate
};

/// Writes BODY.obj at rest and BODY.pc2 with one sample for each frame, for every body but planes. Everything is checked before
/// the first file is written. Throws UnfitRecording for a cloth that tears, whose points change, for frames that are not equally spaced in time, which a
/// point cache cannot say, and for a position that is not finite.
PointCacheReport export_point_caches(const RecordingReader& reader,
                                     const output::OutputFolder& folder,
                                     const std::function<void(double part)>& on_progress = {});

}  // namespace weft::scenes
