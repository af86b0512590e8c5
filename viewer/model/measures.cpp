#include <weft/viewer/model/measures.hpp>

#include <cmath>
#include <limits>
#include <variant>

#include <weft/custom_forces/registry.hpp>
#include <weft/playback/rendering/renderer.hpp>
#include <weft/scenes/torn_cloth.hpp>

namespace weft::viewer {

Meter::Meter(const scenes::Scene& scene) {
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh& mesh = meshes_.emplace_back(scenes::make_mesh(cloth));
    const auto* skin = std::get_if<scenes::SkinSource>(&cloth.source);
    is_simulated_.push_back(skin == nullptr || skin->is_cloth);
    forces::LawSet<double>& set = laws_.emplace_back();
    if (!is_simulated_.back()) continue;
    for (const forces::LawSpecification& law : cloth.laws) {
      if (forces::find_law(law.law)->traits.has_energy)
        set.add(forces::make_law<double>(law, mesh));
    }
  }
}

Meter::~Meter() = default;
Meter::Meter(Meter&&) noexcept = default;
Meter& Meter::operator=(Meter&&) noexcept = default;

std::vector<Eigen::VectorXd> Meter::strains(const scenes::SceneState& state) const {
  std::vector<Eigen::VectorXd> all;
  for (std::size_t c = 0; c < meshes_.size(); ++c) {
    const scenes::ClothState& cloth = state.cloths[c];
    all.push_back(cloth.topology
                      ? scenes::node_strain(scenes::drawn_mesh(meshes_[c], cloth.topology.get()),
                                            cloth.positions)
                      : scenes::node_strain(meshes_[c], cloth.positions));
  }
  return all;
}

Measures Meter::measure(const scenes::SceneState& state) {
  Measures measures;
  const std::vector<Eigen::VectorXd> all_strains = strains(state);
  for (std::size_t c = 0; c < meshes_.size(); ++c) {
    if (!is_simulated_[c]) continue;
    const scenes::ClothState& cloth = state.cloths[c];
    const Eigen::VectorXd& strain = all_strains[c];
    for (Eigen::Index i = 0; i < strain.size(); ++i) {
      if (!(std::abs(strain[i]) > measures.largest_strain)) continue;
      measures.largest_strain = std::abs(strain[i]);
      measures.worst = WorstNode{{c, static_cast<int>(i)}, strain[i]};
    }
    if (cloth.topology || cloth.velocities.cols() != meshes_[c].num_nodes()) {
      measures.kinetic_energy = std::numeric_limits<double>::quiet_NaN();
      measures.potential_energy = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const VectorX<double>& masses = meshes_[c].masses;
    measures.kinetic_energy += 0.5 * cloth.velocities.colwise().squaredNorm().dot(masses);
    measures.potential_energy +=
        laws_[c].potential_energy({cloth.positions, cloth.velocities, masses, state.time});
  }
  return measures;
}

}  // namespace weft::viewer
