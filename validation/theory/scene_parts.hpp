#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <functional>
#include <string>
#include <vector>

#include <weft/scenes/scene.hpp>
#include <weft/validation/cases/support/case.hpp>
#include <weft/validation/cases/support/sabotage.hpp>

namespace weft::validation {

inline constexpr double kTheoryGravity = 9.81;  // [m/s^2]

/// A world with frames every 1/30 s times frames_apart. Steps are the longest that divide 1/30 s and are at most
/// longest_step [s]; the duration is rounded up to whole frames.
[[nodiscard]] scenes::World theory_world(double duration, double longest_step, int frames_apart);

/// A rope of springs with one mass per node: tension on its next neighbors, and gravity if asked for.
struct RopeParts {
  int springs = 1;
  Vector3<double> start{0, 0, 0};  ///< [m]
  Vector3<double> end{1, 0, 0};    ///< [m]
  double node_mass = 1.0;          ///< [kg], of every node
  double stiffness = 1.0;          ///< of every spring [N/m]
  bool has_gravity = false;
  double rate = 0.0;     ///< of velocity_damping [1/s]
  double damping = 0.0;  ///< of spring_damping [N s/m]
  std::vector<int> pinned;
};
[[nodiscard]] scenes::Cloth rope_cloth(const RopeParts& parts);

/// A scene of one cloth.
[[nodiscard]] scenes::Scene theory_scene(const std::string& name, const scenes::World& world,
                                         scenes::Cloth cloth, bool has_gravity);

/// A node that is led from its place to another within a time [s], and held there.
[[nodiscard]] scenes::MovingPin led_node(int node, const Vector3<double>& from,
                                         const Vector3<double>& to, double time);

/// A parameter of a law times a factor, everywhere.
[[nodiscard]] Sabotage law_scaled(const std::string& name, const std::string& law,
                                  const std::string& parameter, double factor);
/// A drag on every node, for numbers that a loss of energy must change [1/s].
[[nodiscard]] Sabotage drag_added(double rate);

/// Throws InvalidArgument if one of these is asked for: engines other than the reference's own evaluation cannot take it.
void refuse_values(const CaseInfo& info, const CaseOptions& options,
                   const std::vector<std::string>& names);

}  // namespace weft::validation
