#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <weft/custom_forces/force_law.hpp>

#include "tests/contract/dual/dual.hpp"
#include "tests/contract/sample.hpp"

namespace weft::contract {

/// A law with parameters, for every scalar: what the battery tests. Registered laws and sabotaged
/// ones look the same to it.
struct Subject {
  template <class Scalar>
  using Factory = std::function<std::unique_ptr<forces::ForceLaw<Scalar>>(const ClothMesh&)>;

  std::string name;  ///< "tension_given"
  forces::LawTraits traits;
  Factory<float> make_float;
  Factory<double> make_double;
  Factory<Dual> make_dual;

  /// The battery's mesh for this law.
  [[nodiscard]] ClothMesh mesh() const { return battery_mesh(traits.needs_closed_surface); }
  [[nodiscard]] ClothMesh large_mesh() const {
    return large_battery_mesh(traits.needs_closed_surface);
  }

  template <class Scalar>
  [[nodiscard]] std::unique_ptr<forces::ForceLaw<Scalar>> make(const ClothMesh& mesh) const {
    if constexpr (std::is_same_v<Scalar, float>) return make_float(mesh);
    if constexpr (std::is_same_v<Scalar, double>) return make_double(mesh);
    if constexpr (std::is_same_v<Scalar, Dual>) return make_dual(mesh);
  }
};

/// Values inside the domain of every parameter; optional ones only if with_optional.
[[nodiscard]] forces::LawSpecification typical_specification(const forces::LawInfo& info,
                                                             bool with_optional);

[[nodiscard]] Subject registered_subject(const std::string& name,
                                         const forces::LawSpecification& specification);

/// Every law of the registry: with its required parameters only, with all, and with each parameter
/// at each finite end of its domain.
[[nodiscard]] std::vector<Subject> all_subjects();

/// Those of all_subjects() whose traits satisfy the claim.
[[nodiscard]] std::vector<Subject> subjects_that(
    const std::function<bool(const forces::LawTraits&)>& claim);

}  // namespace weft::contract
