#pragma once

#include <memory>

#include <weft/custom_forces/registry.hpp>

#include "tests/contract/dual/dual.hpp"

namespace weft::contract {

/// Makes a law that computes in dual numbers, as forces::make_law() does for others. The library does not need such laws, and
/// they take a third of the time that the laws take to compile.
[[nodiscard]] std::unique_ptr<forces::ForceLaw<Dual>> make_dual_law(
    const forces::LawSpecification& specification, const ClothMesh& mesh);

}  // namespace weft::contract
