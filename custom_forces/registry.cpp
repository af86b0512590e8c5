#include <weft/custom_forces/registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <weft/core/error.hpp>
#include <weft/custom_forces/law_list.hpp>

namespace weft::forces {
namespace {

template <class Scalar>
using Factory = std::unique_ptr<ForceLaw<Scalar>> (*)(const LawSpecification&, const ClothMesh&);

template <template <class> class Law, class Scalar>
std::unique_ptr<ForceLaw<Scalar>> make(const LawSpecification& specification,
                                       const ClothMesh& mesh) {
  return std::make_unique<Law<Scalar>>(specification, mesh);
}

struct Row {
  const LawInfo* info;
  Factory<float> make_float;
  Factory<double> make_double;
};

template <template <class> class Law>
Row row() {
  return {&Law<double>::kInfo, &make<Law, float>, &make<Law, double>};
}

template <template <class> class... Laws>
std::vector<Row> rows_of(LawList<Laws...> /*laws*/) {
  return {row<Laws>()...};
}

const std::vector<Row>& rows() {
  static const std::vector<Row> kRows = rows_of(AllLaws{});
  return kRows;
}

const Row& find_row(std::string_view id) {
  std::string known;
  for (const Row& row : rows()) {
    if (row.info->id == id) return row;
    known += (known.empty() ? "" : ", ") + std::string(row.info->id);
  }
  throw InvalidArgument("law '" + std::string(id) + "' is unknown, expected one of: " + known);
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

[[noreturn]] void refuse(const LawSpecification& specification, const ParameterInfo& parameter,
                         const std::string& value, const std::string& expected) {
  throw InvalidArgument(specification.law + ": " + std::string(parameter.name) + " = " + value +
                        " [" + std::string(parameter.unit) + "], expected " + expected);
}

void check_values(const LawSpecification& specification, const ParameterInfo& parameter,
                  const std::vector<double>& values) {
  if (static_cast<int>(values.size()) != parameter.size) {
    refuse(specification, parameter, std::to_string(values.size()) + " numbers",
           std::to_string(parameter.size));
  }
  for (const double value : values) {
    if (!std::isfinite(value)) refuse(specification, parameter, number(value), "a finite number");
    if (parameter.size > 1) continue;
    if (value < parameter.minimum) {
      refuse(specification, parameter, number(value), ">= " + number(parameter.minimum));
    }
    if (value > parameter.maximum) {
      refuse(specification, parameter, number(value), "<= " + number(parameter.maximum));
    }
  }
}

void check_names(const LawSpecification& specification, const LawInfo& info) {
  for (const auto& [name, values] : specification.parameters) {
    std::string known;
    bool found = false;
    for (const ParameterInfo& parameter : info.parameters) {
      found = found || parameter.name == name;
      known += (known.empty() ? "" : ", ") + std::string(parameter.name);
    }
    if (!found) {
      throw InvalidArgument(specification.law + ": parameter '" + name +
                            "' is unknown, expected one of: " + known);
    }
  }
  const std::string key(set_key(info.traits.elements));
  if (key.empty() && !specification.sets.empty()) {
    throw InvalidArgument(specification.law + ": sets = '" + specification.sets.front() +
                          "', expected none, for this law takes no sets");
  }
  for (auto name = specification.sets.begin(); name != specification.sets.end(); ++name) {
    if (std::find(specification.sets.begin(), name, *name) != name) {
      throw InvalidArgument(specification.law + ": " + key + " names '" + *name +
                            "' twice, expected each set once");
    }
  }
}

}  // namespace

std::string_view set_key(ElementKind elements) {
  switch (elements) {
    case ElementKind::kEdges:
      return "edge_sets";
    case ElementKind::kLines:
      return "line_sets";
    case ElementKind::kConnections:
      return "connection_sets";
    case ElementKind::kNodeSets:
      return "node_sets";
    case ElementKind::kNodes:
    case ElementKind::kHinges:
    case ElementKind::kFaces:
      break;
  }
  return {};
}

std::span<const LawInfo* const> all_laws() {
  static const auto kInfos = [] {
    std::vector<const LawInfo*> infos;
    for (const Row& row : rows()) infos.push_back(row.info);
    return infos;
  }();
  return kInfos;
}

const LawInfo* find_law(std::string_view id) {
  for (const LawInfo* info : all_laws()) {
    if (info->id == id) return info;
  }
  return nullptr;
}

LawRole role_of(std::string_view id) {
  const LawInfo* info = find_law(id);
  return info == nullptr ? LawRole::kOther : info->traits.role;
}

LawSpecification checked(const LawSpecification& specification) {
  const LawInfo& info = *find_row(specification.law).info;
  check_names(specification, info);
  LawSpecification result = specification;
  for (const ParameterInfo& parameter : info.parameters) {
    const auto given = result.parameters.find(parameter.name);
    if (given == result.parameters.end()) {
      if (parameter.required) {
        throw InvalidArgument(specification.law + ": parameter '" + std::string(parameter.name) +
                              "' is missing, expected a value in " + std::string(parameter.unit));
      }
      result.parameters.emplace(
          parameter.name,
          std::vector<double>(static_cast<std::size_t>(parameter.size), parameter.default_value));
      continue;
    }
    check_values(specification, parameter, given->second);
  }
  return result;
}

template <>
std::unique_ptr<ForceLaw<float>> make_law<float>(const LawSpecification& specification,
                                                 const ClothMesh& mesh) {
  const Row& row = find_row(specification.law);
  const LawSpecification values = checked(specification);
  for (const ParameterInfo& parameter : row.info->parameters) {
    for (const double value : values.parameters.find(parameter.name)->second) {
      if (std::abs(value) > double{std::numeric_limits<float>::max()}) {
        refuse(specification, parameter, number(value), "a single-precision number");
      }
    }
  }
  return row.make_float(values, mesh);
}

template <>
std::unique_ptr<ForceLaw<double>> make_law<double>(const LawSpecification& specification,
                                                   const ClothMesh& mesh) {
  return find_row(specification.law).make_double(checked(specification), mesh);
}

}  // namespace weft::forces
