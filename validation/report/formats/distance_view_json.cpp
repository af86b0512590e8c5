#include <string>

#include <weft/validation/report/formats/base64.hpp>
#include <weft/validation/report/formats/distance_view_json.hpp>
#include <weft/validation/report/formats/json_number.hpp>

namespace weft::validation {
namespace {

using Json = nlohmann::ordered_json;

Json quantized_json(const Quantized& values) {
  return {{"lowest", values.lowest},
          {"highest", values.highest},
          {"steps_base64", to_base64(values.bytes)}};
}

Json frames_json(const std::vector<Quantized>& frames) {
  Json array = Json::array();
  for (const Quantized& frame : frames) array.push_back(quantized_json(frame));
  return array;
}

std::string words(const std::vector<int>& values) {
  std::string bytes;
  bytes.reserve(2 * values.size());
  for (const int value : values) {
    const auto word = static_cast<unsigned>(value);
    bytes += static_cast<char>(word & 0xFFU);
    bytes += static_cast<char>(word >> 8U & 0xFFU);
  }
  return bytes;
}

}  // namespace

Json distance_view_json(const DistanceView& view) {
  Json engines = Json::array();
  for (const DistanceViewEngine& engine : view.engines) {
    engines.push_back({{"name", engine.name},
                       {"largest", json_numbers(engine.largest)},
                       {"distances", frames_json(engine.distances)}});
  }
  Json bodies = Json::array();
  for (const DistanceViewBody& body : view.bodies) {
    Json poses = Json::array();
    for (const auto& pose : body.poses) poses.push_back(json_numbers({pose.begin(), pose.end()}));
    bodies.push_back(
        {{"shape", body.shape}, {"sizes", json_numbers(body.sizes)}, {"poses", poses}});
  }
  return {{"simulated_nodes", view.simulated_nodes},
          {"times", json_numbers(view.times)},
          {"triangles_base64", to_base64(words(view.triangles))},
          {"positions", frames_json(view.positions)},
          {"engines", engines},
          {"bodies", bodies}};
}

}  // namespace weft::validation
