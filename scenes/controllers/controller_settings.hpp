#pragma once

// Tested by tests/scenes/controllers_test.cpp, tests/scenes/controllers/detail_test.cpp.

#include <string>
#include <variant>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/scenes/motion/path.hpp>

namespace weft::scenes {

/// What [[controller]] says: settings of the controllers that come with Weft, one struct for each kind.

/// Draws a cloth towards a target, as if it crept there: the heart of the ooze of Werth 2008. It
/// pushes the nodes of a region and turns them about the vertical; the cloth follows through its
/// own laws.
struct Seek {
  std::string cloth;
  std::string region;              ///< of the cloth
  Path target;                     ///< [m]; only its horizontal part counts
  Vector3<double> front{0, 0, 1};  ///< direction at the start that shall look at the target [-]
  double speed = 0.2;              ///< [m/s], > 0
  double force = 1.0;              ///< [N], >= 0: the largest, all nodes together
  double turn_rate = 1.0;          ///< [rad/s], > 0
  double torque = 0.0;             ///< [N m], >= 0: the largest
  double arrival = 0.1;            ///< [m], > 0: slows down within this distance
};

/// Rolls a body towards a target by a torque about its centre of mass.
struct Roll {
  std::string cloth;
  Path target;             ///< [m]; only its horizontal part counts
  double turn_rate = 3.0;  ///< [rad/s], > 0: of rolling
  double torque = 1.0;     ///< [N m], >= 0: the largest
  double arrival = 0.5;    ///< [m], > 0: rolls slower within this distance
};

/// Ties nodes of a cloth to a collider by springs without length, each from a node to the place that
/// it has in the collider's frame at the start. What pulls the cloth pulls a collider with a mass back.
struct Attach {
  std::string cloth;
  std::string region;      ///< of the cloth
  std::string to;          ///< name of a collider
  double stiffness = 0.0;  ///< [N/m] of each spring, > 0
  double damping = 0.0;    ///< [N s/m] of each, >= 0
};

/// How a cloth gets its places.
enum class DetailLevel {
  kFull,        ///< the engine simulates it
  kSimplified,  ///< each node follows its animated place by itself, as a damped point
  kSkin,        ///< each node is at its animated place
};
struct DetailSwitch {
  double time;  ///< [s] at the end of the first step with it
  DetailLevel level;
};

/// Level of detail of one cloth. Its animated places are those that a character's bones have for
/// it; a cloth of no character keeps the shape that it had when it was last simulated, and its pins
/// carry that along.
struct Detail {
  std::string cloth;
  std::vector<DetailSwitch> levels = {};  ///< times growing; before the first one: full
  double blend = 0.3;                     ///< [s], >= 0, in which a switch to kSkin or kFull ends
  double follow = 2.0;                    ///< [Hz], > 0, of the damped points
};

using ControllerSettings = std::variant<Seek, Roll, Attach, Detail>;

}  // namespace weft::scenes
