#include <weft/validation/cases/support/parameters.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <weft/core/error.hpp>
#include <weft/validation/theory/theory_runs.hpp>

namespace weft::validation {
namespace {

const CaseParameter* find(const CaseInfo& info, std::string_view name) {
  const auto found =
      std::find_if(info.parameters.begin(), info.parameters.end(),
                   [&](const CaseParameter& parameter) { return parameter.name == name; });
  return found == info.parameters.end() ? nullptr : &*found;
}

std::string names_of(const CaseInfo& info) {
  std::string names;
  for (const CaseParameter& parameter : info.parameters) {
    names += (names.empty() ? "" : ", ") + std::string(parameter.name);
  }
  return names.empty() ? "none" : names;
}

}  // namespace

void check_values(const CaseInfo& info, const CaseOptions& options) {
  for (const auto& [name, value] : options.values) {
    const CaseParameter* parameter = find(info, name);
    if (parameter == nullptr) {
      throw InvalidArgument(
          fmt::format("validate: case '{}' has no parameter '{}', expected one of: {}", info.id,
                      name, names_of(info)));
    }
    const bool is_inside = value >= parameter->minimum && value <= parameter->maximum;
    if (!is_inside || (parameter->is_whole && value != std::floor(value))) {
      throw InvalidArgument(fmt::format("validate: case '{}': {} = {} [{}], expected {}{} to {}",
                                        info.id, name, value, parameter->unit,
                                        parameter->is_whole ? "a whole number, " : "",
                                        parameter->minimum, parameter->maximum));
    }
  }
  if (options.engine.empty() || (options.engine == "reference" && info.evaluate != nullptr)) return;
  std::vector<std::string> engines =
      info.theory ? theory_engine_names(options.bullet) : std::vector<std::string>{"reference"};
  if (std::find(engines.begin(), engines.end(), options.engine) != engines.end()) return;
  throw InvalidArgument(fmt::format("validate: case '{}': engine '{}', expected one of: {}",
                                    info.id, options.engine, fmt::join(engines, ", ")));
}

double value_of(const CaseInfo& info, const CaseOptions& options, std::string_view name) {
  const CaseParameter* parameter = find(info, name);
  if (parameter == nullptr || (!parameter->default_value && !options.values.contains(name))) {
    throw InvalidArgument(fmt::format("validate: case '{}' needs a value for '{}'", info.id, name));
  }
  return value_or(options, name, parameter->default_value.value_or(0.0));
}

double value_or(const CaseOptions& options, std::string_view name, double chosen) {
  const auto found = options.values.find(name);
  return found == options.values.end() ? chosen : found->second;
}

std::string describe(const CaseInfo& info) {
  std::string text = fmt::format("{:<22} {:<8} {}\n", info.id,
                                 info.tier == Tier::kCommit ? "commit" : "nightly", info.summary);
  for (const CaseParameter& parameter : info.parameters) {
    const std::string chosen = parameter.default_value
                                   ? fmt::format("default {}", *parameter.default_value)
                                   : "default chosen by the case";
    text += fmt::format("    --{} [{}]  {}; {} to {}{}, {}\n", parameter.name, parameter.unit,
                        parameter.summary, parameter.minimum, parameter.maximum,
                        parameter.is_whole ? ", whole" : "", chosen);
  }
  return text;
}

}  // namespace weft::validation
