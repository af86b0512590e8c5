#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <weft/scenes/output/file_kind.hpp>
#include <weft/scenes/scene.hpp>
#include <weft/scenes/simulator.hpp>

namespace weft::validation {

/// How deep an engine lets a thrown cloth into every kind of collider, and how many of its nodes
/// pass: a table over shapes, time steps and speeds.

/// One kind of collider in the table.
struct ContactTarget {
  std::string name;           ///< "sphere", "mesh, Bullet's triangles", "sphere, kinematic"
  scenes::Collider collider;  ///< its highest point is at y = 0
  double radius = 0.0;        ///< [m] scale of the solid for tunnelling, see Passage
  scenes::ConcaveContact concave = scenes::ConcaveContact::kPrisms;
  /// Who moves: the cloth falls on the collider, or the collider, kinematic or dynamic, on the cloth.
  enum class Mover { kCloth, kKinematic, kDynamic } mover = Mover::kCloth;
};

[[nodiscard]] std::vector<ContactTarget> contact_targets();

struct ContactRow {
  std::string target;
  double time_step = 0.0;  ///< [s]
  double speed = 0.0;      ///< [m/s] of approach
  int num_nodes = 0;
  double deepest = 0.0;      ///< [m] of any node centre at the end of any step
  double deepest_end = 0.0;  ///< [m] at the end of the run
  int num_tunnelled = 0;     ///< see Passage
  bool blew_up = false;      ///< then the numbers are those of the steps before
};

/// What a run can be spoiled with, to see that the table notices.
struct ContactSabotage {
  bool no_margin = false;   ///< collision_margin = 0
  bool no_contact = false;  ///< the collider is out of reach
};

/// The scene of one row: a square cloth of 1 m, 21 x 21 nodes, that meets the target after 5 cm.
[[nodiscard]] scenes::Scene contact_scene(const ContactTarget& target, double time_step,
                                          double speed, const ContactSabotage& sabotage = {});

[[nodiscard]] ContactRow measure_contact(scenes::Simulator& engine, const ContactTarget& target,
                                         double time_step, double speed,
                                         const ContactSabotage& sabotage = {});

inline const std::vector<double> kTableTimeSteps = {1.0 / 60.0, 1.0 / 240.0};  ///< [s]
inline const std::vector<double> kTableSpeeds = {1.0, 5.0, 20.0};              ///< [m/s]

/// Files with what the next two functions return.
extern const output::FileKind kContactCsvKind;
extern const output::FileKind kContactMarkdownKind;

/// A header line and one line per row; lengths in mm, with units in the header.
[[nodiscard]] std::string contact_csv(const std::vector<ContactRow>& rows);
[[nodiscard]] std::string contact_markdown(const std::vector<ContactRow>& rows,
                                           const std::string& engine);

}  // namespace weft::validation
