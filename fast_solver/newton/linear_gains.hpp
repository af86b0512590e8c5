#pragma once

// Tested by tests/fast_solver/newton/linear_gains_test.cpp.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace weft::fast {

/// The energies that a linear solve gains, each twice the decrease of the quadratic model [J]: that of all iterations, and that
/// of the last few. The latter estimates what is left to gain (Strakos and Tichy 2002).
struct LinearGain {
  double total = 0;
  double left = 0;
  double slope_left =
      0;  ///< that of the energy along the step at its end, over that at its start [-]
  bool is_broken = false;  ///< by rounding, before anything was found out
};

/// How accurately a linear system is solved: conjugate gradients end when their last iterations gained at most the share
/// `forcing` of the gain of all. The last iterations are a few, or the share `delay` of all of them.
struct LinearAccuracy {
  double forcing = 0.1;   ///< [-]
  double delay = 0;       ///< [-]
  double least_gain = 0;  ///< less to gain than this [J] ends the solve too
};

/// For one iteration of Newton's method, which need not leave less than a share of the gain that is asked for [J].
[[nodiscard]] inline LinearAccuracy accuracy_of(int iteration, bool has_contacts, bool has_bodies,
                                                double asked) {
  /// A step that so many iterations have not solved has stiff springs that turn. There conjugate gradients have long plateaus,
  /// and what they leave on each of them is what the next iterations of Newton's method would gain slowly. With contacts the
  /// first iterations find their states. With bodies that cloth moves it is always these that take iterations.
  constexpr int kRoughIterations = 4;
  constexpr int kRoughInContact = 2;
  constexpr LinearAccuracy kRough = {.forcing = 0.1};
  constexpr LinearAccuracy kAccurate = {.forcing = 0.03, .delay = 0.5};
  constexpr double kLastShare = 0.02;
  const bool is_rough =
      has_bodies || iteration < (has_contacts ? kRoughInContact : kRoughIterations);
  LinearAccuracy accuracy = is_rough ? kRough : kAccurate;
  accuracy.least_gain = kLastShare * asked;
  return accuracy;
}

/// The history of what iterations of conjugate gradients gained, and whether they are enough.
class LinearGains {
 public:
  /// Room for those of so many iterations, or of fewer if that is very much.
  void reserve(int iterations) {
    gains_.reserve(std::min(static_cast<std::size_t>(iterations), kMostReserved));
  }
  void clear() { gains_.clear(), total_ = 0; }
  void add(double gain) { gains_.push_back(gain), total_ += gain; }

  [[nodiscard]] LinearGain sum(const LinearAccuracy& accuracy) const {
    const std::size_t share =
        static_cast<std::size_t>(accuracy.delay * static_cast<double>(gains_.size()));
    const std::size_t count = std::min(gains_.size(), std::max(kFewest, share));
    const double last =
        std::accumulate(gains_.end() - static_cast<std::ptrdiff_t>(count), gains_.end(), 0.0);
    // Nobody has looked for gains smaller than those that end the solve.
    return {.total = total_, .left = last > 0 ? std::max(last, accuracy.least_gain) : last};
  }
  [[nodiscard]] bool are_enough(const LinearAccuracy& accuracy) const {
    const double left = sum(accuracy).left;
    return gains_.back() <= kLastGain * total_ ||
           (gains_.size() > 1 && left <= accuracy.least_gain) ||
           (gains_.size() > kFewest && left <= accuracy.forcing * total_);
  }

 private:
  /// The last iterations are at least so many.
  static constexpr std::size_t kFewest = 4;
  /// An iteration that gains no more than this fraction of the gain so far is the last one, because with short steps inertia
  /// outweighs springs.
  static constexpr double kLastGain = 1e-4;
  static constexpr std::size_t kMostReserved = 1000;

  std::vector<double> gains_;
  double total_ = 0;
};

}  // namespace weft::fast
