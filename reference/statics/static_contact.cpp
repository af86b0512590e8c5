#include <weft/reference/statics/static_contact.hpp>

#include <algorithm>
#include <cmath>

#include <weft/reference/contact/distance/signed_distance.hpp>

namespace weft::reference {
namespace {

/// Multipliers and springs of all nodes at all colliders.
class AugmentedContact {
 public:
  AugmentedContact(const Body& body, const std::vector<Collider>& colliders,
                   const std::vector<bool>& fixed, double stiffness)
      : body_(body), colliders_(colliders), fixed_(fixed), stiffness_(stiffness) {
    multipliers_.setZero(static_cast<Eigen::Index>(colliders.size()), body.mesh.num_nodes());
  }

  void add_forces(const Matrix3X<double>& positions, Matrix3X<double>& forces) const {
    for_each(positions, [&](Eigen::Index, Eigen::Index node, const SurfaceDistance& surface,
                            double force) { forces.col(node) += force * surface.normal; });
  }

  /// The normal turns as the node moves; its derivative is taken by central differences, which are
  /// exact enough for Newton's method and used for no force.
  void add_product(const Matrix3X<double>& positions, const Matrix3X<double>& displacements,
                   Matrix3X<double>& product) const {
    for_each(positions, [&](Eigen::Index k, Eigen::Index node, const SurfaceDistance& surface,
                            double force) {
      const Vector3<double> way = displacements.col(node);
      if (way.isZero(0.0)) return;
      constexpr double kDifference = 1e-6;  // [m]
      const Vector3<double> shift = kDifference * way.normalized();
      const Vector3<double> here = positions.col(node);
      const Vector3<double> turn =
          (distance(k, here + shift).normal - distance(k, here - shift).normal) *
          (way.norm() / (2 * kDifference));
      product.col(node) += force * turn - stiffness_ * surface.normal.dot(way) * surface.normal;
    });
  }

  /// Springs become multipliers. Returns the largest depth, or slack under a multiplier [m].
  double update(const Matrix3X<double>& positions) {
    double largest = 0.0;
    Eigen::MatrixXd next = Eigen::MatrixXd::Zero(multipliers_.rows(), multipliers_.cols());
    for_each(positions,
             [&](Eigen::Index k, Eigen::Index node, const SurfaceDistance& surface, double force) {
               largest = std::max(largest, std::abs(body_.collision_margin - surface.distance));
               next(k, node) = force;
             });
    multipliers_ = next;
    return largest;
  }

 private:
  SurfaceDistance distance(Eigen::Index k, const Vector3<double>& point) const {
    const Collider& collider = colliders_[static_cast<std::size_t>(k)];
    return signed_distance(collider.shape, {collider.position, collider.orientation}, point);
  }

  template <class Visit>
  void for_each(const Matrix3X<double>& positions, const Visit& visit) const {
    for (Eigen::Index k = 0; k < multipliers_.rows(); ++k) {
      for (Eigen::Index node = 0; node < positions.cols(); ++node) {
        if (fixed_[static_cast<std::size_t>(node)]) continue;
        const SurfaceDistance surface = distance(k, positions.col(node));
        const double depth = body_.collision_margin - surface.distance;
        const double force = multipliers_(k, node) + stiffness_ * depth;
        if (force > 0.0) visit(k, node, surface, force);
      }
    }
  }

  const Body& body_;
  const std::vector<Collider>& colliders_;
  const std::vector<bool>& fixed_;
  double stiffness_;             // [N/m]
  Eigen::MatrixXd multipliers_;  // per collider and node [N]
};

/// About the stiffness of one node of the body [N/m].
double node_stiffness(const StaticProblem& problem, const Matrix3X<double>& positions) {
  Matrix3X<double> direction(3, positions.cols());
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    direction.data()[i] = i % 2 == 0 ? 1.0 : -1.0;  // neighbors against each other
  }
  Matrix3X<double> product = Matrix3X<double>::Zero(3, positions.cols());
  problem.stiffness_product(positions, direction, product);
  return product.cwiseAbs().maxCoeff();
}

}  // namespace

StaticContactOutcome solve_static_contact(const StaticProblem& problem, const Body& body,
                                          const std::vector<Collider>& colliders,
                                          Matrix3X<double>& positions,
                                          const StaticOptions& options) {
  constexpr double kSpring = 10.0;  // of a node's stiffness: each round leaves about a tenth
  constexpr int kMaxRounds = 100;
  AugmentedContact contact(body, colliders, problem.fixed,
                           kSpring * node_stiffness(problem, positions));
  StaticProblem touched = problem;
  touched.forces = [&](const Matrix3X<double>& at, Matrix3X<double>& forces) {
    problem.forces(at, forces);
    contact.add_forces(at, forces);
  };
  touched.stiffness_product = [&](const Matrix3X<double>& at, const Matrix3X<double>& way,
                                  Matrix3X<double>& product) {
    problem.stiffness_product(at, way, product);
    contact.add_product(at, way, product);
  };
  const double bound = kContactDepth * (body.collision_margin > 0.0 ? body.collision_margin : 1.0);
  StaticContactOutcome outcome;
  while (outcome.rounds < kMaxRounds) {
    ++outcome.rounds;
    outcome.solution = solve_statics(touched, positions, options);
    outcome.contact_forces.setZero(3, positions.cols());
    contact.add_forces(positions, outcome.contact_forces);
    if (!outcome.solution.converged) break;
    outcome.depth = contact.update(positions);
    outcome.converged = outcome.depth <= bound;
    if (outcome.converged) break;
  }
  return outcome;
}

}  // namespace weft::reference
