#include <weft/reference/contact/face_contacts.hpp>

#include <algorithm>

#include <weft/reference/contact/contact_stages.hpp>
#include <weft/reference/contact/distance/deepest_point.hpp>

namespace weft::reference {
namespace {

/// Positions that the nodes of a touch would have at the end of the step.
Matrix3<double> end_positions(const System& system, const SystemStep& step, const FaceTouch& touch,
                              const ContactPoints& points, const ContactProblem& problem) {
  Matrix3<double> ends;
  for (int k = 0; k < 3; ++k) {
    const int node = touch.nodes[static_cast<std::size_t>(k)];
    ends.col(k) =
        system.bodies[touch.body].positions.col(node) +
        step.time_step *
            points.velocity(touch.body, node, step.bodies[touch.body].mean_velocities, problem);
  }
  return ends;
}

bool is_at_corner(const Vector3<double>& weights) {
  return weights.maxCoeff() > 1.0 - 1e-9;  // a node's own contact is there
}

}  // namespace

FaceContacts::FaceContacts(const System& system) {
  for (const Body& body : system.bodies) is_needed_ |= body.face_contact;
}

Contact contact_at(const FaceTouch& touch, const SystemStep& step, ContactPoints& points,
                   ContactProblem& problem, bool end_velocities) {
  Contact contact{.rigid = static_cast<int>(touch.collider)};
  const BodyStep& body = step.bodies[touch.body];
  for (std::size_t k = 0; k < 3; ++k) {
    const Matrix3X<double>& velocities =
        end_velocities ? body.end_velocities : body.mean_velocities;
    contact.on.points[k] =
        points.point(touch.body, touch.nodes[k], velocities.col(touch.nodes[k]), problem);
    contact.on.weights[k] = touch.weights[static_cast<Eigen::Index>(k)];
  }
  return contact;
}

bool FaceContacts::linearise(const System& system, const SystemStep& step,
                             const std::vector<Pose>& poses, const Entry& entry,
                             const ContactPoints& points, ContactProblem& problem) const {
  const FaceTouch& touch = entry.touch;
  Contact& contact = problem.contacts[entry.contact];
  const Vector3<double> end = end_positions(system, step, touch, points, problem) * touch.weights;
  const SurfaceDistance surface =
      signed_distance(system.colliders[touch.collider].shape, poses[touch.collider], end);
  const double depth = system.bodies[touch.body].collision_margin - surface.distance;
  const bool matters = !contact.impulse.isZero(0.0) || depth > 0.0;
  const bool changed = matters && (surface.normal - contact.normal).norm() > kNormalTolerance;
  contact.normal = surface.normal;
  contact.target_speed =
      surface.normal.dot(relative_velocity(problem, contact)) + depth / step.time_step;
  return changed;
}

bool FaceContacts::find(const System& system, const SystemStep& step,
                        const std::vector<Pose>& poses, bool friction, ContactPoints& points,
                        ContactProblem& problem) {
  bool changed = false;
  for (std::size_t k = 0; k < system.colliders.size(); ++k) {
    const Shape& shape = system.colliders[k].shape;
    if (std::holds_alternative<Plane>(shape)) continue;
    for (std::size_t b = 0; b < system.bodies.size(); ++b) {
      const Body& body = system.bodies[b];
      if (!body.face_contact) continue;
      for (Eigen::Index t = 0; t < body.mesh.triangles.cols(); ++t) {
        const auto nodes = body.mesh.triangles.col(t);
        FaceTouch touch{.collider = k, .body = b, .nodes = {nodes[0], nodes[1], nodes[2]}};
        const Matrix3<double> ends = end_positions(system, step, touch, points, problem);
        const Vector3<double> centre = ends.rowwise().mean();
        const double size = (ends.colwise() - centre).colwise().norm().maxCoeff();
        const double margin = body.collision_margin;
        if (signed_distance(shape, poses[k], centre).distance - size > margin) continue;
        touch.weights = deepest_point(shape, poses[k], ends);
        if (is_at_corner(touch.weights)) continue;
        const SurfaceDistance surface = signed_distance(shape, poses[k], ends * touch.weights);
        if (!(margin - surface.distance > kFaceTolerance * size)) continue;
        double inverse_mass = step.rigids[k].inverse_mass;
        for (int c = 0; c < 3; ++c) {
          inverse_mass += touch.weights[c] * step.inverse_masses[b][nodes[c]];
        }
        if (!(inverse_mass > 0.0)) continue;
        Contact contact = contact_at(touch, step, points, problem, false);
        contact.friction = friction ? body.friction * system.colliders[k].friction : 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
          contact.lever += touch.weights[static_cast<Eigen::Index>(c)] *
                           position_stage_lever(system, step, k, b, touch.nodes[c]);
        }
        contact.normal = surface.normal;
        entries_.push_back({problem.contacts.size(), touch});
        problem.contacts.push_back(contact);
        (void)linearise(system, step, poses, entries_.back(), points, problem);
        changed = true;
      }
    }
  }
  return changed;
}

bool FaceContacts::update(const System& system, const SystemStep& step,
                          const std::vector<Pose>& poses, bool friction, bool only_new,
                          ContactPoints& points, ContactProblem& problem) {
  bool changed = false;
  if (!only_new) {
    for (const Entry& entry : entries_) {
      changed |= linearise(system, step, poses, entry, points, problem);
    }
  }
  changed |= find(system, step, poses, friction, points, problem);
  return changed;
}

void FaceContacts::collect(const ContactProblem& problem, std::vector<FaceTouch>& touches) const {
  for (const Entry& entry : entries_) {
    if (!problem.contacts[entry.contact].impulse.isZero(0.0)) touches.push_back(entry.touch);
  }
}

}  // namespace weft::reference
