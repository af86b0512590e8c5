#include <weft/bridge/implicit/bending_forces.hpp>

#include <algorithm>

#include <weft/core/parallel/threads.hpp>
#include <weft/fast_solver/network/spring_network.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void BendingForces::set_laws(const forces::LawSet<btScalar>& laws,
                             const VectorX<btScalar>& masses) {
  laws_.clear();
  Eigen::Index num_columns = 0;
  for (const auto& law : laws.laws()) {
    if (!fast::is_bending(law->info().id)) continue;
    laws_.push_back(law.get());
    num_columns = std::max(num_columns, law->scratch_columns());
  }
  if (laws_.empty()) return;
  masses_ = masses;
  scratch_.resize(3, num_columns);
}

void BendingForces::begin_step(ConstMatrix3XRef<btScalar> starts) {
  if (no_velocities_.cols() != starts.cols()) no_velocities_.setZero(3, starts.cols());
  start_forces_.setZero(3, starts.cols());
  add_law_forces(starts, start_forces_);
}

// A thread that waits here must not begin the solution of another body.
void BendingForces::add_law_forces(ConstMatrix3XRef<btScalar> positions,
                                   Matrix3XRef<btScalar> forces) const {
  isolated([&] {
    const forces::State<btScalar> state{positions, no_velocities_, masses_, 0.0};
    for (const auto* law : laws_) law->add_forces(state, scratch_, forces);
  });
}

void BendingForces::add_forces(ConstMatrix3XRef<btScalar> positions,
                               Matrix3XRef<btScalar> forces) const {
  add_law_forces(positions, forces);
  forces -= start_forces_;
}

double BendingForces::energy(ConstMatrix3XRef<btScalar> positions) const {
  const forces::State<btScalar> state{positions, no_velocities_, masses_, 0.0};
  double sum = start_forces_.cwiseProduct(positions).cast<double>().sum();
  for (const auto* law : laws_) sum += static_cast<double>(law->potential_energy(state));
  return sum;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
