#include <weft/custom_forces/laws/elastic/hinge_torsion.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/custom_forces/assembly/arc_tangent.hpp>
#include <weft/custom_forces/assembly/element_pairs.hpp>
#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kHingeTorsionParameters[] = {
    {.name = "rigidity", .symbol = "D", .unit = "N*m", .summary = "plate rigidity"},
    {.name = "clamp_factor",
     .symbol = "factor",
     .unit = "1",
     .summary = "stiffness of a hinge at a clamp over that of others; 2: half a cell is in front",
     .required = false,
     .default_value = 2.0},
};

/// A hinge at rest, unfolded into a plane with the edge along t and n across it.
struct RestHinge {
  double length = 0;       ///< of the edge [m]
  double heights[2] = {};  ///< of the triangles above the edge [m]
  double feet[2] = {};     ///< of the heights, from the edge's first node [m]
  [[nodiscard]] double areas() const { return length * (heights[0] + heights[1]) / 2; }
};

RestHinge rest_hinge(const ClothMesh& mesh, const Eigen::Vector4i& nodes) {
  const auto x = [&](int corner) -> Vector3<double> {
    return mesh.rest_positions.col(nodes[corner]);
  };
  const Vector3<double> edge = x(1) - x(0);
  RestHinge hinge;
  hinge.length = edge.norm();
  for (int side = 0; side < 2; ++side) {
    const Vector3<double> wing = x(2 + side) - x(0);
    const double twice_area = edge.cross(wing).norm();
    if (!(twice_area > 0) || !std::isfinite(twice_area)) {
      throw InvalidArgument("hinge_torsion: area of the triangle of nodes " +
                            std::to_string(nodes[0]) + ", " + std::to_string(nodes[1]) + " and " +
                            std::to_string(nodes[2 + side]) + " = " +
                            std::to_string(twice_area / 2) + " [m^2], expected > 0 and finite");
    }
    hinge.heights[side] = twice_area / hinge.length;
    hinge.feet[side] = wing.dot(edge) / hinge.length;
  }
  return hinge;
}

/// S : S [m^2], see the header.
double squared_response(const RestHinge& hinge) {
  const auto& [h1, h2] = hinge.heights;
  const auto& [f1, f2] = hinge.feet;
  const double l = hinge.length;
  const double across = (h1 + h2) / 2;
  const double along = (f1 * (f1 - l) / h1 + f2 * (f2 - l) / h2) / 2;
  const double mixed = (f1 - f2) / 2;
  return across * across + along * along + 2 * mixed * mixed;
}

/// k / D, see the header.
double weight(const RestHinge& hinge, bool is_cut_both_ways) {
  if (is_cut_both_ways) return hinge.areas() / (2 * squared_response(hinge));
  return hinge.length * hinge.length / hinge.areas();  // l / h with the mean height h = areas / l
}

/// Whether the angle depends on one free node only, and on pinned ones besides.
bool is_at_clamp(const RestHinge& hinge, const std::vector<bool>& pinned,
                 const Eigen::Vector4i& nodes) {
  const auto is_free = [&](int corner) { return !pinned[static_cast<std::size_t>(nodes[corner])]; };
  const auto& [h1, h2] = hinge.heights;
  const auto& [f1, f2] = hinge.feet;
  // The angle's derivative by the height of the edge's second node, and of the first.
  const double by_second = f1 / h1 + f2 / h2;
  const double by_first = (hinge.length - f1) / h1 + (hinge.length - f2) / h2;
  constexpr double kInactive = 1e-9;  // rounding of a right angle
  const double threshold = kInactive * (by_first + by_second);
  int num_free = int{is_free(2)} + int{is_free(3)};
  if (std::abs(by_first) > threshold && is_free(0)) ++num_free;
  if (std::abs(by_second) > threshold && is_free(1)) ++num_free;
  return num_free == 1;
}

/// dtheta/dx of the four nodes, and theta.
template <class Number>
struct HingeAngle {
  bool has_normals;  ///< else the gradient is finite, and means nothing
  Number theta;
  Corners<Number, 4> gradient;
};

