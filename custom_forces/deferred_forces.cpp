#include <weft/custom_forces/deferred_forces.hpp>

#include <cstring>

#include <weft/core/trace.hpp>

namespace weft::forces {
namespace {

/// Bits and not values: 0 and -0 differ, a NaN equals itself.
template <class Stored, class Given>
bool same_bits(const Stored& stored, const Given& given) {
  if (stored.rows() != given.rows() || stored.cols() != given.cols()) return false;
  const auto bytes =
      static_cast<std::size_t>(stored.rows()) * sizeof(typename Stored::Scalar);  // of a column
  if (given.outerStride() == stored.rows() || stored.cols() == 1) {
    return stored.size() == 0 || std::memcmp(stored.data(), given.data(),
                                             bytes * static_cast<std::size_t>(stored.cols())) == 0;
  }
  for (Eigen::Index i = 0; i < stored.cols(); ++i) {
    if (std::memcmp(stored.col(i).data(), given.col(i).data(), bytes) != 0) return false;
  }
  return true;
}

}  // namespace

template <class Scalar>
void DeferredForces<Scalar>::compute(const State<Scalar>& state) {
  forces_.setZero(3, state.positions.cols());
  report_ = laws_.add_forces(state, velocity_laws_, forces_);
}

template <class Scalar>
bool DeferredForces<Scalar>::is_state_of_begin(const State<Scalar>& state) const {
  return same_bits(positions_, state.positions) && same_bits(velocities_, state.velocities) &&
         same_bits(masses_, state.masses) && time_ == state.time;
}

template <class Scalar>
void DeferredForces<Scalar>::begin(const State<Scalar>& state) {
  drop();
  const TraceScope trace("begin forces");
  positions_ = state.positions;
  velocities_ = state.velocities;
  masses_ = state.masses;
  time_ = state.time;
  is_in_flight_ = true;
  task_.start(1, [this](std::size_t) {
    const TraceScope task("deferred forces");
    compute({positions_, velocities_, masses_, time_});
  });
}

template <class Scalar>
ForceReport DeferredForces<Scalar>::finish(const State<Scalar>& state, Matrix3X<Scalar>& forces) {
  const TraceScope trace("finish forces");
  if (!is_in_flight_) {
    compute(state);
  } else if (!is_state_of_begin(state)) {
    drop();
    ++num_recomputed_;
    compute(state);
  } else {
    const TraceScope wait("wait for forces");
    is_in_flight_ = false;
    task_.wait();
  }
  forces.swap(forces_);
  return report_;
}

template <class Scalar>
void DeferredForces<Scalar>::drop() noexcept {
  if (!is_in_flight_) return;
  is_in_flight_ = false;
  task_.cancel();
  try {
    task_.wait();
  } catch (...) {
    // What a law threw concerned forces that nobody wants any more.
  }
}

template class DeferredForces<float>;
template class DeferredForces<double>;

}  // namespace weft::forces
