#pragma once

#include <memory>
#include <string>
#include <vector>

#include <weft/bridge/fast_settings.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/custom_forces/law_info.hpp>
#include <weft/mesh/cloth_mesh.hpp>

namespace weft::bench {

/// Undamped springs in a world, which every solver can be given.
struct Workload {
  enum class Kind {
    kHang,     ///< a sheet of 1 m and 1 kg held at two corners
    kClassic,  ///< one of 7 m that falls on a fixed ball of 2 m
    kCrowd,    ///< a hundred of 1 m and 250 g that fall on the ground
    kBall,     ///< a pressurised ball of 1 m and 1 kg that falls on the ground
  };
  std::string name;
  Kind kind;
  int nodes;         ///< along an edge of a sheet; ball: frequency of its icosphere
  double time_step;  ///< [s]
  int num_steps;
  int explicit_steps;  ///< of explicit integration per step, that are stable
  /// The same, for what the others are compared with. 0: nothing is, for in steps as short as that takes single precision loses
  /// the motion of nodes that are metres from the origin.
  int reference_steps;
};

[[nodiscard]] std::vector<ClothMesh> meshes_of(const Workload& workload);

/// A workload with a solver.
class WorkloadRun {
 public:
  /// Bullet's links, with the stiffness that so many iterations make of them.
  static std::unique_ptr<WorkloadRun> links(const Workload& workload, int iterations, bool reorders,
                                            int substeps = 1);
  /// The laws of the same springs, explicitly.
  static std::unique_ptr<WorkloadRun> laws(const Workload& workload, int substeps);
  static std::unique_ptr<WorkloadRun> fast(const Workload& workload,
                                           const bridge::FastSettings& settings, int substeps);

  WorkloadRun(const Workload& workload, int iterations, bool has_links, int substeps);

  /// Simulates this much time [s].
  void step(double time);
  /// Positions of all bodies, 3 x n [m].
  [[nodiscard]] const Matrix3X<double>& positions() const { return positions_; }
  /// Largest and mean change of length of the structural springs [1].
  [[nodiscard]] std::pair<double, double> stretch() const;

 private:
  void read();
  [[nodiscard]] std::vector<forces::LawSpecification> laws_of(bool has_tension) const;

  const Workload::Kind kind_;
  std::vector<ClothMesh> meshes_;
  int substeps_;
  bridge::SoftWorld world_;
  std::vector<btSoftBody*> bodies_;
  Matrix3X<double> positions_;
};

}  // namespace weft::bench
