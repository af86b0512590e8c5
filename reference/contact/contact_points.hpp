#pragma once

// Tested by tests/reference/contact_test.cpp, tests/reference/face_contact_test.cpp.

#include <vector>

#include <weft/reference/contact/contact_model.hpp>
#include <weft/reference/contact/contact_problem.hpp>

namespace weft::reference {

/// Numbers the nodes of all bodies, and puts those that have a contact into a problem.
class ContactPoints {
 public:
  ContactPoints(const System& system, const SystemStep& step);

  [[nodiscard]] std::size_t num_nodes() const { return point_of_.size(); }
  [[nodiscard]] std::size_t number(std::size_t body, int node) const {
    return first_node_[body] + static_cast<std::size_t>(node);
  }

  /// Index of the point of a node; added with this velocity [m/s] if it has none yet.
  int point(std::size_t body, int node, const Vector3<double>& velocity, ContactProblem& problem);

  /// Velocity of a node as the problem knows it now, or the given one if it has no contact [m/s].
  [[nodiscard]] Vector3<double> velocity(std::size_t body, int node,
                                         const Matrix3X<double>& otherwise,
                                         const ContactProblem& problem) const;

 private:
  static constexpr int kNone = -1;
  const SystemStep& step_;
  std::vector<std::size_t> first_node_;
  std::vector<int> point_of_;  // per node
};

}  // namespace weft::reference
