#include <weft/reference/contact/contact_points.hpp>

namespace weft::reference {

ContactPoints::ContactPoints(const System& system, const SystemStep& step) : step_(step) {
  std::size_t num_nodes = 0;
  for (const Body& body : system.bodies) {
    first_node_.push_back(num_nodes);
    num_nodes += static_cast<std::size_t>(body.mesh.num_nodes());
  }
  point_of_.assign(num_nodes, kNone);
}

int ContactPoints::point(std::size_t body, int node, const Vector3<double>& velocity,
                         ContactProblem& problem) {
  int& point = point_of_[number(body, node)];
  if (point == kNone) {
    point = static_cast<int>(problem.points.size());
    problem.points.push_back({.body = static_cast<int>(body),
                              .node = node,
                              .inverse_mass = step_.inverse_masses[body][node],
                              .velocity = velocity});
  }
  return point;
}

Vector3<double> ContactPoints::velocity(std::size_t body, int node,
                                        const Matrix3X<double>& otherwise,
                                        const ContactProblem& problem) const {
  const int point = point_of_[number(body, node)];
  if (point == kNone) return otherwise.col(node);
  return problem.points[static_cast<std::size_t>(point)].velocity;
}

}  // namespace weft::reference
