#include <weft/bridge/cloth_body.hpp>

#include <cmath>
#include <utility>

#include <weft/bridge/classic/cloth_links.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

void require_body(bool ok, const std::string& message) {
  if (!ok) throw InvalidArgument("cloth body: " + message);
}

void check(const ClothSettings& settings) {
  require_body(std::isfinite(settings.collision_margin) && settings.collision_margin >= 0,
               "collision_margin = " + std::to_string(settings.collision_margin) +
                   " [m], expected >= 0 and finite");
  require_body(
      std::isfinite(settings.friction) && settings.friction >= 0,
      "friction = " + std::to_string(settings.friction) + " [1], expected >= 0 and finite");
  require_body(
      settings.position_iterations >= 1,
      "position_iterations = " + std::to_string(settings.position_iterations) + ", expected >= 1");
  require_body(
      settings.contact_hardness >= 0 && settings.contact_hardness <= 1,
      "contact_hardness = " + std::to_string(settings.contact_hardness) + " [1], expected 0 to 1");
}

// All of btSoftBody::Config, in its order, so that no default of Bullet's can change a result
// unseen.
void configure(const ClothSettings& settings, btSoftBody& body) {
  btSoftBody::Config& config = body.m_cfg;
  config.aeromodel = btSoftBody::eAeroModel::V_Point;
  config.kVCF = 1;
  config.kDP = 0;
  config.kDG = 0;
  config.kLF = 0;
  config.kPR = 0;
  config.kVC = 0;
  config.kDF = static_cast<btScalar>(settings.friction);
  config.kMT = 0;
  config.kCHR = static_cast<btScalar>(settings.contact_hardness);
  config.kKHR = static_cast<btScalar>(settings.contact_hardness);
  config.kSHR = 1;
  config.kAHR = 1;
  config.kSRHR_CL = 0;  // cluster contacts: this body has no clusters
  config.kSKHR_CL = 0;
  config.kSSHR_CL = 0;
  config.kSR_SPLT_CL = 0;
  config.kSK_SPLT_CL = 0;
  config.kSS_SPLT_CL = 0;
  config.maxvolume = 1;
  config.timescale = 1;
  config.viterations = 0;
  config.piterations = settings.position_iterations;
  config.diterations = 0;
  config.citerations = 0;
  config.collisions = btSoftBody::fCollision::SDF_RS;
  config.drag = 0;
  config.m_maxStress = 0;
  body.setSolver(btSoftBody::eSolverPresets::Positions);
  body.m_restLengthScale = 1;
  body.getCollisionShape()->setMargin(static_cast<btScalar>(settings.collision_margin));
}

}  // namespace

void set_pinned_velocities(const ClothMesh& mesh, btSoftBody& body) {
  for (std::size_t i = 0; i < mesh.pinned.size(); ++i) {
    const Vector3<btScalar> v = mesh.pinned_velocity(i).cast<btScalar>();
    body.m_nodes[mesh.pinned[i]].m_v.setValue(v[0], v[1], v[2]);
  }
}

std::unique_ptr<btSoftBody> make_cloth_body(btSoftBodyWorldInfo& world_info, const ClothMesh& mesh,
                                            const ClothSettings& settings) {
  check(settings);
  check_mesh(mesh);
  const int num_nodes = mesh.num_nodes();
  std::vector<btVector3> positions(static_cast<std::size_t>(num_nodes));
  std::vector<btScalar> masses(static_cast<std::size_t>(num_nodes));
  for (int i = 0; i < num_nodes; ++i) {
    const Vector3<btScalar> x = mesh.rest_positions.col(i).cast<btScalar>();
    positions[static_cast<std::size_t>(i)].setValue(x[0], x[1], x[2]);
    masses[static_cast<std::size_t>(i)] = static_cast<btScalar>(mesh.masses[i]);
  }
  for (const int node : mesh.pinned) masses[static_cast<std::size_t>(node)] = 0;
  auto body = std::make_unique<btSoftBody>(&world_info, num_nodes, positions.data(), masses.data());
  configure(settings, *body);
  set_pinned_velocities(mesh, *body);
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    body->appendFace(mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t));
  }
  append_links(mesh, settings, *body);
  // Now, from the rest shape: Bullet would do it in the first step, from whatever shape the body
  // has by then.
  body->updateConstants();
  body->m_bUpdateRtCst = false;
  return body;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
