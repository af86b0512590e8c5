#pragma once

#include <optional>
#include <vector>

#include <weft/mesh/cloth_mesh.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/validation/cases/scenes/scene_history.hpp>
#include <weft/validation/metrics/energy.hpp>

namespace weft::validation {

/// Which number of a run a check looks at.
enum class Quantity {
  kLargestDistance,  ///< largest distance of a node to the same node of the reference [m]
  kRmsDistance,      ///< area-weighted RMS of it over the size of the cloth [-]
  kRigidDistance,    ///< largest distance of a rigid body's centre to the reference's [m]
  kDepth,            ///< deepest node below a collider's surface [m]; needs no reference
  kMeanHeight,  ///< mean height of the nodes, apart from the reference's, over the cloth's size [-]
  kMeanRadius,  ///< the same of their RMS distance from the vertical through their middle
};

/// Meshes, weights and sizes of a scene, made once.
class SceneMetrics {
 public:
  explicit SceneMetrics(const scenes::Scene& scene);

  [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
  [[nodiscard]] const std::vector<ClothMesh>& meshes() const { return meshes_; }
  [[nodiscard]] double cloth_size() const {
    return cloth_size_;
  }  ///< longest side of the largest cloth [m]
  [[nodiscard]] const SceneEnergy& energy() const { return energy_; }

  /// A quantity of one frame. NaN if a position is not finite.
  [[nodiscard]] double at(Quantity quantity, const scenes::SceneState& state,
                          const scenes::SceneState& reference) const;

  /// kMeanHeight or kMeanRadius of all nodes in one frame, over the cloth's size [-].
  [[nodiscard]] double shape_number(Quantity quantity, const scenes::SceneState& state) const;
  /// The same, mean over the frames from begin to end [s]. NaN if the run ends before.
  [[nodiscard]] double mean_shape_number(Quantity quantity, const Frames& frames, double begin,
                                         double end) const;

  /// Largest value over the frames from begin to end [s]. Infinity if either run ends before: an
  /// exploded run is infinitely far away.
  [[nodiscard]] double largest(Quantity quantity, const Frames& frames, const Frames& reference,
                               double begin, double end) const;

  /// 95th percentile and maximum of the two-sided surface distance of one frame, over the cloth
  /// size [-].
  struct SurfaceGap {
    double percentile_95;
    double largest;
  };
  [[nodiscard]] SurfaceGap surface_gap(const scenes::SceneState& state,
                                       const scenes::SceneState& reference) const;

  /// RMS distance after the best rigid motion, over the cloth size [-].
  [[nodiscard]] double aligned_rms(const scenes::SceneState& state,
                                   const scenes::SceneState& reference) const;

  /// Strains of the "stretch" springs of all cloths [-].
  [[nodiscard]] VectorX<double> stretch_strains(const scenes::SceneState& state) const;

 private:
  scenes::Scene scene_;
  std::vector<ClothMesh> meshes_;
  std::vector<VectorX<double>> weights_;
  double cloth_size_ = 0.0;
  SceneEnergy energy_;
};

[[nodiscard]] const char* unit_of(Quantity quantity);
/// A number of one frame alone, of which differences are taken.
[[nodiscard]] bool is_shape_number(Quantity quantity);

}  // namespace weft::validation
