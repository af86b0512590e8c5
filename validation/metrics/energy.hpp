#pragma once

#include <memory>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/custom_forces/force_law.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::validation {

/// Energy and momentum of everything that moves: cloths and dynamic rigid bodies. Pinned nodes
/// count with their mass, fixed colliders do not. All NaN if a position, orientation or velocity is
/// not finite.
struct Energy {
  double kinetic_cloths = 0.0;  ///< sum m v^2 / 2 [J]
  double kinetic_rigids = 0.0;  ///< m v^2 / 2 + omega . I omega / 2 [J]
  double gravitational = 0.0;   ///< of the gravity laws on cloths, and -m g . x of rigid bodies [J]
  double elastic = 0.0;         ///< stored by all other laws [J]
  double non_conservative_power = 0.0;  ///< of all laws [W]; negative: dampers take energy out
  Vector3<double> momentum{0, 0, 0};    ///< [kg m/s]
  Vector3<double> angular_momentum{0, 0, 0};  ///< about the world's origin [kg m^2/s]
  Vector3<double> center_of_mass{0, 0, 0};    ///< [m]; NaN if nothing has mass
  bool finite = true;

  [[nodiscard]] double kinetic() const { return kinetic_cloths + kinetic_rigids; }    ///< [J]
  [[nodiscard]] double total() const { return kinetic() + gravitational + elastic; }  ///< [J]
};

/// Evaluates the energy of a scene's states. Meshes, laws and inertias are made once.
class SceneEnergy {
 public:
  /// Throws InvalidArgument for laws that the registry refuses and for a dynamic plane.
  explicit SceneEnergy(const scenes::Scene& scene);

  /// Throws InvalidArgument for a state with other numbers of bodies or nodes than the scene.
  [[nodiscard]] Energy evaluate(const scenes::SceneState& state) const;

  /// Mass of everything that moves [kg].
  [[nodiscard]] double mass() const { return mass_; }

 private:
  struct ClothPart {
    VectorX<double> masses;  ///< n [kg]
    std::vector<std::unique_ptr<forces::ForceLaw<double>>> laws;
  };
  struct RigidPart {
    std::size_t index;             ///< in SceneState::rigids
    double mass;                   ///< [kg]
    Vector3<double> body_inertia;  ///< principal moments in the body's axes [kg m^2]
  };

  void check(const scenes::SceneState& state) const;
  static void add_cloth(const ClothPart& part, const scenes::ClothState& state, double time,
                        Energy& energy);
  void add_rigid(const RigidPart& part, const scenes::RigidState& state, Energy& energy) const;

  Vector3<double> gravity_;  ///< [m/s^2]
  double mass_ = 0.0;        ///< [kg]
  std::vector<ClothPart> cloths_;
  std::vector<RigidPart> rigids_;
  std::size_t num_colliders_ = 0;
};

}  // namespace weft::validation
