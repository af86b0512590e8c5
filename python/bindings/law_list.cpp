#include <weft/python/bindings/law_list.hpp>

#include <weft/custom_forces/registry.hpp>

namespace weft::python {

std::vector<forces::LawSpecification> laws_from(const std::vector<LawTuple>& laws) {
  std::vector<forces::LawSpecification> result;
  for (const auto& [id, sets, parameters] : laws) {
    result.push_back(forces::checked({id, sets, {parameters.begin(), parameters.end()}}));
  }
  return result;
}

LawTuple tuple_of(const forces::LawSpecification& law) {
  return {law.law, law.sets, {law.parameters.begin(), law.parameters.end()}};
}

}  // namespace weft::python
