#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::forces {

/// A rigid object that a cloth may meet.
struct SetUpCollider {
  std::string name;
  /// [m] half of its smallest and of its middle extent: those of a board are half of its thickness and half of its width, those of a
  /// pole its radius. Infinity for ground.
  double least_half_extent = std::numeric_limits<double>::infinity();
  double middle_half_extent = std::numeric_limits<double>::infinity();
  std::optional<double> mass = std::nullopt;  ///< [kg] of a dynamic body
  double speed = 0;                           ///< [m/s] at the start
};

/// A cloth, its laws and its surroundings before the first step, whichever engine it is for.
struct ClothSetUp {
  ClothMesh mesh;
  std::vector<LawSpecification> laws;
  double time_step = 0;  ///< [s], > 0
  bool is_always_stable =
      false;  ///< springs are solved for or projected: they blow up at no time step
  /// [s] critical_time_step() of mesh and laws, if it is known already; none: it is found where it is needed.
  std::optional<double> stable_time_step = std::nullopt;
  /// Largest k h^2 / m of a spring that an implicit step is solved with, m of the lighter node [-].
  double most_stiffness = std::numeric_limits<double>::infinity();
  bool is_single_precision = false;  ///< positions are kept as float
  bool is_swept = true;       ///< contacts are found on the way of a node too, not at its end alone
  double margin = 0;          ///< [m] distance at which the cloth rests on a surface
  double speed = 0;           ///< [m/s] of its fastest node at the start
  double layer_distance = 0;  ///< [m] that layers of the cloth keep; 0: it does not meet itself
  bool meets_cloth = false;   ///< contact with other cloths
  /// Nothing passes between nodes, and steps are divided while layers touch.
  bool keeps_layers_apart = false;
  /// [m/s^2] of the world, where a gravity law would act beside it.
  Vector3<double> world_gravity = Vector3<double>::Zero();
  std::vector<SetUpCollider> colliders = {};
};

/// Something that is allowed, and that will most likely not do what was meant.
struct SetUpWarning {
  enum class Kind {
    kUnstableStep,       ///< explicit springs blow up at this time step
    kSofterSprings,      ///< springs are solved with less stiffness than was asked for
    kSharpTriangles,     ///< triangles that are nearly segments
    kGapBetweenNodes,    ///< a ball or a pole passes between nodes
    kThinCollider,       ///< a node is on one side of it before a step and on the other after it
    kMassRatio,          ///< of a dynamic body and the cloth
    kLayersInLongSteps,  ///< contact of cloth with cloth is not reliable at this time step
    kThinLayers,         ///< layers of cloth may pass each other between nodes
    kFarFromOrigin,      ///< rounding of positions is not small beside an edge
    kGravityTwice,       ///< a gravity law beside the gravity of the world
  };
  Kind kind;
  std::string message;  ///< one line with the value, its unit, the limit, and what helps
};

/// The name of a kind in text: "unstable_step".
[[nodiscard]] std::string_view name_of(SetUpWarning::Kind kind);

/// Triangles with an angle below this count as sharp [rad]: 3 degrees, where an edge is 19 times as long as another.
inline constexpr double kSharpAngle = 0.05235987755982989;
/// Masses of a body and a cloth that impacts are validated for, one over the other [-].
inline constexpr double kLargestMassRatio = 1000;
/// The longest steps in which a cloth that meets itself, and layers of several cloths, come to rest [s]
/// (tests of the scenes towel and stack).
inline constexpr double kLongestStepWithItself = 1.0 / 150;
inline constexpr double kLongestStepWithLayers = 1.0 / 250;
/// Rounding of a position over the shortest edge, from which on strains are noise [-].
inline constexpr double kLargestRounding = 1e-4;

/// Lists what a user would want to know before the first step, in the order of the kinds. Each is decided by a formula or by a limit that
/// tests have measured; docs/warnings.md lists them. Throws InvalidArgument as make_law(), and for a time step that is not > 0.
[[nodiscard]] std::vector<SetUpWarning> find_warnings(const ClothSetUp& set_up);

}  // namespace weft::forces
