#include <weft/bridge/implicit/bending_forces.hpp>

#include <algorithm>

#include <weft/core/parallel/threads.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/fast_solver/network/spring_network.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

BendingForces::BendingForces(const ClothMesh& mesh,
                             const std::vector<forces::LawSpecification>& laws) {
  Eigen::Index num_columns = 0;
  for (const forces::LawSpecification& law : laws) {
    if (!fast::is_bending(law.law)) continue;
    laws_.push_back(forces::make_law<btScalar>(law, mesh));
    if (const auto* const hinges = dynamic_cast<const Hinges*>(laws_.back().get())) {
      hinges_.push_back(hinges);
    }
    num_columns = std::max(num_columns, laws_.back()->scratch_columns());
  }
  scratch_.resize(3, num_columns);
  set_masses(mesh.masses);
  if (!empty() && has_stiffness()) set_hinges(mesh.num_nodes());
}

void BendingForces::set_masses(const VectorX<double>& masses) {
  if (empty()) return;
  masses_ = masses.cast<btScalar>();
  no_velocities_.setZero(3, masses.size());
}

// A thread that waits here must not begin the solution of another body.
void BendingForces::add_forces(ConstMatrix3XRef<btScalar> positions,
                               Matrix3XRef<btScalar> forces) const {
  isolated([&] {
    const forces::State<btScalar> state = state_at(positions);
    for (const auto& law : laws_) law->add_forces(state, scratch_, forces);
  });
}

// All memory at once: a step takes none.
void BendingForces::set_hinges(int num_nodes) {
  Eigen::Index num_hinges = 0;
  Eigen::Index most = 0;
  for (const auto* law : hinges_) {
    num_hinges += law->hinges().cols();
    most = std::max(most, law->hinges().cols());
  }
  fast::ElementStiffness::Elements nodes(4, num_hinges);
  Eigen::Index first = 0;
  for (const auto* law : hinges_) {
    nodes.middleCols(first, law->hinges().cols()) = law->hinges();
    first += law->hinges().cols();
  }
  stiffness_.set_elements(nodes, num_nodes);
  gradients_.resize(12, most);
}

fast::ElementStiffness* BendingForces::stiffness(ConstMatrix3XRef<btScalar> positions) const {
  Eigen::Index first = 0;
  for (const auto* law : hinges_) {
    const Eigen::Index count = law->hinges().cols();
    law->get_gradients(positions, gradients_.leftCols(count));
    stiffness_.gradients().middleCols(first, count) = gradients_.leftCols(count).cast<float>();
    first += count;
  }
  return &stiffness_;
}

double BendingForces::energy(ConstMatrix3XRef<btScalar> positions) const {
  double sum = 0;
  for (const auto& law : laws_) {
    sum += static_cast<double>(law->potential_energy(state_at(positions)));
  }
  return sum;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
