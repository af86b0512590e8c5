#pragma once

// Tested by tests/custom_forces/law_set_test.cpp, tests/contract/input_contract_test.cpp.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft::forces {

/// What the elements are that a law sums over.
enum class ElementKind {
  kNodes,        ///< every node by itself, or the body as a whole
  kEdges,        ///< edge sets of the mesh
  kLines,        ///< line sets: three nodes in a row
  kHinges,       ///< pairs of triangles with an edge in common
  kFaces,        ///< triangles
  kConnections,  ///< connection sets: a node with its ring, and a far node
  kNodeSets,     ///< node sets: regions of the mesh
};

/// The part that a law plays for solvers, readers and windows that treat some laws in a way of their own. They ask for it in place of
/// the id.
enum class LawRole {
  kOther,
  kSpring,        ///< elastic force along edges: parameters stiffness, compression_ratio
  kSpringDamper,  ///< viscous force along edges: parameter damping
  kBending,       ///< resists bending; add_rest_stiffness says how strongly
  kGravity,       ///< the same acceleration for all nodes: parameter acceleration
  kWind,          ///< moving air: parameter velocity
};

/// What a law claims about itself. The contract tests hold every registered law to its claims.
struct LawTraits {
  /// conserves linear and angular momentum and knows no direction of the world
  bool internal = false;
  bool ignores_rigid_motion = false;  ///< velocities of a rigid motion add no force
  bool free_at_rest = false;          ///< no force at the rest shape without velocity
  /// the position-dependent force is minus the gradient of potential_energy
  bool has_energy = false;
  bool dissipative = false;  ///< non_conservative_power <= 0 always
  ElementKind elements = ElementKind::kNodes;
  bool needs_closed_surface = false;  ///< refuses a mesh whose triangles leave a hole
  /// the force on a node is the same function of its own place, velocity and mass for every node, computed by the
  /// thread that asks: a state of some of the nodes gives theirs
  bool is_pointwise = false;
  enum class Level {
    kForce,     ///< adds forces
    kVelocity,  ///< a damper whose exact action on velocities is known: advance_velocities
    kInertia,   ///< adds no force, but shares out the sum of all others: redistribute_forces
  } level = Level::kForce;
  LawRole role = LawRole::kOther;
};

/// Name of the key that holds the sets of a law: "edge_sets", "line_sets", "connection_sets",
/// "node_sets"; empty for a law that takes no sets.
[[nodiscard]] std::string_view set_key(ElementKind elements);

/// One parameter of a law, as scene files, documentation and error messages show it.
struct ParameterInfo {
  std::string_view name;     ///< "stiffness"
  std::string_view symbol;   ///< "k"
  std::string_view unit;     ///< "N/m"; "1" for a dimensionless number
  std::string_view summary;  ///< half a sentence
  int size = 1;              ///< 1, or 3 for a vector
  bool required = true;
  double default_value = 0.0;  ///< for optional ones; of each number of a vector
  double minimum = 0.0;        ///< scalars only; inclusive
  double maximum = 1e300;      ///< scalars only; inclusive
};

/// A row of the law table (registry.hpp).
struct LawInfo {
  std::string_view id;          ///< "tension"
  std::string_view summary;     ///< one sentence
  std::string_view formula;     ///< the law in one line, symbols as in parameters
  std::string_view source;      ///< where the law comes from
  std::string_view checked_by;  ///< validation cases and tests beside the contract tests
  LawTraits traits;
  std::span<const ParameterInfo> parameters;
};

/// A law as a scene or an application asks for it: values in SI units, vectors as three numbers.
struct LawSpecification {
  std::string law;  ///< id of the law
  /// Edge, line, connection or node sets, as the law's elements are; empty means all of the mesh.
  std::vector<std::string> sets;
  std::map<std::string, std::vector<double>, std::less<>> parameters;
};

}  // namespace weft::forces
