#pragma once

// Tested by tests/reference/contact_test.cpp.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <weft/reference/integrators/integrator.hpp>
#include <weft/reference/rigid/rigid_motion.hpp>

namespace weft::reference {

/// One step of a whole system after integration and before positions are written. System still
/// holds the start.
struct SystemStep {
  double time_step = 0.0;        ///< h [s]
  bool mean_is_end = false;      ///< mean and end velocities are the same (modified Euler)
  std::vector<BodyStep> bodies;  ///< as System::bodies
  std::vector<VectorX<double>> inverse_masses;  ///< as System::bodies, 0 for pinned nodes [1/kg]
  std::vector<RigidMotion> rigids;              ///< as System::colliders
};

/// A budget of work that a step has used up (contact/search_budget.hpp).
struct Exhausted {
  std::size_t body = 0;  ///< index in System::bodies
  std::string reason;    ///< "the contact search found 31 candidate pairs, more than ..."
};

struct ContactOutcome {
  int num_contacts = 0;     ///< pairs of node and collider that exchanged an impulse
  int sweeps = 0;           ///< Gauss-Seidel sweeps in all
  std::int64_t visits = 0;  ///< of contacts with colliders alone, by sweeps
  int passes = 0;           ///< how often the surface was linearised anew
  double search_share =
      0.0;                ///< distances of pairs of cloth over the budget of a single substep [-]
  bool converged = true;  ///< sweeps and passes both ended before their limits
  /// Nodes that stood still for a step because contact between layers did not converge: 0 in a
  /// result that shall count.
  int num_stopped_nodes = 0;
  double normal_impulse = 0.0;  ///< sum over the contacts of the step [N s]
  /// The search for contacts ended before it was done: the step means nothing.
  std::optional<Exhausted> exhausted = std::nullopt;
};

/// Two contact outcomes, one after the other, as one; the larger number of contacts counts.
[[nodiscard]] ContactOutcome combined(const ContactOutcome& first, const ContactOutcome& second);

/// A contact model changes mean velocities (and so positions) and end velocities of a step.
/// It acts both ways: a collider with a mass receives the opposite of what the nodes receive.
class ContactModel {
 public:
  virtual ~ContactModel() = default;
  [[nodiscard]] virtual ContactOutcome resolve(const System& system, SystemStep& step) const = 0;
};

/// De Joya's contact (2011): a node that ends the step inside (distance < margin) is moved out along
/// the normal to distance = margin and loses its inward normal velocity. No friction. With a
/// collider that has a mass the displacement is shared by effective mass; that shift carries no
/// momentum, so linear momentum is conserved to round-off and angular momentum only as far as the
/// shift is small.
[[nodiscard]] std::unique_ptr<ContactModel> make_projection_contact();

/// Velocity-level contact with exact Coulomb friction and restitution 0: impulses make the node
/// land on distance = margin instead of passing it. Linear and angular momentum are conserved to
/// round-off: impulses of the position part act at x1 - h v1 (for modified Euler the start
/// position), which is the point that makes x1 x (m v1) change by exactly point x impulse. Where
/// mean and end velocity differ, a second, pure velocity part ends the approach at touching
/// contacts.
[[nodiscard]] std::unique_ptr<ContactModel> make_impulse_contact();

[[nodiscard]] std::unique_ptr<ContactModel> make_contact_model(ContactKind kind);

}  // namespace weft::reference
