#pragma once

// Tested by tests/python/test_laws.py.

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <weft/custom_forces/law_info.hpp>

namespace weft::python {

/// A law as weft/laws.py hands it over: id, sets, parameters.
using LawTuple =
    std::tuple<std::string, std::vector<std::string>, std::map<std::string, std::vector<double>>>;

/// Throws InvalidArgument as forces::checked().
[[nodiscard]] std::vector<forces::LawSpecification> laws_from(const std::vector<LawTuple>& laws);
[[nodiscard]] LawTuple tuple_of(const forces::LawSpecification& law);

}  // namespace weft::python
