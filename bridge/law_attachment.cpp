#include <weft/bridge/law_attachment.hpp>

#include <cmath>
#include <cstdio>

#include <weft/custom_forces/core/error.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

forces::LawSet<btScalar> make_laws(const ClothMesh& mesh,
                                   const std::vector<forces::LawSpecification>& laws) {
  forces::LawSet<btScalar> set;
  for (const forces::LawSpecification& law : laws) set.add(forces::make_law<btScalar>(law, mesh));
  return set;
}

void check_attachment(const std::string& who, const btSoftBody& body,
                      const VectorX<btScalar>& masses) {
  if (masses.size() != body.m_nodes.size()) {
    throw InvalidArgument(who + ": " + std::to_string(masses.size()) +
                          " masses, expected one for each of the " +
                          std::to_string(body.m_nodes.size()) + " nodes");
  }
  for (Eigen::Index i = 0; i < masses.size(); ++i) {
    if (!(masses[i] > 0) || !std::isfinite(masses[i])) {
      throw InvalidArgument(who + ": mass of node " + std::to_string(i) + " = " +
                            std::to_string(masses[i]) + " [kg], expected > 0 and finite");
    }
  }
  if (body.m_cfg.timescale != btScalar(1)) {
    throw InvalidArgument(who + ": m_cfg.timescale = " + std::to_string(body.m_cfg.timescale) +
                          " [1], expected 1");
  }
}

std::optional<BodyBlowUp> predicted_blow_up(const btSoftBody& body,
                                            const Matrix3X<btScalar>& velocities,
                                            const Matrix3X<btScalar>& forces, btScalar time_step,
                                            double max_speed) {
  return predicted_blow_up(body, velocities, forces, time_step, max_speed,
                           {0, body.m_nodes.size()});
}

std::optional<BodyBlowUp> predicted_blow_up(const btSoftBody& body,
                                            const Matrix3X<btScalar>& velocities,
                                            const Matrix3X<btScalar>& forces, btScalar time_step,
                                            double max_speed, fast::NodeRange nodes) {
  const auto limit = static_cast<btScalar>(max_speed);
  for (int i = nodes.begin; i < nodes.end; ++i) {
    const Vector3<btScalar> velocity =
        velocities.col(i) + forces.col(i) * (body.m_nodes[i].m_im * time_step);
    if (velocity.squaredNorm() < limit * limit) continue;
    const btScalar speed = velocity.norm();
    if (speed <= limit) continue;
    if (!std::isfinite(speed)) return BodyBlowUp{i, "velocity is not finite"};
    char text[64];
    std::snprintf(text, sizeof text, "speed %.3g m/s is over %.3g m/s", static_cast<double>(speed),
                  max_speed);
    return BodyBlowUp{i, text};
  }
  return std::nullopt;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
