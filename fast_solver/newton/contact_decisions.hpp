#pragma once

// Tested by tests/fast_solver/newton/contact_decisions_test.cpp.

#include <algorithm>

namespace weft::fast {

/// In which iterations of a step contact states are decided: in the first ones, which find most of them, and then close to
/// solutions, for on the way there forces say little.
class ContactDecisions {
 public:
  /// In all. After the last one states stay as they are.
  static constexpr int kMost = 8;

  /// presses: whether a body presses nodes onto something. How much each of them bears is decided together with its motion, in every
  /// iteration. continues: states are those of the step before, of which this one is a part.
  ContactDecisions(bool has_contacts, bool presses, bool continues)
      : has_contacts_(has_contacts),
        num_first_(presses ? kMost : (continues ? 0 : kFirst)),
        are_right_(!has_contacts) {}

  /// Whether the coming iteration decides.
  [[nodiscard]] bool decides() const { return decides_; }
  [[nodiscard]] bool can_decide() const { return has_contacts_ && num_ < kMost; }
  /// Whether the last decision has confirmed the states, or no other follows.
  [[nodiscard]] bool are_settled() const { return are_right_ || !can_decide(); }
  /// Whether the present iteration has confirmed them, or no other can. are_new: its states differ from those before.
  [[nodiscard]] bool are_confirmed(bool are_new) const {
    return !can_decide() || (decides_ && !are_new);
  }

  /// An iteration has taken place. have_changed: its decision has changed states, or it has met planes.
  void add(bool is_first, bool have_changed) {
    if (decides_) ++num_;
    if (has_contacts_ && (decides_ || have_changed)) are_right_ = !is_first && !have_changed;
  }
  /// Whether the next one decides. gain: of this one [J]; is_over: it is a solution, or iterations get nowhere; has_met_planes:
  /// nodes have been put onto planes, which compresses stiff springs far beyond what the planes will bear: friction of such forces
  /// would take the momentum of the whole.
  void plan(int iteration, double gain, bool is_over, bool has_met_planes) {
    const bool is_close = !decides_ && gain <= kClose * largest_gain_;
    largest_gain_ = decides_ ? gain : std::max(largest_gain_, gain);
    decides_ = can_decide() && !has_met_planes && (iteration < num_first_ || is_over || is_close);
  }
  void decide_next(bool decides) { decides_ = decides; }

 private:
  static constexpr int kFirst = 2;
  /// Close to a solution an iteration gains this share of the most that one has gained since the last decision [-].
  static constexpr double kClose = 0.01;

  bool has_contacts_;
  int num_first_;
  bool are_right_;
  bool decides_ = true;
  int num_ = 0;
  double largest_gain_ = 0;  ///< from the last decision on [J]
};

}  // namespace weft::fast
