#include <weft/validation/peers/peer_result.hpp>

#include <nlohmann/json.hpp>

#include <weft/core/error.hpp>
#include <weft/scenes/catalog.hpp>

namespace weft::validation {
namespace {

using Json = nlohmann::ordered_json;

/// The catalog's scene with the cloth that the peer had; what the peer has no counterpart for is left out.
scenes::Scene scene_of(const std::string& name, const Json& cloth) {
  scenes::Scene scene = scenes::load_scene(name);
  scene.world.frame_interval = 0.02;
  scene.world.time_step = 0.02 / 40;
  scene.world.duration = cloth.at("duration_s");
  scenes::Cloth& own = scene.cloths.front();
  ClothGrid& grid = own.grid();
  const int nodes = cloth.at("nodes");
  grid.nodes = {nodes, nodes};
  grid.stencil = GridStencil::k8Neighbour;
  grid.lumping = MassLumping::kUniform;
  grid.total_mass = cloth.at("node_mass_kg").get<double>() * nodes * nodes;
  own.velocity.setZero();
  std::erase_if(own.laws, [](const auto& law) { return law.law == "spring_damping"; });
  for (forces::LawSpecification& law : own.laws) {
    if (law.law == "tension") {
      law.sets = {"stretch", "shear"};
      law.parameters["stiffness"] = {cloth.at("stiffness_N_per_m").get<double>()};
    } else if (law.law == "velocity_damping") {
      law.parameters["rate"] = {cloth.at("velocity_damping_per_s").get<double>()};
    }
  }
  return scenes::with_bullets_time_step(std::move(scene));
}

Matrix3X<double> matrix_of(const std::vector<double>& values) {
  return Eigen::Map<const Matrix3X<double>>(values.data(), 3,
                                            static_cast<Eigen::Index>(values.size() / 3));
}

}  // namespace

PeerResult read_peer_result(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    if (json.at("schema") != "weft-peer/1") throw Error("schema is not weft-peer/1");
    PeerResult result;
    result.peer = json.at("peer");
    result.scene = scene_of(json.at("scene"), json.at("cloth"));
    result.mapping = json.at("mapping").get<std::vector<std::string>>();
    for (const auto& [name, value] : json.at("settings").items()) {
      result.settings.emplace_back(name,
                                   value.is_string() ? value.get<std::string>() : value.dump());
    }
    for (const Json& check : json.at("calibration")) {
      result.calibration.push_back({check.at("what"), check.at("measured"), check.at("expected")});
    }
    result.times = json.at("times_s").get<std::vector<double>>();
    for (const Json& frame : json.at("positions_m")) {
      result.positions.push_back(matrix_of(frame.get<std::vector<double>>()));
    }
    if (result.positions.size() != result.times.size()) throw Error("a time has no frame");
    return result;
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("result of a peer: ") + error.what());
  }
}

}  // namespace weft::validation
