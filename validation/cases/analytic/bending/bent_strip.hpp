#pragma once

// Tested by tests/validation/theory_test.cpp, tests/validation/cases/support/parameters_test.cpp.

#include <weft/mesh/cloth_mesh.hpp>
#include <weft/reference/statics/static_solver.hpp>

namespace weft::validation {

/// A strip of cloth along x, clamped left of x = 0, that hangs down under gravity along -y.
struct Strip {
  /// Direction of the grid's lines to the strip [deg]: 0, 90, or 45, where the strip is cut along
  /// the diagonals; any other is for an endless sheet (is_endless), in the nearest direction in which a grid
  /// repeats (lattice_strip.hpp).
  double angle = 0.0;
  int num_cells = 40;   ///< N: length over the spacing of the grid's nodes; even for 45 degrees,
                        ///< where the nearest whole number of diagonals is taken
  int width_cells = 2;  ///< across the strip, in cells or diagonals
  double length = 0.1;  ///< L [m]
  double jitter = 0.0;  ///< nodes off their place by at most this part of a cell, inner ones only
  double area_density = 0.2;  ///< [kg/m^2]
};

/// The strip's mesh: pinned nodes at x <= 0 (two rows and more), edge set "net" of all triangle edges
/// and, for 0 and 90 degrees, both diagonals.
[[nodiscard]] ClothMesh make_strip(const Strip& strip);

/// What a bent strip is measured by: mean over the nodes of its free end.
struct StripTip {
  double drop = 0.0;   ///< [m]
  double reach = 0.0;  ///< [m]
};
[[nodiscard]] StripTip strip_tip(const ClothMesh& mesh, ConstMatrix3XRef<double> positions);

/// Statics of a strip.
struct StripModel {
  Strip strip;
  double gamma = 1.0;         ///< rho g L^3 / D [-]
  double clamp_factor = 2.0;  ///< of hinge_torsion
  double strain = 1e-4;       ///< of springs under the strip's whole weight [-]
  /// All the weight hangs at the tip, and gamma means P L^2 / D.
  bool is_tip_load = false;
  double tilt = 0.0;         ///< of the clamp below the horizontal [rad]
  bool cut_one_way = false;  ///< deliberate mistake: the cells' other diagonals do not count
  /// The strip is a part of an endless sheet: what leaves on one side comes in on the other.
  bool is_endless = false;
};

struct BentStrip {
  bool converged = false;
  double drop_over_reach = 0.0;  ///< H / W [-]
  StripTip tip;                  ///< drop and reach along the vertical and the horizontal
  ClothMesh mesh;
  Matrix3X<double> positions;  ///< 3 x n [m]
};

/// The strip with its laws, at its rest shape: the clamp along x, gravity turned by the tilt.
[[nodiscard]] reference::Body make_strip_body(const StripModel& model);

/// Equilibrium of the strip under hinge_torsion, gravity and springs that stretch by about 1e-5.
/// start: positions to start from; if empty those of the rest shape, for a heavy strip in several steps of load.
[[nodiscard]] BentStrip bend_strip(const StripModel& model, const Matrix3X<double>& start = {});

}  // namespace weft::validation
