#include <weft/fast_solver/network_forces.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

#include <tbb/parallel_for.h>

#include <weft/custom_forces/spring_set.hpp>

namespace weft::fast {
namespace {

/// Nodes per task where each node takes some 30 ns.
constexpr int kNodeGrain = 1024;

}  // namespace

template <class Scalar>
NetworkForces<Scalar>::NetworkForces(const SpringNetwork& network, int num_nodes)
    : assembly_(network.edges, num_nodes) {
  const Eigen::Index m = network.edges.cols();
  const auto ordered = [&](const VectorX<double>& values) {
    Values result(m);
    for (Eigen::Index p = 0; p < m; ++p) {
      result[p] = static_cast<Scalar>(values[assembly_.order()[static_cast<std::size_t>(p)]]);
    }
    return result;
  };
  rest_lengths_ = ordered(network.rest_lengths);
  stiffness_ = ordered(network.stiffness);
  relief_ = ordered(network.compressed_stiffness - network.stiffness);
  damping_ = ordered(network.damping);
  stabiliser_ = ordered(network.stabiliser);
  start_lengths_ = rest_lengths_;
  linear_.setZero(m, 4);
  has_damping_ = (damping_.array() != Scalar(0)).any();
  has_stabiliser_ = (stabiliser_.array() != Scalar(0)).any();
  scratch_.resize(3, assembly_.scratch_columns(2));
  product_scratch_.resize(3, assembly_.scratch_columns(1));
  const auto n = static_cast<std::size_t>(num_nodes);
  place_starts_.assign(n + 1, 0);
  const auto edge_at = [&](Eigen::Index p) {
    return network.edges.col(assembly_.order()[static_cast<std::size_t>(p)]);
  };
  for (Eigen::Index p = 0; p < m; ++p) {
    for (const int node : edge_at(p)) ++place_starts_[static_cast<std::size_t>(node) + 1];
  }
  for (std::size_t i = 0; i < n; ++i) place_starts_[i + 1] += place_starts_[i];
  places_.resize(static_cast<std::size_t>(2 * m));
  std::vector<int> next(place_starts_.begin(), place_starts_.end() - 1);
  for (Eigen::Index p = 0; p < m; ++p) {
    for (const int node : edge_at(p)) {
      places_[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] =
          static_cast<int>(p);
    }
  }
}

template <class Scalar>
void NetworkForces<Scalar>::begin_step(ConstMatrix3XRef<Scalar> starts, Scalar time_step) {
  inverse_time_step_ = Scalar(1) / time_step;
  if (!has_damping_) return;
  for (Eigen::Index p = 0; p < start_lengths_.size(); ++p) {
    const auto e = assembly_.order()[static_cast<std::size_t>(p)];
    start_lengths_[p] =
        (starts.col(assembly_.edges()(1, e)) - starts.col(assembly_.edges()(0, e))).norm();
  }
}

template <class Scalar>
void NetworkForces<Scalar>::add_forces(ConstMatrix3XRef<Scalar> places,
                                       ConstMatrix3XRef<Scalar> starts,
                                       Matrix3XRef<Scalar> forces) {
  const Eigen::Index m = rest_lengths_.size();
  const Scalar* const rest = rest_lengths_.data();
  const Scalar* const stretched = stiffness_.data();
  const Scalar* const relief = relief_.data();
  const Scalar* const damping = damping_.data();
  const Scalar* const stabiliser = stabiliser_.data();
  const Scalar* const start_lengths = start_lengths_.data();
  std::int32_t* const linear = linear_.data();
  const Scalar inverse_time_step = inverse_time_step_;
  const auto along_edge = [=](Eigen::Index place, const forces::PlainVector<Scalar>& d,
                              const auto&... changes) -> forces::PlainVector<Scalar> {
    // No choices here, for a branch would end the vectors. The least length keeps a spring without a
    // direction from exerting a force and changes no other in single precision.
    const Scalar least = Scalar(forces::kMinLengthRatio) * rest[place];
    const Scalar length = std::sqrt(d.squared_norm() + least * least);
    const Scalar inverse = Scalar(1) / length;
    const Scalar extension = length - rest[place];
    const Scalar is_compressed = Scalar(0.5) - std::copysign(Scalar(0.5), extension);
    const Scalar k = stretched[place] + is_compressed * relief[place];
    const Scalar c = damping[place] * inverse_time_step;
    const Scalar force = k * extension + c * (length - start_lengths[place]);
    const Scalar tension = force * inverse;
    const Scalar across =
        Scalar(0.5) * (tension + std::abs(tension));  // max(0, tension) without a branch
    const Scalar difference = k + c - across;
    const Scalar root = std::sqrt(std::abs(difference)) * inverse;  // >= 0 but for rounding
    linear[place] = std::bit_cast<std::int32_t>(static_cast<float>(root * d.x));
    linear[m + place] = std::bit_cast<std::int32_t>(static_cast<float>(root * d.y));
    linear[2 * m + place] = std::bit_cast<std::int32_t>(static_cast<float>(root * d.z));
    linear[3 * m + place] =
        std::bit_cast<std::int32_t>(static_cast<float>(across + stabiliser[place]));
    forces::PlainVector<Scalar> f = tension * d;
    ((f = f + stabiliser[place] * (d - changes)), ...);
    return f;
  };
  if (has_stabiliser_) {
    assembly_.template add_pairs<Scalar>(along_edge, scratch_, forces, places, starts);
  } else {
    assembly_.template add_pairs<Scalar>(along_edge, scratch_, forces, places);
  }
}

template <class Scalar>
double NetworkForces<Scalar>::potential(ConstMatrix3XRef<Scalar> places,
                                        ConstMatrix3XRef<Scalar> starts) const {
  double sum = 0;
  for (Eigen::Index p = 0; p < rest_lengths_.size(); ++p) {
    const auto edge = assembly_.edges().col(assembly_.order()[static_cast<std::size_t>(p)]);
    const Vector3<Scalar> d = places.col(edge[1]) - places.col(edge[0]);
    const Scalar length = d.norm();
    const Scalar extension = length - rest_lengths_[p];
    const Scalar k = stiffness_[p] + (extension < Scalar(0) ? relief_[p] : Scalar(0));
    const Scalar stretched = length - start_lengths_[p];
    Scalar twice =
        k * extension * extension + damping_[p] * inverse_time_step_ * stretched * stretched;
    if (has_stabiliser_) {
      const Vector3<Scalar> start = starts.col(edge[1]) - starts.col(edge[0]);
      twice += stabiliser_[p] * (d - start).squaredNorm();
    }
    sum += 0.5 * static_cast<double>(twice);
  }
  return sum;
}

template <class Scalar>
void NetworkForces<Scalar>::add_product(ConstMatrix3XRef<float> displacements,
                                        Matrix3XRef<float> product) {
  const Eigen::Index m = rest_lengths_.size();
  const std::int32_t* const linear = linear_.data();
  const auto along_edge = [=](Eigen::Index place,
                              const forces::PlainVector<float>& d) -> forces::PlainVector<float> {
    const auto ux = std::bit_cast<float>(linear[place]);
    const auto uy = std::bit_cast<float>(linear[m + place]);
    const auto uz = std::bit_cast<float>(linear[2 * m + place]);
    const auto t = std::bit_cast<float>(linear[3 * m + place]);
    const float along = -(ux * d.x + uy * d.y + uz * d.z);
    return {along * ux - t * d.x, along * uy - t * d.y, along * uz - t * d.z};
  };
  assembly_.template add_pairs<float>(along_edge, product_scratch_, product, displacements);
}

template <class Scalar>
void NetworkForces<Scalar>::diagonal_blocks(
    Eigen::Ref<Eigen::Matrix<float, 6, Eigen::Dynamic>> blocks) const {
  const Eigen::Index m = rest_lengths_.size();
  const std::int32_t* const linear = linear_.data();
  tbb::parallel_for(tbb::blocked_range<int>(0, num_nodes(), kNodeGrain), [&](const auto& range) {
    for (int i = range.begin(); i != range.end(); ++i) {
      float sum[6] = {};
      const auto node = static_cast<std::size_t>(i);
      for (int k = place_starts_[node]; k < place_starts_[node + 1]; ++k) {
        const std::int32_t* const u = linear + places_[static_cast<std::size_t>(k)];
        const auto x = std::bit_cast<float>(u[0]);
        const auto y = std::bit_cast<float>(u[m]);
        const auto z = std::bit_cast<float>(u[2 * m]);
        const auto t = std::bit_cast<float>(u[3 * m]);
        sum[0] += x * x + t;
        sum[1] += y * y + t;
        sum[2] += z * z + t;
        sum[3] += x * y;
        sum[4] += y * z;
        sum[5] += z * x;
      }
      for (int c = 0; c < 6; ++c) blocks(c, i) = sum[c];
    }
  });
}

template class NetworkForces<float>;
template class NetworkForces<double>;

}  // namespace weft::fast
