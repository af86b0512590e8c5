#include <weft/bridge/implicit/energy_limit.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <weft/fast_solver/threads/node_partition.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Nodes whose terms are summed in Bullet's precision; the sums of such pieces are summed in double precision.
constexpr Eigen::Index kPiece = 128;

/// term: of the first node and the number of nodes of a piece, their sum.
template <class Term>
double sum_over(Eigen::Index num_nodes, fast::WorkerTeam& team, const Term& term) {
  std::array<double, fast::WorkerTeam::kMostParts> sums{};
  fast::run_parts(team, static_cast<int>(num_nodes), [&](int range, int begin, int end) {
    double sum = 0;
    for (Eigen::Index first = begin; first < end; first += kPiece) {
      sum += static_cast<double>(term(first, std::min(kPiece, end - first)));
    }
    sums[static_cast<std::size_t>(range)] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

double energy_put_in(const StepMotion& motion, fast::WorkerTeam& team) {
  return sum_over(motion.starts.cols(), team, [&](Eigen::Index first, Eigen::Index count) {
    const auto of = [&](const Matrix3X<btScalar>& vectors) {
      return vectors.middleCols(first, count).array();
    };
    const auto before = of(motion.start_velocities);
    const auto work = (of(motion.predicted) - before) * (of(motion.positions) - of(motion.starts)) /
                      motion.time_step;
    return (of(motion.masses) * (before * before / 2 + work)).sum();
  });
}

double kinetic_energy(const Matrix3X<btScalar>& masses, const Matrix3X<btScalar>& velocities,
                      fast::WorkerTeam& team) {
  return 0.5 * sum_over(velocities.cols(), team, [&](Eigen::Index first, Eigen::Index count) {
           const auto v = velocities.middleCols(first, count).array();
           return (masses.middleCols(first, count).array() * v * v).sum();
         });
}

void limit_energy(const Matrix3X<btScalar>& masses, double most, bool keeps_momentum,
                  Matrix3X<btScalar>& velocities, fast::WorkerTeam& team) {
  Vector3<double> mean = Vector3<double>::Zero();
  double of_mean = 0;
  if (keeps_momentum) {
    double mass = 0;
    for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
      const auto of_node = static_cast<double>(masses(0, i));
      mass += of_node;
      mean += of_node * velocities.col(i).template cast<double>();
    }
    mean /= mass;
    of_mean = 0.5 * mass * mean.squaredNorm();
  }
  const double now = kinetic_energy(masses, velocities, team);
  const double share = now > of_mean ? std::max(0.0, most - of_mean) / (now - of_mean) : 0.0;
  const auto factor = static_cast<btScalar>(std::sqrt(std::min(1.0, share)));
  const Vector3<btScalar> kept = mean.cast<btScalar>();
  for (Eigen::Index i = 0; i < velocities.cols(); ++i) {
    velocities.col(i) = kept + factor * (velocities.col(i) - kept);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
