#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft::forces {

/// What a law claims about itself. The contract tests hold every registered law to its claims.
struct LawTraits {
  bool internal = false;  ///< conserves linear and angular momentum; feels no rigid motion
  bool has_energy =
      false;  ///< the position-dependent force is minus the gradient of potential_energy
  bool dissipative = false;  ///< non_conservative_power <= 0 always
  bool uses_edges = false;   ///< acts on edge sets of the mesh
  enum class Level { kForce, kVelocity } level = Level::kForce;
};

/// One parameter of a law, as scene files, documentation and error messages show it.
struct ParameterInfo {
  std::string_view name;     ///< "stiffness"
  std::string_view symbol;   ///< "k"
  std::string_view unit;     ///< "N/m"; "1" for a dimensionless number
  std::string_view summary;  ///< half a sentence
  int size = 1;              ///< 1, or 3 for a vector
  bool required = true;
  double default_value = 0.0;  ///< for optional scalars
  double minimum = 0.0;        ///< scalars only; inclusive
  double maximum = 1e300;      ///< scalars only; inclusive
};

/// A row of the law table (registry.hpp).
struct LawInfo {
  std::string_view id;       ///< "tension"
  std::string_view summary;  ///< one sentence
  std::string_view formula;  ///< the law in one line, symbols as in parameters
  std::string_view source;   ///< where the law comes from
  LawTraits traits;
  std::span<const ParameterInfo> parameters;
};

/// A law as a scene or an application asks for it: values in SI units, vectors as three numbers.
struct LawSpecification {
  std::string law;  ///< id of the law
  std::vector<std::string>
      edge_sets;  ///< for laws that use edges; empty means all sets of the mesh
  std::map<std::string, std::vector<double>, std::less<>> parameters;
};

}  // namespace weft::forces
