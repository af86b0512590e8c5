#include <weft/playback/export/cloth_energy.hpp>

#include <limits>
#include <variant>

namespace weft::scenes {
namespace {

struct Energies {
  double kinetic = 0.0;  ///< [J]
  double height = 0.0;   ///< [J]
};

Energies energies_of(const SceneState& state, const std::vector<VectorX<double>>& masses,
                     const Vector3<double>& gravity) {
  Energies sum;
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    const ClothState& cloth = state.cloths[c];
    if (cloth.topology) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      return {none, none};
    }
    sum.kinetic += 0.5 * cloth.velocities.colwise().squaredNorm().dot(masses[c].transpose());
    sum.height -= (gravity.transpose() * cloth.positions).dot(masses[c].transpose());
  }
  return sum;
}

VectorX<double> masses_of(const Cloth& cloth) {
  const auto* skin = std::get_if<SkinSource>(&cloth.source);
  if (skin != nullptr && !skin->is_cloth) return VectorX<double>::Zero(num_nodes(cloth.source));
  return make_mesh(cloth).masses;
}

}  // namespace

std::vector<PlaybackMetric> cloth_energies(const RecordingReader& reader) {
  std::vector<VectorX<double>> masses;
  for (const Cloth& cloth : reader.scene().cloths) masses.push_back(masses_of(cloth));
  PlaybackMetric kinetic{"cloth_kinetic_energy_J", {}};
  PlaybackMetric height{"cloth_height_energy_J", {}};
  double first = 0.0;
  for (int frame = 0; frame < reader.num_frames(); ++frame) {
    const Energies energies =
        energies_of(reader.frame(frame), masses, reader.scene().world.gravity);
    if (frame == 0) first = energies.height;
    kinetic.samples.push_back({reader.frame_time(frame), energies.kinetic});
    height.samples.push_back({reader.frame_time(frame), energies.height - first});
  }
  return {kinetic, height};
}

}  // namespace weft::scenes
