#pragma once

// Tested by tests/reference/self_contact_test.cpp.

#include <optional>
#include <string>
#include <vector>

#include <weft/mesh/distance/continuous_distance.hpp>
#include <weft/reference/contact/contact_points.hpp>
#include <weft/reference/contact/search_budget.hpp>
#include <weft/reference/contact/touches.hpp>

namespace weft::reference {

/// Contacts of cloth with itself and with other cloth over one step: a node and a triangle, or two
/// edges. Layers keep their thickness, or half the distance that the pair has at rest if that is
/// less. Two things make a contact: places that would end the step nearer than that, and a path on
/// which a pair comes nearer than kNearestPart of what it had. The second one is continuous, so that
/// nothing passes through anything in a step.
class SelfContacts {
 public:
  explicit SelfContacts(const System& system);
  [[nodiscard]] bool is_needed() const { return !triangles_.empty(); }

  /// Adds contacts that the velocities of the problem ask for. True if there was one.
  bool update(const System& system, const SystemStep& step, bool friction, ContactPoints& points,
              ContactProblem& problem);

  /// The contacts that pushed, for the velocity part of the step.
  void collect(const ContactProblem& problem, std::vector<PairTouch>& touches) const;

  /// Last resort, on the mean velocities of the step: nodes of a pair that would still come together
  /// stay where they are for this step. Returns their number: 0 where the impulses converged. Nodes
  /// without a free motion cannot be stopped.
  [[nodiscard]] int stop_crossings(const System& system, SystemStep& step);

  /// Counts the visits of sweeps over contacts among nodes that it may have added.
  void count_visits(std::int64_t visits);
  /// Distances so far over their budget [-].
  [[nodiscard]] double search_share() const {
    return static_cast<double>(num_distances_) / static_cast<double>(budget_.distances);
  }
  /// Which budget of the step is used up, and the first body that takes part: a blow-up. From then on
  /// nothing is searched.
  [[nodiscard]] const std::optional<Exhausted>& exhausted() const { return exhausted_; }

 private:
  struct Node {
    std::size_t body;
    int node;
  };
  struct Candidate {
    PairKind kind;
    std::array<int, 4> nodes;  // of nodes_
  };
  struct Entry {
    std::size_t contact;  // index in the problem
    PairTouch touch;
  };

  [[nodiscard]] std::vector<Candidate> candidates(const Matrix3X<double>& start,
                                                  const Matrix3X<double>& end);
  void spend(const char* what, std::int64_t count, const char* unit, std::int64_t budget);
  [[nodiscard]] bool may_meet(int first, int second) const;
  [[nodiscard]] double gap(const System& system, const Candidate& candidate) const;
  [[nodiscard]] Matrix3X<double> positions(const System& system) const;

  std::vector<Node> nodes_;                    // of bodies that take part
  std::vector<std::array<int, 3>> triangles_;  // of nodes_
  std::vector<std::array<int, 2>> edges_;
  std::vector<bool> meets_itself_, meets_others_;  // per body
  double largest_thickness_ = 0.0;                 // [m]
  std::vector<Entry> entries_;
  SearchBudget budget_;
  std::int64_t num_distances_ = 0, num_visits_ = 0;  // of the step so far
  std::optional<Exhausted> exhausted_;
};

/// Part of the distance at the start of a step, or of the thickness if that is less, below which a
/// path must not come [-].
inline constexpr double kNearestPart = 0.2;
/// The share of the gap that may be missing at the end of a step [-].
inline constexpr double kGapTolerance = 0.05;
/// The same as kNearestPart for what is stopped in the end.
inline constexpr double kStopPart = 0.02;

}  // namespace weft::reference
