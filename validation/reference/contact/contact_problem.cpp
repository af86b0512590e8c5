#include <weft/validation/reference/contact/contact_problem.hpp>

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

Response response_of(const ContactProblem& problem, const Contact& contact) {
  const ContactRigid& rigid = problem.rigids[contact.rigid];
  const double inverse_mass = problem.points[contact.point].inverse_mass + rigid.inverse_mass;
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
  ContactPoint& point = problem.points[contact.point];
  ContactRigid& rigid = problem.rigids[contact.rigid];
  contact.impulse += change;
  point.velocity += point.inverse_mass * change;
  point.impulse += change;
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
  const ContactRigid& rigid = problem.rigids[contact.rigid];
  return problem.points[contact.point].velocity.norm() + rigid.velocity.norm() +
         rigid.angular_velocity.norm() * contact.lever.norm() + std::abs(contact.target_speed);
}

}  // namespace

Vector3<double> relative_velocity(const ContactProblem& problem, const Contact& contact) {
  const ContactRigid& rigid = problem.rigids[contact.rigid];
  return problem.points[contact.point].velocity - rigid.velocity -
         rigid.angular_velocity.cross(contact.lever);
}

SweepReport solve_contacts(ContactProblem& problem) {
  SweepReport report;
  if (problem.contacts.empty()) return report;
  std::vector<Response> responses;
  responses.reserve(problem.contacts.size());
  for (const Contact& contact : problem.contacts) {
    responses.push_back(response_of(problem, contact));
  }
  report.converged = false;
  double scale = 0.0;  // largest velocity seen: what rounding errors are relative to [m/s]
  while (report.sweeps < kMaxSweeps && !report.converged) {
    double largest_change = 0.0;
    for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
      Contact& contact = problem.contacts[c];
      const double mobility = responses[c].tangential_mobility;
      scale = std::max(scale, speed_scale(problem, contact) + mobility * contact.impulse.norm());
      largest_change = std::max(largest_change, mobility * visit(problem, contact, responses[c]));
    }
    ++report.sweeps;
    report.converged = largest_change <= kSweepTolerance * scale;
  }
  return report;
}

}  // namespace weft::reference
