#include <weft/recorder/recorded_cloth.hpp>

#include <memory>
#include <utility>

#include <weft/bridge/classic/body_mesh.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How far the masses are from these shares of their sum [kg].
double misfit(const VectorX<double>& masses, const VectorX<double>& shares) {
  return (masses - masses.sum() / shares.sum() * shares).norm();
}

}  // namespace

scenes::Cloth recorded_cloth(const btSoftBody& body, const std::string& name) {
  const ClothMesh mesh = bridge::mesh_of(body).mesh;
  scenes::MeshBody source;
  source.shape = std::make_shared<const scenes::MeshGeometry>(
      scenes::MeshGeometry{{mesh.rest_positions, mesh.triangles}});
  source.total_mass = mesh.masses.sum();
  const VectorX<double> by_area = scenes::make_source_mesh(source).masses;
  const VectorX<double> evenly = VectorX<double>::Ones(mesh.num_nodes());
  if (misfit(mesh.masses, evenly) <= misfit(mesh.masses, by_area)) {
    source.lumping = MassLumping::kUniform;
  }
  scenes::Cloth cloth;
  cloth.name = name;
  cloth.source = std::move(source);
  if (!mesh.pinned.empty()) cloth.pins.emplace_back(scenes::NodePin{mesh.pinned});
  cloth.collision_margin = static_cast<double>(body.getCollisionShape()->getMargin());
  cloth.friction = static_cast<double>(body.m_cfg.kDF);
  return cloth;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
