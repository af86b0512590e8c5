#pragma once

#include <memory>
#include <vector>

#include <weft/custom_forces/force_law.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::validation {

/// Forces that nothing balances, on nodes that nothing holds, each over its node's weight m g. At rest they are zero whatever the solver: they come
/// from the definitions of the laws and from places alone.
struct UnbalancedForces {
  double largest = 0.0;  ///< [-]; NaN if a place or force is not finite
  double mean = 0.0;     ///< [-] over the free nodes; 0 without any
  int num_nodes = 0;     ///< that are free
  /// The same of what rounding the places to a precision does to the forces: no state can be nearer to balance than this.
  double rounding_largest = 0.0;
  double rounding_mean = 0.0;
};

/// Evaluates them for the states of a scene. A node is free if it is neither pinned nor led, and farther from every collider than twice its cloth's
/// collision margin.
class RestForces {
 public:
  /// epsilon: relative spacing of the numbers in which places are stored [-], > 0. Throws InvalidArgument for laws that the registry
  /// refuses, for self_collision and soft_collision, whose forces are no law's, and without gravity.
  RestForces(const scenes::Scene& scene, double epsilon);

  /// Nodes count as if they stood still. Throws InvalidArgument for a state that does not fit the scene.
  [[nodiscard]] UnbalancedForces evaluate(const scenes::SceneState& state) const;

  /// Forces of all laws on the nodes of a cloth that stands still, 3 x n [N].
  [[nodiscard]] Matrix3X<double> forces(std::size_t cloth, const Matrix3X<double>& positions,
                                        double time) const;

 private:
  struct ClothPart {
    ClothMesh mesh;
    std::vector<std::unique_ptr<forces::ForceLaw<double>>> laws;
  };
  [[nodiscard]] bool is_free(std::size_t cloth, int node, const scenes::SceneState& state) const;

  scenes::Scene scene_;
  std::vector<ClothPart> cloths_;
  double epsilon_;
  double gravity_ = 0.0;  ///< [m/s^2]
};

}  // namespace weft::validation
