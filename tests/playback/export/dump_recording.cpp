// dump_recording RECORDING OUT.json [TIME]: what Weft says of a recording, for the page to be compared with.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include <weft/playback/export/cloth_energy.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/recording/recording.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace {

using nlohmann::json;
namespace scenes = weft::scenes;

int nearest(const scenes::RecordingReader& reader, double time) {
  int best = 0;
  for (int f = 0; f < reader.num_frames(); ++f) {
    if (std::abs(reader.frame_time(f) - time) < std::abs(reader.frame_time(best) - time)) best = f;
  }
  return best;
}

template <class Matrix>
json flat(const Matrix& matrix) {
  json values = json::array();
  for (const auto value : matrix.reshaped()) values.push_back(value);
  return values;
}

json cloth_json(const scenes::Cloth& cloth, const scenes::ClothState& state) {
  const weft::ClothMesh mesh = scenes::drawn_mesh(scenes::make_mesh(cloth), state.topology.get());
  return {{"positions", flat(state.positions)},
          {"triangles", flat(mesh.triangles)},
          {"strain", flat(scenes::node_strain(mesh, state.positions))}};
}

json frame_json(const scenes::RecordingReader& reader, int frame) {
  const scenes::SceneState state = reader.frame(frame);
  json result = {{"time", reader.frame_time(frame)}};
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    result["cloths"][state.cloths[c].name] = cloth_json(reader.scene().cloths[c], state.cloths[c]);
  }
  result["rigids"] = json::object();
  for (const scenes::RigidState& rigid : state.rigids) {
    json pose = flat(rigid.position);
    for (const double q : rigid.orientation.coeffs()) pose.push_back(q);
    result["rigids"][rigid.name] = pose;
  }
  return result;
}

json recording_json(const scenes::RecordingReader& reader, const char* time) {
  json result = {{"frames", reader.num_frames()}, {"finished", reader.finished()}};
  const int last = reader.num_frames() - 1;
  if (last < 0) return result;
  result["frame"] = frame_json(reader, time != nullptr ? nearest(reader, std::atof(time)) : last);
  for (const scenes::PlaybackMetric& metric : scenes::cloth_energies(reader)) {
    json values = json::array();
    for (const auto& sample : metric.samples) values.push_back(sample.value);
    result["metrics"][metric.name] = values;
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: dump_recording RECORDING OUT.json [TIME]\n");
    return 2;
  }
  try {
    const scenes::RecordingReader reader(argv[1]);
    std::ofstream(argv[2]) << recording_json(reader, argc > 3 ? argv[3] : nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
