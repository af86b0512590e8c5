#include <weft/fast_solver/prepared_solvers.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

namespace weft::fast {
namespace {

/// The hash of numbers in a row takes eight bytes at a time; what is left over counts as a last word.
template <class Number>
std::uint64_t hash_of(const Number* numbers, Eigen::Index count, std::uint64_t hash) {
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;  // 2^64 over the golden section
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers);
  for (std::size_t left = sizeof(Number) * static_cast<std::size_t>(count); left > 0;) {
    std::uint64_t word = 0;
    const std::size_t taken = std::min(left, sizeof word);
    std::memcpy(&word, bytes, taken);
    hash = (hash ^ word) * kFactor;
    hash ^= hash >> 29U;
    bytes += taken;
    left -= taken;
  }
  return hash;
}

}  // namespace

template <class Scalar>
bool PreparedSolvers<Scalar>::Kind::operator==(const Kind& other) const {
  const auto& [edges, rest_lengths, stiffness, compressed, damping, bending] = other.network;
  return is_free == other.is_free && masses.size() == other.masses.size() &&
         network.edges.cols() == edges.cols() && masses == other.masses && network.edges == edges &&
         network.rest_lengths == rest_lengths && network.stiffness == stiffness &&
         network.compressed_stiffness == compressed && network.damping == damping &&
         network.bending == bending;
}

template <class Scalar>
std::uint64_t PreparedSolvers<Scalar>::Kind::hash() const {
  std::uint64_t result = hash_of(masses.data(), masses.size(), 1);
  result = hash_of(network.edges.data(), network.edges.size(), result);
  for (const VectorX<double>* values :
       {&network.rest_lengths, &network.stiffness, &network.compressed_stiffness, &network.damping,
        &network.bending}) {
    result = hash_of(values->data(), values->size(), result);
  }
  return result;
}

template <class Scalar>
typename PreparedSolvers<Scalar>::Prepared PreparedSolvers<Scalar>::find(std::uint64_t hash) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(list_.begin(), list_.end(),
                                  [&](const Prepared& prepared) { return prepared.hash == hash; });
  if (known != list_.end()) {
    std::rotate(known, known + 1, list_.end());
    return list_.back();
  }
  if (list_.size() == kMostKinds) list_.erase(list_.begin());
  list_.push_back({hash, nullptr, nullptr});
  return {};
}

template <class Scalar>
void PreparedSolvers<Scalar>::leave(const Prepared& prepared) {
  const std::lock_guard lock(mutex_);
  for (Prepared& known : list_) {
    if (known.hash == prepared.hash && !known.solver) known = prepared;
  }
}

template <class Scalar>
std::unique_ptr<ImplicitSolver<Scalar>> PreparedSolvers<Scalar>::make(
    const SpringNetwork& network, const VectorX<double>& masses, const std::vector<bool>& is_free) {
  Kind kind{network, masses.cast<Scalar>(), is_free};
  // Meshes that are alike but for their place differ by what rounding leaves of positions.
  kind.network.rest_lengths = network.rest_lengths.template cast<Scalar>().template cast<double>();
  const std::uint64_t hash = kind.hash();
  const Prepared known = find(hash);
  if (known.solver && *known.kind == kind) {
    ++num_shared_;
    return std::make_unique<Solver>(*known.solver);
  }
  auto solver = std::make_unique<Solver>(network, masses, is_free);
  const bool is_second = known.hash == hash && !known.solver;
  if (is_second) {
    leave({hash, std::make_shared<const Kind>(std::move(kind)),
           std::make_shared<const Solver>(*solver)});
  }
  return solver;
}

template class PreparedSolvers<float>;
template class PreparedSolvers<double>;

}  // namespace weft::fast
