#pragma once

// Tested by tests/custom_forces/laws/elastic/torsion_test.cpp.

#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <weft/custom_forces/assembly/batched_assembly.hpp>
#include <weft/custom_forces/assembly/element_pairs.hpp>
#include <weft/custom_forces/assembly/spring_set.hpp>
#include <weft/custom_forces/force_law.hpp>
#include <weft/custom_forces/laws/elastic/line_turn.hpp>
#include <weft/custom_forces/laws/elastic/turning_angle.hpp>

namespace weft::forces {

/// The triples of Torsion that are straight at rest, E = kappa theta^2 / 2. They need no front, and so no branch: the vector
/// unit computes many of them at a time.
template <class Scalar>
class StraightLines {
 public:
  /// triples: 3 x m. stiffness: kappa, m [N m]. sides: lengths of both sides at rest, line by line, 2 m [m].
  StraightLines(Triples triples, int num_nodes, const std::vector<double>& stiffness,
                const std::vector<double>& sides)
      : lines_(std::move(triples), num_nodes),
        stiffness_(lines_.size()),
        squared_first_(lines_.size()),
        squared_second_(lines_.size()) {
    const auto squared_shortest = [](double side) -> Scalar {
      return Scalar(kMinLengthRatio * kMinLengthRatio * side * side);
    };
    for (Eigen::Index place = 0; place < lines_.size(); ++place) {
      const auto e = static_cast<std::size_t>(lines_.order()[static_cast<std::size_t>(place)]);
      stiffness_[place] = Scalar(stiffness[e]);
      squared_first_[place] = squared_shortest(sides[2 * e]);
      squared_second_[place] = squared_shortest(sides[2 * e + 1]);
    }
  }

  [[nodiscard]] Eigen::Index scratch_columns() const {
    return lines_.scratch_columns(2);  // positions and displacements
  }

  void add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                  Matrix3XRef<Scalar> forces) const {
    const auto force = [lines = numbers()](Eigen::Index place, const auto& x) {
      return lines.forces(place, x);
    };
    lines_.template add<Scalar>(force, scratch, forces, state.positions);
  }

  void add_stiffness_product(const State<Scalar>& state, ConstMatrix3XRef<Scalar> displacements,
                             Matrix3XRef<Scalar> scratch, Matrix3XRef<Scalar> product) const {
    const auto force = [lines = numbers()](Eigen::Index place, const auto& x) {
      return lines.forces(place, x);
    };
    lines_.template add_stiffness_product<Scalar>(force, state.positions, displacements, scratch,
                                                  product);
  }

  void add_rest_stiffness(const State<Scalar>& rest,
                          std::vector<PairStiffness<Scalar>>& pairs) const {
    for (Eigen::Index place = 0; place < lines_.size(); ++place) {
      const Eigen::Index e = lines_.order()[static_cast<std::size_t>(place)];
      const LineTurn<Scalar> turn =
          numbers().turn(place, lines_.template at<Scalar>(rest.positions, e));
      if (!turn.has_sides) continue;
      // How the turn grows with each node, across the line; it turns about either of two axes alike.
      const Scalar by_first(Scalar(1) / turn.first_length);
      const Scalar by_second(Scalar(1) / turn.second_length);
      const Scalar gradient[] = {by_first, Scalar(-by_first - by_second), by_second};
      const auto stiffness = [&](std::size_t corner, std::size_t other) -> Scalar {
        return Scalar(2) * stiffness_[place] * gradient[corner] * gradient[other];
      };
      append_pairs(lines_.elements(), e, stiffness, pairs);
    }
  }

  [[nodiscard]] Scalar potential_energy(const State<Scalar>& state) const {
    return lines_.template sum<Scalar>(
        [lines = numbers()](Eigen::Index place, const Corners<Scalar, 3>& x) {
          return lines.energy(place, x);
        },
        state.positions);
  }

 private:
  /// The lines' numbers, place by place.
  struct Numbers {
    const Scalar* stiffness;
    const Scalar* squared_first;
    const Scalar* squared_second;

    template <class Number>
    [[gnu::always_inline]] LineTurn<Number> turn(Eigen::Index place,
                                                 const Corners<Number, 3>& x) const {
      return line_turn(x, squared_first[place], squared_second[place]);
    }

    template <class Number>
    [[gnu::always_inline]] Corners<Number, 3> forces(Eigen::Index place,
                                                     const Corners<Number, 3>& x) const {
      const LineTurn<Number> now = turn(place, x);
      const Number minus_stiffness(-stiffness[place]);
      // -dE/dtheta / sin(theta)
      const Number moment(minus_stiffness * angle_over_sine(now.cosine, now.squared_sine));
      const Number none(Scalar(0));
      const Number with_sides = choose(now.has_sides, moment, none);
      return now.gradient_times(
          choose(is_opposite(now.cosine, now.squared_sine), none, with_sides));
    }

    [[gnu::always_inline]] Scalar energy(Eigen::Index place, const Corners<Scalar, 3>& x) const {
      const LineTurn<Scalar> now = turn(place, x);
      const Scalar pi(std::numbers::pi);
      // theta^2 = (theta / sin)^2 sin^2 is smooth where the line is straight.
      const Scalar ratio = angle_over_sine(now.cosine, now.squared_sine);
      const Scalar squared_angle =
          choose(is_opposite(now.cosine, now.squared_sine), Scalar(pi * pi),
                 Scalar(ratio * ratio * now.squared_sine));
      return choose(now.has_sides, Scalar(Scalar(0.5) * stiffness[place] * squared_angle),
                    Scalar(0));
    }
  };
  [[nodiscard]] Numbers numbers() const {
    return {stiffness_.data(), squared_first_.data(), squared_second_.data()};
  }

  BatchedAssembly<3> lines_;
  // In the order in which the assembly computes the lines.
  VectorX<Scalar> stiffness_;       ///< kappa [N m]
  VectorX<Scalar> squared_first_;   ///< square of the least length of the first side [m^2]
  VectorX<Scalar> squared_second_;  ///< of the second side [m^2]
};

}  // namespace weft::forces
