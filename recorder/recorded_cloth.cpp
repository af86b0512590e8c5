#include <weft/recorder/recorded_cloth.hpp>

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <weft/bridge/adoption/body_mesh.hpp>
#include <weft/core/error.hpp>

namespace weft::recorder {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How far the masses are from these shares of their sum [kg].
double misfit(const VectorX<double>& masses, const VectorX<double>& shares) {
  return (masses - masses.sum() / shares.sum() * shares).norm();
}

Triangles faces_of(const btSoftBody& body) {
  Triangles faces(3, body.m_faces.size());
  for (int f = 0; f < body.m_faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      faces(k, f) = static_cast<int>(body.m_faces[f].m_n[k] - &body.m_nodes[0]);
    }
  }
  return faces;
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

FollowedFaces::FollowedFaces(const btSoftBody& body, Triangles triangles)
    : first_faces_(faces_of(body)),
      first_triangles_(std::move(triangles)),
      num_first_nodes_(body.m_nodes.size()) {}

std::shared_ptr<const scenes::ClothTopology> FollowedFaces::now(const btSoftBody& body) const {
  const Triangles faces = faces_of(body);
  if (faces.cols() != first_faces_.cols()) {
    throw InvalidArgument(fmt::format("has {} faces, expected {} as when it was added",
                                      faces.cols(), first_faces_.cols()));
  }
  auto topology = std::make_shared<scenes::ClothTopology>();
  topology->triangles = first_triangles_;
  topology->origins.assign(static_cast<std::size_t>(body.m_nodes.size() - num_first_nodes_), -1);
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int first = first_faces_(k, f);
      const int node = faces(k, f);
      if (node == first) continue;
      int* origin = node < num_first_nodes_
                        ? nullptr
                        : &topology->origins[static_cast<std::size_t>(node - num_first_nodes_)];
      if (origin == nullptr || (*origin >= 0 && *origin != first)) {
        throw InvalidArgument(
            fmt::format("face {} has node {} in place of node {}, expected a copy of this one", f,
                        node, first));
      }
      *origin = first;
      auto corners = topology->triangles.col(f);
      *std::find(corners.begin(), corners.end(), first) = node;
    }
  }
  const auto loose = std::find(topology->origins.begin(), topology->origins.end(), -1);
  if (loose != topology->origins.end()) {
    throw InvalidArgument(fmt::format("node {} belongs to no face, expected copies of split nodes",
                                      num_first_nodes_ + (loose - topology->origins.begin())));
  }
  return topology;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::recorder
