#pragma once

#include <vector>

#include <weft/mesh/cloth_mesh.hpp>

namespace weft::validation {

/// Places of the nodes at the start and after each step, each 3 x n [m].
using Places = std::vector<Matrix3X<double>>;

/// What a sheet did, from places alone: velocities that a solver reports may be others.
class SwingTrack {
 public:
  /// Throws InvalidArgument for fewer than two states or for other numbers of nodes than the mesh has.
  SwingTrack(const ClothMesh& mesh, double time_step, Places places);

  /// Mean over the steps that end in ]begin, end] [s] of sum m |dx/dt|^2 / 2 [J]; NaN without any.
  [[nodiscard]] double kinetic_energy(double begin, double end) const;
  /// When the centre of mass first turns round on its way across, between steps by interpolation [s]; NaN if it does not.
  [[nodiscard]] double turning_time() const;
  struct Stretch {
    double largest;  ///< [-] of a structural spring
    double mean;     ///< [-] of absolute values
  };
  /// At the end.
  [[nodiscard]] Stretch stretch() const;
  [[nodiscard]] const Places& places() const { return places_; }

 private:
  ClothMesh mesh_;
  double time_step_;
  Places places_;
};

/// RMS distance over nodes and states after the start [m]; only those that both have. Throws InvalidArgument for other numbers of nodes.
[[nodiscard]] double rms_distance(const Places& a, const Places& b);

/// What a sheet that starts flat in the plane of x and z, held at its largest z, would do without being solved: stay, hang down flat and still, or swing
/// as a rigid plate.
[[nodiscard]] Places frozen(const ClothMesh& mesh, int num_steps);
[[nodiscard]] Places hanging_flat(const ClothMesh& mesh, int num_steps);
[[nodiscard]] Places rigid_plate(const ClothMesh& mesh, double time_step, int num_steps);

}  // namespace weft::validation
