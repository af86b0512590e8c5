#include <weft/reference/contact/contact_problem.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace weft::reference {
namespace {

/// What an impulse at a contact does to its own relative velocity.
struct Response {
  Matrix3<double> mobility;    // du/dj [1/kg], symmetric
  double normal_mobility;      // n . mobility n [1/kg]
  double tangential_mobility;  // largest eigenvalue in the tangent plane [1/kg]
};

Matrix3<double> cross_matrix(const Vector3<double>& v) {
  Matrix3<double> matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Calls visit(point, weight) for the points of a contact.
template <class Problem, class Visit>
void for_each_point(Problem& problem, const Contact& contact, const Visit& visit) {
  for (std::size_t i = 0; i < contact.on.points.size(); ++i) {
    const int point = contact.on.points[i];
    if (point >= 0) visit(problem.points[static_cast<std::size_t>(point)], contact.on.weights[i]);
  }
}

Response response_of(const ContactProblem& problem, const Contact& contact) {
  double inverse_mass = 0.0;
  for_each_point(problem, contact, [&](const ContactPoint& point, double weight) {
    inverse_mass += weight * weight * point.inverse_mass;
  });
  static const ContactRigid kNone;
  const ContactRigid& rigid =
      contact.rigid == kNoRigid ? kNone : problem.rigids[static_cast<std::size_t>(contact.rigid)];
  inverse_mass += rigid.inverse_mass;
  Response response;
  response.mobility = inverse_mass * Matrix3<double>::Identity();
  response.normal_mobility = inverse_mass;
  response.tangential_mobility = inverse_mass;
  if (rigid.inverse_mass == 0.0) return response;

  const Matrix3<double> lever = cross_matrix(contact.lever);
  response.mobility -= lever * rigid.inverse_inertia * lever;
  const Vector3<double>& n = contact.normal;
  response.normal_mobility = n.dot(response.mobility * n);
  // The 2 x 2 block in the tangent plane, by two unit vectors of it.
  const Vector3<double> s = n.unitOrthogonal();
  const Vector3<double> t = n.cross(s);
  const double ss = s.dot(response.mobility * s);
  const double tt = t.dot(response.mobility * t);
  const double st = s.dot(response.mobility * t);
  response.tangential_mobility = 0.5 * (ss + tt) + std::hypot(0.5 * (ss - tt), st);
  return response;
}

void apply(ContactProblem& problem, Contact& contact, const Vector3<double>& change) {
  contact.impulse += change;
  for_each_point(problem, contact, [&](ContactPoint& point, double weight) {
    point.velocity += weight * point.inverse_mass * change;
    point.impulse += weight * change;
  });
  if (contact.rigid == kNoRigid) return;
  ContactRigid& rigid = problem.rigids[static_cast<std::size_t>(contact.rigid)];
  if (rigid.inverse_mass == 0.0) return;
  const Vector3<double> torque = contact.lever.cross(change);
  rigid.velocity -= rigid.inverse_mass * change;
  rigid.angular_velocity -= rigid.inverse_inertia * torque;
  rigid.impulse -= change;
  rigid.angular_impulse -= torque;
}

/// One visit; returns how much it changed the impulse [N s]. The normal part first, then friction
/// under the cone that this normal part allows. The friction step jt <- cone(jt - ut / mobility)
/// stands still exactly where Coulomb's law holds.
double visit(ContactProblem& problem, Contact& contact, const Response& response) {
  const Vector3<double>& n = contact.normal;
  const double old_normal = n.dot(contact.impulse);
  const Vector3<double> old_tangent = contact.impulse - old_normal * n;

  const double speed = n.dot(relative_velocity(problem, contact));
  const double new_normal =
      std::max(0.0, old_normal + (contact.target_speed - speed) / response.normal_mobility);
  apply(problem, contact, (new_normal - old_normal) * n);

  const Vector3<double> velocity = relative_velocity(problem, contact);
  const Vector3<double> slip = velocity - n.dot(velocity) * n;
  Vector3<double> new_tangent = old_tangent - slip / response.tangential_mobility;
  const double limit = contact.friction * new_normal;
  const double magnitude = new_tangent.norm();
  if (magnitude > limit) new_tangent *= limit / magnitude;
  apply(problem, contact, new_tangent - old_tangent);
  return std::abs(new_normal - old_normal) + (new_tangent - old_tangent).norm();
}

/// Sum of the speeds that a relative velocity is the difference of [m/s].
double speed_scale(const ContactProblem& problem, const Contact& contact) {
  double sum = std::abs(contact.target_speed);
  for_each_point(problem, contact, [&](const ContactPoint& point, double weight) {
    sum += std::abs(weight) * point.velocity.norm();
  });
  if (contact.rigid == kNoRigid) return sum;
  const ContactRigid& rigid = problem.rigids[static_cast<std::size_t>(contact.rigid)];
  return sum + rigid.velocity.norm() + rigid.angular_velocity.norm() * contact.lever.norm();
}

}  // namespace

Vector3<double> relative_velocity(const ContactProblem& problem, const Contact& contact) {
  Vector3<double> sum = Vector3<double>::Zero();
  for_each_point(problem, contact,
                 [&](const ContactPoint& point, double weight) { sum += weight * point.velocity; });
  if (contact.rigid == kNoRigid) return sum;
  const ContactRigid& rigid = problem.rigids[static_cast<std::size_t>(contact.rigid)];
  return sum - rigid.velocity - rigid.angular_velocity.cross(contact.lever);
}

SweepReport solve_contacts(ContactProblem& problem, const SweepLimits& limits) {
  SweepReport report;
  if (problem.contacts.empty()) return report;
  std::vector<Response> responses;
  responses.reserve(problem.contacts.size());
  for (const Contact& contact : problem.contacts) {
    responses.push_back(response_of(problem, contact));
  }
  report.converged = false;
  double scale = 0.0;  // largest velocity seen: what rounding errors are relative to [m/s]
  while (report.sweeps < limits.max_sweeps && !report.converged) {
    double largest_change = 0.0;
    for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
      Contact& contact = problem.contacts[c];
      const double mobility = responses[c].tangential_mobility;
      scale = std::max(scale, speed_scale(problem, contact) + mobility * contact.impulse.norm());
      largest_change = std::max(largest_change, mobility * visit(problem, contact, responses[c]));
    }
    ++report.sweeps;
    report.converged = largest_change <= limits.tolerance * scale;
  }
  report.visits =
      static_cast<std::int64_t>(report.sweeps) * static_cast<std::int64_t>(problem.contacts.size());
  return report;
}

}  // namespace weft::reference
