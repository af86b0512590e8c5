#pragma once

// Tested by tests/viewer/model/measures_test.cpp.

#include <memory>
#include <optional>
#include <vector>

#include <weft/custom_forces/law_set.hpp>
#include <weft/scenes/simulator.hpp>
#include <weft/viewer/model/picking.hpp>

namespace weft::viewer {

/// The node of the largest strain.
struct WorstNode {
  NodeId id;
  double strain = 0.0;  ///< [-], signed
};

/// The figures of a state that the plots show, over all cloths that are simulated.
struct Measures {
  double kinetic_energy = 0.0;    ///< [J]
  double potential_energy = 0.0;  ///< [J] of all laws that have one, gravity too
  double largest_strain = 0.0;    ///< [-], its size
  std::optional<WorstNode> worst;
};

/// Measures states of one scene. Energies are NaN once a cloth has torn: how the mass of a torn node
/// is shared out is not known here.
class Meter {
 public:
  explicit Meter(const scenes::Scene& scene);
  ~Meter();
  Meter(Meter&&) noexcept;
  Meter& operator=(Meter&&) noexcept;

  [[nodiscard]] Measures measure(const scenes::SceneState& state);
  /// Strain of each node of each cloth [-], for the colors.
  [[nodiscard]] std::vector<Eigen::VectorXd> strains(const scenes::SceneState& state) const;

  [[nodiscard]] const std::vector<ClothMesh>& meshes() const { return meshes_; }

 private:
  std::vector<ClothMesh> meshes_;
  std::vector<bool> is_simulated_;
  std::vector<forces::LawSet<double>> laws_;
};

}  // namespace weft::viewer
