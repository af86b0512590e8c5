#pragma once

#include <optional>
#include <string>
#include <vector>

#include <weft/core/types.hpp>
#include <weft/scenes/output/file_kind.hpp>
#include <weft/scenes/scene.hpp>

namespace weft::validation {

/// What a converged reference is made with.
struct ConvergenceOptions {
  double time = 0.5;   ///< [s] at which states are compared, > 0; a whole number of time steps
  int num_levels = 4;  ///< h, h/2, h/4 ...; >= 3
  /// Starts at a step this many times shorter than the scene's own, so that the leading error rules.
  int first_division = 1;
  /// Largest distance from a reference that a comparison may allow, as a part of the cloth's size:
  /// the gate that the reference shall serve [-].
  double gate = 0.01;
};

/// The run of one integrator at one step.
struct ConvergenceLevel {
  double time_step = 0.0;  ///< [s]
  int num_steps = 0;
  std::string hash;  ///< of the positions at the end, every bit
  /// To the level before this one, area-weighted rms over all cloths, as a part of the size [-].
  std::optional<double> difference;
  std::optional<std::string> blow_up;  ///< set: the run left the range of numbers, and says how
};

/// All levels of one integrator.
struct ConvergenceStudy {
  scenes::Integrator integrator;
  int formal_order = 0;  ///< of smooth motion; with contact 1 is all that can be expected
  std::vector<ConvergenceLevel> levels;
  std::optional<double> order;  ///< observed, of the last three levels [-]
  /// Grid convergence index of the finest level, 1.25 difference / (2^p - 1), as a part of the size
  /// [-]. p is the observed order, or the formal one if that is less. None without a positive order.
  std::optional<double> gci;
  std::vector<Matrix3X<double>> positions;  ///< of each cloth at the finest level [m]
};

/// A reference with its own numerical error.
struct ConvergedReference {
  std::string scene;
  std::string program;     ///< version and revision of what made it; set by the caller
  std::string scene_hash;  ///< of the resolved scene
  std::string mesh_hash;   ///< of masses, triangles and edges of all cloths
  double time = 0.0;       ///< [s]
  double size = 0.0;       ///< [m] largest extent of the cloths at rest
  double gate = 0.0;       ///< [-]
  std::vector<ConvergenceStudy> studies;  ///< velocity Verlet, TR-BDF2
  /// The agreement of the finest levels of both integrators, RMS as a share of the size [-].
  std::optional<double> agreement;

  /// Every GCI below a tenth of the gate, and the integrators agree within a third of it.
  [[nodiscard]] bool is_converged() const;
};

/// Runs a scene with the reference solver, with two independent integrators at several time steps.
/// Roache's method (ASME V&V 20), on the norm of the difference of successive levels. Deterministic.
/// Throws InvalidArgument for options out of their domain and for a scene that the reference cannot
/// run; a blow-up is in its level.
[[nodiscard]] ConvergedReference converge(const scenes::Scene& scene,
                                          const ConvergenceOptions& options = {});

/// A file with what to_json() returns.
extern const output::FileKind kReferenceKind;

/// The reference as JSON: all numbers, hashes, and the positions of the finest Verlet level to 12
/// digits for every node, or for as many evenly chosen ones as max_nodes says.
[[nodiscard]] std::string to_json(const ConvergedReference& reference, int max_nodes = 200);

}  // namespace weft::validation
