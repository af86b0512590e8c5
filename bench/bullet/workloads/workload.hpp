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
    kCrumple,  ///< the same, each tilted by a right angle less 20 degrees: they crumple
    kBall,     ///< a pressurised ball of 1 m and 1 kg that falls on the ground
  };
  std::string name;
  Kind kind;
  int nodes;         ///< along an edge of a sheet; ball: frequency of its icosphere
  double stiffness;  ///< of every spring [N/m]
  double time_step;  ///< [s]
  int num_steps;
  int explicit_steps;  ///< of explicit integration per step, that are stable
  /// The same, for what the others are compared with. 0: nothing is, for in steps as short as that takes single precision loses
  /// the motion of nodes that are metres from the origin.
  int reference_steps;
};

[[nodiscard]] std::vector<ClothMesh> meshes_of(const Workload& workload);

/// Every spring of a mesh.
[[nodiscard]] Edges springs_of(const ClothMesh& mesh);

/// The distance from surfaces at which nodes come to rest [m], in every solver.
inline constexpr double kWorkloadMargin = 0.01;
/// Everything rubs on everything by this coefficient [-].
inline constexpr double kWorkloadFriction = 0.3;
/// The pressure in the ball [Pa].
inline constexpr double kWorkloadPressure = 100.0;

/// A workload with some solver.
class WorkloadRun {
 public:
  explicit WorkloadRun(const Workload& workload);
  virtual ~WorkloadRun() = default;
  WorkloadRun(const WorkloadRun&) = delete;
  WorkloadRun& operator=(const WorkloadRun&) = delete;

  /// Simulates this much time [s].
  virtual void step(double time) = 0;
  /// Positions of all bodies, 3 x n [m].
  [[nodiscard]] const Matrix3X<double>& positions() const { return positions_; }
  /// Largest and mean change of length of the structural springs [1].
  [[nodiscard]] std::pair<double, double> stretch() const;

 protected:
  [[nodiscard]] const Workload& workload() const { return workload_; }
  [[nodiscard]] const std::vector<ClothMesh>& meshes() const { return meshes_; }
  /// Places of one body's nodes, from this column on.
  auto places_of(Eigen::Index first, Eigen::Index count) {
    return positions_.middleCols(first, count);
  }

 private:
  const Workload workload_;
  const std::vector<ClothMesh> meshes_;
  Matrix3X<double> positions_;
};

/// A workload in Bullet's world, with its links or with Weft.
class BulletRun final : public WorkloadRun {
 public:
  /// Bullet's links, with the stiffness that so many iterations make of them.
  static std::unique_ptr<BulletRun> links(const Workload& workload, int iterations, bool reorders,
                                          int substeps = 1);
  /// The laws of the same springs, explicitly.
  static std::unique_ptr<BulletRun> laws(const Workload& workload, int substeps);
  static std::unique_ptr<BulletRun> fast(const Workload& workload,
                                         const bridge::FastSettings& settings, int substeps);

  BulletRun(const Workload& workload, int iterations, bool has_links, int substeps);
  void step(double time) override;

 private:
  void read();
  [[nodiscard]] std::vector<forces::LawSpecification> laws_of(bool has_tension) const;

  int substeps_;
  bridge::SoftWorld world_;
  std::vector<btSoftBody*> bodies_;
};

}  // namespace weft::bench
