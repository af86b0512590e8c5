#pragma once

#include <optional>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/bridge/fast_settings.hpp>
#include <weft/bridge/solver.hpp>
#include <weft/custom_forces/law_info.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// How a body that Bullet's own calls have made is taken over.
struct AdoptionSettings {
  /// The program's step [s], > 0. Bullet's kLST is the share of a link's stretch that one of m_cfg.piterations visits takes
  /// back in a step: it has a stiffness in N/m for a given step only (link_stiffness.hpp).
  double time_step = 1.0 / 60;
  /// The stiffness of all links but bending ones [N/m], in place of what kLST says.
  std::optional<double> stiffness = std::nullopt;
  /// Beside the tension of the links: bending (hinge_torsion), damping, wind. Gravity stays the world's.
  std::vector<forces::LawSpecification> laws = {};
  FastSettings fast = {};
};

/// The fate of one of a body's properties.
struct AdoptedProperty {
  enum class Fate {
    kKept,          ///< acts as before
    kMapped,        ///< Weft's equivalent acts in its place
    kLeftToBullet,  ///< Bullet's own force or constraint goes on, explicitly
    kIgnored        ///< has no effect any more
  };
  std::string what;
  Fate fate = Fate::kKept;
  std::string how;
};

/// "kept", "mapped", "left to Bullet", "ignored".
[[nodiscard]] std::string_view name_of(AdoptedProperty::Fate fate);

struct AdoptionReport {
  /// Why the body was left as it was, Bullet's own; nothing if Weft steps it now.
  std::optional<std::string> refusal;
  std::vector<AdoptedProperty> properties;
  /// The body's handle; of no body after a refusal.
  Cloth cloth = {};
  /// A line for each property.
  [[nodiscard]] std::string text() const;
};

/// Largest stiffness of an adopted link, and that of kLST = 1, which has none of its own: k h^2 / m of the mean node [-]. A sheet of a
/// thousand nodes that hangs by two corners stretches by a percent there; springs that are stiffer make paper of cloth.
inline constexpr double kStiffestLink = 1e3;
/// The same of links of generateBendingConstraints(), which Bullet's few visits hardly ever hold: a sheet falls over an edge, in
/// folds. Real bending is a law of its own (hinge_torsion).
inline constexpr double kStiffestBendingLink = 1;

/// Gives a body of Bullet's own making (btSoftBodyHelpers, appendNode, appendLink, appendFace) implicit springs in the place of its links
/// (SoftBodySolver::attach_fast): from then on it moves alike for any number of iterations, and stays a btSoftBody in every
/// respect. Rest lengths are the links' (m_rl), wherever the nodes are; after setMass() and
/// the like (m_bUpdateRtCst) Bullet measures links anew in the next step, and so does this. Every kLST from 0 to 1 is
/// good; a body that has clusters, a pose to match, a timescale or no link is refused and stays as it was.
/// Throws InvalidArgument for settings out of their domain and as SoftBodySolver::attach().
[[nodiscard]] AdoptionReport adopt(SoftBodySolver& solver, btSoftBody& body,
                                   const AdoptionSettings& settings = {});

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
