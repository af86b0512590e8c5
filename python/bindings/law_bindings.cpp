// Tested by tests/python/test_laws.py.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/python/bindings/core_module.hpp>
#include <weft/python/bindings/law_list.hpp>

namespace weft::python {
namespace {

py::dict parameter_row(const forces::ParameterInfo& parameter) {
  py::dict row;
  row["name"] = std::string(parameter.name);
  row["symbol"] = std::string(parameter.symbol);
  row["unit"] = std::string(parameter.unit);
  row["summary"] = std::string(parameter.summary);
  row["size"] = parameter.size;
  row["required"] = parameter.required;
  row["default"] =
      parameter.required ? py::object(py::none()) : py::float_(parameter.default_value);
  return row;
}

py::list law_table() {
  py::list table;
  for (const forces::LawInfo* law : forces::all_laws()) {
    py::list parameters;
    for (const forces::ParameterInfo& parameter : law->parameters) {
      parameters.append(parameter_row(parameter));
    }
    py::dict row;
    row["name"] = std::string(law->id);
    row["summary"] = std::string(law->summary);
    row["formula"] = std::string(law->formula);
    row["set_key"] = std::string(forces::set_key(law->traits.elements));
    row["parameters"] = parameters;
    table.append(row);
  }
  return table;
}

}  // namespace

void bind_laws(py::module_& module) {
  module.def("law_table", &law_table, "The rows of Weft's table of laws.");
  module.def(
      "checked_laws",
      [](const std::vector<LawTuple>& laws) {
        std::vector<LawTuple> result;
        for (const forces::LawSpecification& law : laws_from(laws)) result.push_back(tuple_of(law));
        return result;
      },
      py::arg("laws"), "The laws with their defaults, or InvalidArgument.");
}

}  // namespace weft::python
