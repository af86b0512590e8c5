#pragma once

// Tested by tests/contract/input_contract_test.cpp, tests/contract/law_contract_test.cpp.

#include <memory>
#include <span>
#include <string_view>

#include <weft/custom_forces/force_law.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// Every law of Weft, in a fixed order.
[[nodiscard]] std::span<const LawInfo* const> all_laws();

/// The law with this id, or nullptr.
[[nodiscard]] const LawInfo* find_law(std::string_view id);

/// The role of the law with this id; kOther for an id that no law has.
[[nodiscard]] LawRole role_of(std::string_view id);

/// Fills in defaults and checks names, sizes and domains of the parameters, and the edge sets.
/// Throws InvalidArgument that names the law, the parameter, its value and unit and what was
/// expected.
[[nodiscard]] LawSpecification checked(const LawSpecification& specification);

/// Makes a law for a mesh. Scalar is float or double. Throws as checked(), and for a mesh
/// that the law cannot use (an unknown edge set, a spring of zero rest length).
template <class Scalar>
[[nodiscard]] std::unique_ptr<ForceLaw<Scalar>> make_law(const LawSpecification& specification,
                                                         const ClothMesh& mesh);

template <>
std::unique_ptr<ForceLaw<float>> make_law<float>(const LawSpecification& specification,
                                                 const ClothMesh& mesh);
template <>
std::unique_ptr<ForceLaw<double>> make_law<double>(const LawSpecification& specification,
                                                   const ClothMesh& mesh);

}  // namespace weft::forces