/// Without branches, for the vector unit. A hinge with a triangle too small to have a normal has the angle at_rest, and so no
/// moment. smallest: least squared length of both normals [m^4].
template <class Number, class Scalar>
[[gnu::always_inline]] inline HingeAngle<Number> hinge_angle(const Corners<Number, 4>& x,
                                                             const Scalar& smallest_first,
                                                             const Scalar& smallest_second,
                                                             const Scalar& at_rest) {
  using std::sqrt;
  const PlainVector<Number> edge = x[1] - x[0];
  const PlainVector<Number> wing1 = x[2] - x[0];
  const PlainVector<Number> wing2 = x[3] - x[0];
  const PlainVector<Number> n1 = edge.cross(wing1);
  const PlainVector<Number> n2 = wing2.cross(edge);
  const Number given1 = n1.squared_norm();
  const Number given2 = n2.squared_norm();
  const Number given_length = edge.squared_norm();
  const bool has_normals = given1 > Number(smallest_first) && given2 > Number(smallest_second);
  const Number one(Scalar(1));
  const Number squared1 = choose(has_normals, given1, one);
  const Number squared2 = choose(has_normals, given2, one);
  const Number squared_length = choose(has_normals, given_length, one);
  const Number length(sqrt(squared_length));
  const Number inverse(one / squared_length);
  const Number foot1(wing1.dot(edge) * inverse);
  const Number foot2(wing2.dot(edge) * inverse);
  HingeAngle<Number> angle;
  angle.has_normals = has_normals;
  // n1 x n2 lies along the edge: this is |n1| |n2| sin(theta) and cos(theta). Of the wing only what is across the edge counts: what
  // rounding gives n1 along the edge would meet the rest, which is long beside the height of a thin triangle.
  const PlainVector<Number> across = wing2 - foot2 * edge;
  const Number theta = arc_tangent(Number(-(n1.dot(across) * length)), n1.dot(n2));
  angle.theta = choose(has_normals, theta, Number(at_rest));
  // Raising a wing along its normal closes the hinge by 1 / height; the edge's nodes balance force
  // and torque.
  const PlainVector<Number> by_wing1 = Number(length / squared1) * n1;
  const PlainVector<Number> by_wing2 = Number(length / squared2) * n2;
  const Number minus(Scalar(-1));
  angle.gradient[2] = minus * by_wing1;
  angle.gradient[3] = minus * by_wing2;
  angle.gradient[1] = foot1 * by_wing1 + foot2 * by_wing2;
  angle.gradient[0] = by_wing1 + by_wing2 - angle.gradient[1];
  return angle;
}

}  // namespace

template <class Scalar>
const LawInfo HingeTorsion<Scalar>::kInfo{
    .id = "hinge_torsion",
    .summary = "Bending of a surface by torsion springs in its hinges",
    .formula =
        "E = k (theta - theta0)^2 / 2, k = D A / (2 S : S) on cells cut both ways (D / 2 on "
        "squares), "
        "D l / h elsewhere, times factor at a clamp",
    .source =
        "own derivation: energy of a quadratic surface; length weighting as in Feng et al. 2022",
    .checked_by =
        "cases plate_rigidity, cantilever, engine_cantilever, heavy_strip; tests HingeTorsion.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .free_at_rest = true,
               .has_energy = true,
               .elements = ElementKind::kHinges,
               .role = LawRole::kBending},
    .parameters = kHingeTorsionParameters};

template <class Scalar>
HingeTorsion<Scalar>::HingeTorsion(const LawSpecification& specification, const ClothMesh& mesh)
    : hinges_(bending_hinges(mesh), mesh.num_nodes()),
      stiffness_(hinges_.size()),
      rest_angles_(hinges_.size()),
      smallest_normals_{VectorX<Scalar>(hinges_.size()), VectorX<Scalar>(hinges_.size())} {
  const double rigidity = law_scalar(specification, "rigidity");
  const double clamp_factor = law_scalar(specification, "clamp_factor");
  const bool is_cut_both_ways = mesh.crossed_triangles.cols() > 0;
  std::vector<bool> pinned(static_cast<std::size_t>(mesh.num_nodes()), false);
  for (const int node : mesh.pinned) pinned[static_cast<std::size_t>(node)] = true;
  for (Eigen::Index place = 0; place < hinges_.size(); ++place) {
    const Eigen::Index h = hinges_.order()[static_cast<std::size_t>(place)];
    const Eigen::Vector4i nodes = hinges_.elements().col(h);
    const RestHinge hinge = rest_hinge(mesh, nodes);
    const double factor = is_at_clamp(hinge, pinned, nodes) ? clamp_factor : 1.0;
    stiffness_[place] = Scalar(rigidity * factor * weight(hinge, is_cut_both_ways));
    // By the formula of the motion: a hinge that is folded flat at rest is so on the same side.
    const auto corners = hinges_.template at<double>(mesh.rest_positions, h);
    rest_angles_[place] = Scalar(hinge_angle(corners, 0.0, 0.0, 0.0).theta);
    for (int side = 0; side < 2; ++side) {
      const double smallest = kMinAreaRatio * hinge.length * hinge.heights[side];
      smallest_normals_[side][place] = Scalar(smallest * smallest);
    }
  }
}

