#include "tests/contract/dual/dual_laws.hpp"

#include <map>
#include <string>

#include <weft/custom_forces/law_list.hpp>

namespace weft::contract {
namespace {

using Factory = std::unique_ptr<forces::ForceLaw<Dual>> (*)(const forces::LawSpecification&,
                                                            const ClothMesh&);

template <template <class> class Law>
std::unique_ptr<forces::ForceLaw<Dual>> make(const forces::LawSpecification& specification,
                                             const ClothMesh& mesh) {
  return std::make_unique<Law<Dual>>(specification, mesh);
}

template <template <class> class... Laws>
std::map<std::string, Factory> factories_of(forces::LawList<Laws...> /*laws*/) {
  return {{std::string(Laws<double>::kInfo.id), &make<Laws>}...};
}

}  // namespace

std::unique_ptr<forces::ForceLaw<Dual>> make_dual_law(const forces::LawSpecification& specification,
                                                      const ClothMesh& mesh) {
  static const auto kFactories = factories_of(forces::AllLaws{});
  const forces::LawSpecification values = forces::checked(specification);
  return kFactories.at(values.law)(values, mesh);
}

}  // namespace weft::contract
