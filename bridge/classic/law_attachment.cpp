#include <weft/bridge/classic/law_attachment.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include <weft/core/error.hpp>
#include <weft/core/index.hpp>
#include <weft/custom_forces/registry.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

namespace {

/// What a program that takes a mass from m_im, or through a file, loses of it by rounding [-].
constexpr btScalar kMassTolerance = btScalar(1e-4);

using Corners = std::array<int, 3>;

/// Ascending, and so are their nodes.
std::vector<Corners> sorted(std::vector<Corners> triangles) {
  for (Corners& corners : triangles) std::sort(corners.begin(), corners.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::string text_of(const Corners& corners) {
  return std::to_string(corners[0]) + " " + std::to_string(corners[1]) + " " +
         std::to_string(corners[2]);
}

}  // namespace

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
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btScalar inverse_mass = body.m_nodes[i].m_im;
    if (inverse_mass == 0 || std::abs(inverse_mass * masses[i] - 1) <= kMassTolerance) continue;
    throw InvalidArgument(
        who + ": mass of node " + std::to_string(i) + " = " + std::to_string(masses[i]) +
        " [kg], expected the body's, 1 / m_im = " + std::to_string(1 / inverse_mass) + " [kg]");
  }
  if (body.m_cfg.timescale != btScalar(1)) {
    throw InvalidArgument(who + ": m_cfg.timescale = " + std::to_string(body.m_cfg.timescale) +
                          " [1], expected 1");
  }
}

void check_topology(const std::string& who, const btSoftBody& body, const ClothMesh& mesh) {
  check_mesh(mesh);
  if (mesh.num_nodes() != body.m_nodes.size()) {
    throw InvalidArgument(who + ": a mesh of " + std::to_string(mesh.num_nodes()) +
                          " nodes, expected the " + std::to_string(body.m_nodes.size()) +
                          " of the body");
  }
  if (mesh.triangles.cols() == 0 || body.m_faces.size() == 0) return;
  std::vector<Corners> of_mesh(at(static_cast<int>(mesh.triangles.cols())));
  for (std::size_t t = 0; t < of_mesh.size(); ++t) {
    const auto nodes = mesh.triangles.col(static_cast<Eigen::Index>(t));
    of_mesh[t] = {nodes[0], nodes[1], nodes[2]};
  }
  std::vector<Corners> of_body(at(body.m_faces.size()));
  for (std::size_t f = 0; f < of_body.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const btSoftBody::Node* const node = body.m_faces[static_cast<int>(f)].m_n[k];
      of_body[f][k] = static_cast<int>(node - &body.m_nodes[0]);
    }
  }
  if (of_mesh.size() != of_body.size()) {
    throw InvalidArgument(who + ": a mesh of " + std::to_string(of_mesh.size()) +
                          " triangles, expected the " + std::to_string(of_body.size()) +
                          " faces of the body, or none");
  }
  if (of_mesh == of_body) return;
  of_mesh = sorted(std::move(of_mesh));
  of_body = sorted(std::move(of_body));
  const auto [in_mesh, in_body] = std::mismatch(of_mesh.begin(), of_mesh.end(), of_body.begin());
  if (in_mesh == of_mesh.end()) return;
  throw InvalidArgument(who + ": the mesh has the triangle " + text_of(*in_mesh) +
                        " where the body has the face " + text_of(*in_body) +
                        ", expected the same triangles");
}

FollowedMasses::FollowedMasses(const btSoftBody& body, VectorX<btScalar> masses)
    : masses_(std::move(masses)) {
  for (int i = 0; i < body.m_nodes.size(); ++i) inverse_masses_.push_back(body.m_nodes[i].m_im);
}

int FollowedMasses::follow(const btSoftBody& body) {
  if (at(body.m_nodes.size()) != inverse_masses_.size()) return -1;
  int first = -1;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btScalar inverse_mass = body.m_nodes[i].m_im;
    btScalar& known = inverse_masses_[at(i)];
    if (inverse_mass == known) continue;
    known = inverse_mass;
    // One that is let go has the mass that it had, unless it gets another one.
    if (inverse_mass == 0 || std::abs(inverse_mass * masses_[i] - 1) <= kMassTolerance) continue;
    masses_[i] = 1 / inverse_mass;
    if (first < 0) first = i;
  }
  return first;
}

int first_non_finite_node(const btSoftBody& body) {
  const auto size_of = [&](int i) {
    return body.m_nodes[i].m_x.length2() + body.m_nodes[i].m_v.length2();
  };
  btScalar sum = 0;
  for (int i = 0; i < body.m_nodes.size(); ++i) sum += size_of(i);
  if (std::isfinite(sum)) return -1;
  int first = 0;
  while (first < body.m_nodes.size() && std::isfinite(size_of(first))) ++first;
  return first < body.m_nodes.size() ? first : -1;
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

std::optional<BodyBlowUp> blow_up_by_pressure(const btSoftBody& body, btScalar time_step,
                                              double max_speed) {
  if (body.m_cfg.kPR == 0 || body.m_faces.size() == 0) return std::nullopt;
  const auto volume = static_cast<double>(btFabs(body.getVolume()));
  const double pressure = std::abs(static_cast<double>(body.m_cfg.kPR)) / volume;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im <= 0) continue;
    const double speed = pressure * static_cast<double>(node.m_area * node.m_im * time_step);
    if (speed <= max_speed) continue;
    char text[128];
    std::snprintf(text, sizeof text,
                  "pressure, m_cfg.kPR = %.3g over a volume of %.3g m^3, gives it %.3g m/s",
                  static_cast<double>(body.m_cfg.kPR), volume, speed);
    return BodyBlowUp{i, text};
  }
  return std::nullopt;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