/// The hinges' numbers, place by place.
template <class Scalar>
struct HingeTorsion<Scalar>::Numbers {
  const Scalar* stiffness;
  const Scalar* rest_angles;
  const Scalar* smallest_first;
  const Scalar* smallest_second;

  template <class Number>
  [[gnu::always_inline]] HingeAngle<Number> angle(Eigen::Index place,
                                                  const Corners<Number, 4>& x) const {
    return hinge_angle(x, smallest_first[place], smallest_second[place], rest_angles[place]);
  }
  template <class Number>
  [[gnu::always_inline]] Corners<Number, 4> forces(Eigen::Index place,
                                                   const Corners<Number, 4>& x) const {
    const HingeAngle<Number> now = angle(place, x);
    const Number moment(Number(stiffness[place]) * (Number(rest_angles[place]) - now.theta));
    return {moment * now.gradient[0], moment * now.gradient[1], moment * now.gradient[2],
            moment * now.gradient[3]};
  }
};

template <class Scalar>
auto HingeTorsion<Scalar>::numbers() const -> Numbers {
  return {stiffness_.data(), rest_angles_.data(), smallest_normals_[0].data(),
          smallest_normals_[1].data()};
}

template <class Scalar>
void HingeTorsion<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                      Matrix3XRef<Scalar> forces) const {
  const Numbers hinges = numbers();
  const auto force = [hinges](Eigen::Index place, const Corners<Scalar, 4>& x) {
    return hinges.forces(place, x);
  };
  hinges_.template add<Scalar>(force, scratch, forces, state.positions);
}

template <class Scalar>
void HingeTorsion<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                                 ConstMatrix3XRef<Scalar> displacements,
                                                 Matrix3XRef<Scalar> scratch,
                                                 Matrix3XRef<Scalar> product) const {
  const Numbers hinges = numbers();
  const auto force = [hinges](Eigen::Index place, const auto& x) {
    return hinges.forces(place, x);
  };
  hinges_.template add_stiffness_product<Scalar>(force, state.positions, displacements, scratch,
                                                 product);
}

template <class Scalar>
void HingeTorsion<Scalar>::add_rest_stiffness(const State<Scalar>& rest,
                                              std::vector<PairStiffness<Scalar>>& pairs) const {
  for (Eigen::Index place = 0; place < hinges_.size(); ++place) {
    const Eigen::Index h = hinges_.order()[static_cast<std::size_t>(place)];
    const HingeAngle<Scalar> angle =
        numbers().angle(place, hinges_.template at<Scalar>(rest.positions, h));
    if (!angle.has_normals) continue;
    // Without a moment only the gradient's square is left of the second derivative.
    const auto stiffness = [&](std::size_t corner, std::size_t other) -> Scalar {
      return stiffness_[place] * angle.gradient[corner].dot(angle.gradient[other]);
    };
    append_pairs(hinges_.elements(), h, stiffness, pairs);
  }
}

template <class Scalar>
void HingeTorsion<Scalar>::get_gradients(ConstMatrix3XRef<Scalar> positions,
                                         Eigen::Ref<Gradients> gradients) const {
  using std::sqrt;
  for (Eigen::Index place = 0; place < hinges_.size(); ++place) {
    const Eigen::Index h = hinges_.order()[static_cast<std::size_t>(place)];
    const HingeAngle<Scalar> angle =
        numbers().angle(place, hinges_.template at<Scalar>(positions, h));
    const Scalar root = angle.has_normals ? Scalar(sqrt(stiffness_[place])) : Scalar(0);
    for (int corner = 0; corner < 4; ++corner) {
      const PlainVector<Scalar>& g = angle.gradient[static_cast<std::size_t>(corner)];
      gradients.col(h).template segment<3>(3 * corner) =
          Vector3<Scalar>(root * g.x, root * g.y, root * g.z);
    }
  }
}

template <class Scalar>
Scalar HingeTorsion<Scalar>::potential_energy(const State<Scalar>& state) const {
  const Numbers hinges = numbers();
  return hinges_.template sum<Scalar>(
      [hinges](Eigen::Index place, const Corners<Scalar, 4>& x) {
        const Scalar turn(hinges.angle(place, x).theta - hinges.rest_angles[place]);
        return Scalar(Scalar(0.5) * hinges.stiffness[place] * turn * turn);
      },
      state.positions);
}

WEFT_INSTANTIATE_LAW(HingeTorsion);

}  // namespace weft::forces
