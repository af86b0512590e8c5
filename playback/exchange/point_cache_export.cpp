#include <weft/playback/exchange/point_cache_export.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <weft/playback/exchange/exchange_body.hpp>
#include <weft/playback/exchange/obj_file.hpp>
#include <weft/playback/exchange/point_cache.hpp>
#include <weft/playback/exchange/unfit_recording.hpp>

namespace weft::scenes {
namespace {

/// Largest deviation of a frame's time from equal spacing, as a part of the spacing: Bullet rounds its steps.
constexpr double kTimeTolerance = 1e-2;

constexpr std::string_view kNoOldFile = "weft.obj";  // folders without Weft's mark are never ours

bool is_own(std::string_view) {
  return false;
}

double frame_interval(const RecordingReader& reader) {
  const int last = reader.num_frames() - 1;
  if (last < 1) return reader.scene().world.frame_interval;
  const double first = reader.frame_time(0);
  const double interval = (reader.frame_time(last) - first) / last;
  for (int frame = 1; frame < last; ++frame) {
    const double expected = first + frame * interval;
    if (std::abs(reader.frame_time(frame) - expected) <= kTimeTolerance * interval) continue;
    throw UnfitRecording(
        fmt::format("frame {} is at t = {:.6g} s, expected {:.6g} s: a point cache has "
                    "equally spaced frames only (weft export --vtp has times)",
                    frame, reader.frame_time(frame), expected));
  }
  return interval;
}

void check_whole(const ClothState& cloth, double time) {
  if (!cloth.topology) return;
  throw UnfitRecording(
      fmt::format("cloth '{}' is torn at t = {:.6g} s, expected the same points in every "
                  "frame (weft export --vtp and --gltf write cloths that tear)",
                  cloth.name, time));
}

}  // namespace

output::OutputFolder point_cache_folder(const std::filesystem::path& path) {
  return {path, kNoOldFile, {"a point cache of Weft", is_own}};
}

PointCacheReport export_point_caches(const RecordingReader& reader,
                                     const output::OutputFolder& folder,
                                     const std::function<void(double)>& on_progress) {
  PointCacheReport report;
  report.frame_interval = frame_interval(reader);
  report.num_samples = reader.num_frames();
  std::vector<ExchangeBody> bodies = exchange_bodies(reader.scene());
  const std::vector<ExchangeBody> drawn = drawn_bodies(reader.scene(), bodies);
  bodies.insert(bodies.end(), drawn.begin(), drawn.end());
  std::vector<PointCache> caches(bodies.size());
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const SceneState state = reader.frame(frame);
    for (const ClothState& cloth : state.cloths) check_whole(cloth, state.time);
    check_finite(state, frame);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Matrix3X<double> exact = world_positions(bodies[b], state);
      const Eigen::Matrix3Xf rounded = exact.cast<float>();
      const double error = (rounded.cast<double>() - exact).cwiseAbs().maxCoeff();
      report.largest_rounding = std::max(report.largest_rounding, error);
      caches[b].samples.push_back(rounded);
    }
    if (on_progress) on_progress((frame + 1.0) / reader.num_frames());
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    folder.write(bodies[b].file_name + ".obj", obj_text(bodies[b].name, bodies[b].mesh));
    folder.write(bodies[b].file_name + ".pc2", encode_point_cache(caches[b]));
  }
  report.num_bodies = static_cast<int>(bodies.size());
  return report;
}

}  // namespace weft::scenes
