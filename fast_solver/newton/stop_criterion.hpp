#pragma once

// Tested by tests/fast_solver/newton/stop_criterion_test.cpp.

#include <algorithm>
#include <array>
#include <cstddef>

#include <weft/fast_solver/newton/linear_gains.hpp>

namespace weft::fast {

/// When Newton's method ends. What its iterations have gained tells what further ones would: each gains about the same share of
/// the one before. All energies are twice those of the quadratic model, as in LinearGain.
class StopCriterion {
 public:
  /// rounding: what positions gain by their rounding alone [J].
  void set_rounding(double rounding) { rounding_ = rounding; }
  [[nodiscard]] double rounding() const { return rounding_; }
  /// An iteration that gains no more may only have gained rounding [J].
  [[nodiscard]] double most_of_rounding() const { return kRoundings * rounding_; }

  /// An iteration that counts. lowered: by which the energy is lower after it, 0 where contact states may have changed it [J].
  void add(const LinearGain& gain, double lowered, bool are_contact_states_new) {
    gain_ = gain;
    shrinks_ = before_ > 0 ? gain.total / before_ : kFirstShrink;
    before_ = gain.total;
    last_shrinks_[next_++ % last_shrinks_.size()] = shrinks_;
    const bool is_slow = !(shrinks_ < kStalled) && !(lowered > kLowered * gain.total);
    num_stalled_ = is_slow && !are_contact_states_new ? num_stalled_ + 1 : 0;
  }
  /// Contact states are decided in the next iteration.
  void forget_stalls() { num_stalled_ = 0; }

  /// Whether no more than this is left to gain [J], or than rounding gains.
  [[nodiscard]] bool is_solved(double wanted) const { return is_within(wanted) || is_rounding(); }
  /// Whether no more than this is left to gain [J].
  [[nodiscard]] bool is_within(double asked) const {
    return !gain_.is_broken &&
           gain_.left + std::max(rest_of(gain_.total, shrinks_), ahead()) <= asked;
  }
  /// Iterations do not get anywhere any more.
  [[nodiscard]] bool is_stalled() const { return num_stalled_ >= kMostStalled; }
  /// What is left to gain by the slowest of the last iterations [J], once and not twice. Accelerated iterations gain little now and
  /// then, with some way to go: that is known here, but too late to stop by. What conjugate gradients have left is at least what
  /// their last iterations gained (Strakos and Tichy 2002): it counts twice.
  [[nodiscard]] double energy_left() const {
    const double slowest = *std::max_element(last_shrinks_.begin(), last_shrinks_.end());
    return gain_.left + std::max(rest_of(gain_.total, slowest), ahead()) / 2;
  }

 private:
  /// There is no more to be gained than so many times what positions gain by their rounding alone [-].
  static constexpr double kRoundings = 4;
  /// The ratio of an iteration's gain to that of the one before: assumed for the first, and the upper bound.
  static constexpr double kFirstShrink = 0.1;
  static constexpr double kSlowest = 0.9;
  /// Iterations whose shrinking tells how much the last one may have left.
  static constexpr std::size_t kShrinksSeen = 4;
  /// If the ratio exceeds this so many times in a row, iterations only gain rounding.
  static constexpr double kStalled = 0.9;
  static constexpr int kMostStalled = 3;
  /// Without contacts, whose states change energies, an iteration that lowers the energy by this share of its gain gets somewhere,
  /// however slowly, as in a sheet that is pulled in on itself. Rounding has gains too, and lowers nothing.
  static constexpr double kLowered = 0.125;

  /// What further iterations gain if each gains this share of the one before [J].
  [[nodiscard]] static double rest_of(double gain, double shrinks) {
    const double limited = std::min(kSlowest, shrinks);
    return gain * limited / (1 - limited);
  }
  /// The energy that a step over the rest of the way along the last one would gain [J]. Compressed springs are softer than the
  /// linear system, so that each iteration covers only the same fraction of the way that is left, in the same direction.
  [[nodiscard]] double ahead() const {
    const double left = std::clamp(gain_.slope_left, 0.0, kSlowest);
    return gain_.total * left * left / ((1 - left) * (1 - left));
  }
  /// Stiff springs keep gaining by rounding while soft ones may still be far from their solution.
  [[nodiscard]] bool is_rounding() const {
    return !gain_.is_broken && gain_.total <= most_of_rounding() && !(shrinks_ < kStalled);
  }

  double rounding_ = 0;
  LinearGain gain_;
  double before_ = 0;
  double shrinks_ = kFirstShrink;
  std::array<double, kShrinksSeen> last_shrinks_{};
  std::size_t next_ = 0;
  int num_stalled_ = 0;
};

}  // namespace weft::fast
