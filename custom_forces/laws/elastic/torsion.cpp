#include <weft/custom_forces/laws/elastic/torsion.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/custom_forces/assembly/spring_set.hpp>
#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/laws/elastic/turning_angle.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kTorsionParameters[] = {
    {.name = "stiffness",
     .symbol = "k",
     .unit = "N/(m*rad)",
     .summary = "force per lever arm and angle"},
    {.name = "side_ratio",
     .symbol = "ratio",
     .unit = "1",
     .summary = "stiffness of the second side over that of the first",
     .required = false,
     .default_value = 1.0},
};

Triples law_triples(const LawSpecification& specification, const ClothMesh& mesh) {
  Triples triples(3, 0);
  const auto append = [&](const Triples& more) {
    const Eigen::Index old = triples.cols();
    triples.conservativeResize(3, old + more.cols());
    triples.rightCols(more.cols()) = more;
  };
  std::string known;
  for (const LineSet& set : mesh.line_sets) known += (known.empty() ? "" : ", ") + set.name;
  for (const LineSet& set : mesh.line_sets) {
    if (specification.sets.empty()) append(set.triples);
  }
  for (const std::string& name : specification.sets) {
    bool found = false;
    for (const LineSet& set : mesh.line_sets) {
      if (set.name != name) continue;
      append(set.triples);
      found = true;
    }
    if (!found) {
      throw InvalidArgument("torsion: line_sets = '" + name +
                            "', expected sets of the mesh: " + known);
    }
  }
  if (triples.size() > 0 && (triples.minCoeff() < 0 || triples.maxCoeff() >= mesh.num_nodes())) {
    throw InvalidArgument("torsion: a line names a node outside 0 to " +
                          std::to_string(mesh.num_nodes() - 1));
  }
  return triples;
}

double rest_side(const ClothMesh& mesh, int from, int to) {
  const double length = (mesh.rest_positions.col(to) - mesh.rest_positions.col(from)).norm();
  if (!(length > 0) || !std::isfinite(length)) {
    throw InvalidArgument("torsion: rest length between nodes " + std::to_string(from) + " and " +
                          std::to_string(to) + " = " + std::to_string(length) +
                          " [m], expected > 0 and finite");
  }
  return length;
}

}  // namespace

template <class Scalar>
const LawInfo Torsion<Scalar>::kInfo{
    .id = "torsion",
    .summary = "Bending of lines by torsion springs over three points",
    .formula =
        "E = kappa (s theta - theta0)^2 / 2, kappa = (k' d'^2 + k'' d''^2) / 2, k' = k, "
        "k'' = ratio k",
    .source = "Werth 2008: torsion over three points with rest lengths as lever arms; energy ours",
    .checked_by = "case torsion_beam; tests Torsion.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .free_at_rest = true,
               .has_energy = true,
               .elements = ElementKind::kLines,
               .role = LawRole::kBending},
    .parameters = kTorsionParameters};

/// Lines at rest, straight and bent ones apart.
template <class Scalar>
struct Torsion<Scalar>::RestLines {
  struct Part {
    Triples triples{3, 0};
    std::vector<double> stiffness;  ///< kappa [N m]
    std::vector<double> angles;     ///< theta [rad]
    std::vector<double> sides;      ///< d' and d'' of each line in turn [m]
  };
  Part straight;
  Part bent;

  RestLines(const LawSpecification& specification, const ClothMesh& mesh) {
    const double first = law_scalar(specification, "stiffness");
    const double second = first * law_scalar(specification, "side_ratio");
    const Triples triples = law_triples(specification, mesh);
    std::vector<Eigen::Index> of_straight;
    std::vector<Eigen::Index> of_bent;
    for (Eigen::Index e = 0; e < triples.cols(); ++e) {
      const Eigen::Vector3i nodes = triples.col(e);
      const double d1 = rest_side(mesh, nodes[0], nodes[1]);
      const double d2 = rest_side(mesh, nodes[1], nodes[2]);
      Corners<double, 3> x;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vector3<double> position = mesh.rest_positions.col(nodes[static_cast<int>(corner)]);
        x[corner] = {position.x(), position.y(), position.z()};
      }
      const LineTurn<double> turn = line_turn(x, 0.0, 0.0);
      const double theta = arc_tangent(std::sqrt(turn.squared_sine), turn.cosine);
      // Rounding bends a straight line by less than this.
      constexpr double kStraight = 1e-7;  // [rad]
      (theta > kStraight ? of_bent : of_straight).push_back(e);
      Part& part = theta > kStraight ? bent : straight;
      part.stiffness.push_back((first * d1 * d1 + second * d2 * d2) / 2);
      part.angles.push_back(theta);
      part.sides.insert(part.sides.end(), {d1, d2});
    }
    straight.triples = triples(Eigen::all, of_straight);
    bent.triples = triples(Eigen::all, of_bent);
  }
};

template <class Scalar>
Torsion<Scalar>::Torsion(const LawSpecification& specification, const ClothMesh& mesh)
    : Torsion(RestLines(specification, mesh), mesh) {}

template <class Scalar>
Torsion<Scalar>::Torsion(const RestLines& lines, const ClothMesh& mesh)
    : straight_(lines.straight.triples, mesh.num_nodes(), lines.straight.stiffness,
                lines.straight.sides),
      bent_(lines.bent.triples, mesh.num_nodes(), 3),
      stiffness_(bent_.size()),
      rest_angles_(bent_.size()),
      squared_shortest_(2, bent_.size()),
      faces_(3, 0) {
  std::vector<std::vector<Eigen::Index>> faces_of_node(static_cast<std::size_t>(mesh.num_nodes()));
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (const int node : mesh.triangles.col(t)) {
      faces_of_node[static_cast<std::size_t>(node)].push_back(t);
    }
  }
  const Matrix3X<Scalar> rest_positions = mesh.rest_positions.template cast<Scalar>();
  const Matrix3X<Scalar> still = Matrix3X<Scalar>::Constant(3, mesh.num_nodes(), Scalar(0));
  const VectorX<Scalar> masses = mesh.masses.template cast<Scalar>();
  const State<Scalar> rest{rest_positions, still, masses};
  first_face_.push_back(0);
  for (Eigen::Index e = 0; e < bent_.size(); ++e) {
    const auto line = static_cast<std::size_t>(e);
    stiffness_[e] = Scalar(lines.bent.stiffness[line]);
    for (std::size_t side = 0; side < 2; ++side) {
      const double shortest = kMinLengthRatio * lines.bent.sides[2 * line + side];
      squared_shortest_(static_cast<Eigen::Index>(side), e) = Scalar(shortest * shortest);
    }
    for (const Eigen::Index t : faces_of_node[static_cast<std::size_t>(bent_.elements()(1, e))]) {
      faces_.conservativeResize(3, faces_.cols() + 1);
      faces_.rightCols(1) = mesh.triangles.col(t);
    }
    first_face_.push_back(faces_.cols());
    rest_angles_[e] = Scalar(lines.bent.angles[line]) * side(rest, e, bent_.at(rest, e));
  }
}

template <class Scalar>
Vector3<Scalar> Torsion<Scalar>::normal_at(const State<Scalar>& state, Eigen::Index e) const {
  Vector3<Scalar> normal = Vector3<Scalar>::Constant(Scalar(0));
  for (Eigen::Index f = first_face_[static_cast<std::size_t>(e)];
       f < first_face_[static_cast<std::size_t>(e) + 1]; ++f) {
    const Vector3<Scalar> origin = state.positions.col(faces_(0, f));
    const Vector3<Scalar> u = state.positions.col(faces_(1, f)) - origin;
    const Vector3<Scalar> v = state.positions.col(faces_(2, f)) - origin;
    normal += u.cross(v);
  }
  return normal;
}

template <class Scalar>
template <class Number>
LineTurn<Number> Torsion<Scalar>::turn_of(Eigen::Index e,
                                          const ElementState<Number, 3>& line) const {
  Corners<Number, 3> x;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    x[corner] = {line.x[corner].x(), line.x[corner].y(), line.x[corner].z()};
  }
  return line_turn(x, squared_shortest_(0, e), squared_shortest_(1, e));
}

template <class Scalar>
Scalar Torsion<Scalar>::side(const State<Scalar>& state, Eigen::Index e,
                             const ElementState<Scalar, 3>& line) const {
  const LineTurn<Scalar> turn = turn_of(e, line);
  if (!turn.has_sides) return Scalar(1);
  const Vector3<Scalar> normal = normal_at(state, e);
  // The line turns away from the normal where the front is convex.
  const Scalar towards =
      (turn.second - turn.first).dot(PlainVector<Scalar>{normal.x(), normal.y(), normal.z()});
  return towards > Scalar(0) ? Scalar(-1) : Scalar(1);
}

template <class Scalar>
template <class Number>
void Torsion<Scalar>::add_line(const State<Scalar>& state, Eigen::Index e,
                               const ElementState<Number, 3>& line,
                               ElementForces<Number, 3>& parts) const {
  using std::sqrt;
  const LineTurn<Number> turn = turn_of(e, line);
  if (!turn.has_sides) return;
  if (!(turn.squared_sine > Number(kOppositeSquaredSine))) return;  // straight, or folded back
  const Scalar s = side(state, e, bent_.at(state, e));
  const Number sine = sqrt(turn.squared_sine);
  // -dE/dtheta / sin(theta)
  const Number pull =
      Number(stiffness_[e]) *
      Number(Number(s * rest_angles_[e]) / sine - angle_over_sine(turn.cosine, turn.squared_sine));
  const Corners<Number, 3> forces = turn.gradient_times(pull);
  for (std::size_t corner = 0; corner < 3; ++corner) {
    parts[corner] << forces[corner].x, forces[corner].y, forces[corner].z;
  }
}

template <class Scalar>
void Torsion<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                 Matrix3XRef<Scalar> forces) const {
  const auto kernel = [&](Eigen::Index e, const auto& line, auto& parts) {
    add_line(state, e, line, parts);
  };
  bent_.add_forces(state, kernel, scratch, forces);
  straight_.add_forces(state, scratch, forces);
}

template <class Scalar>
void Torsion<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                            ConstMatrix3XRef<Scalar> displacements,
                                            Matrix3XRef<Scalar> scratch,
                                            Matrix3XRef<Scalar> product) const {
  const auto kernel = [&](Eigen::Index e, const auto& line, auto& parts) {
    add_line(state, e, line, parts);
  };
  bent_.add_stiffness_product(state, kernel, displacements, scratch, product);
  straight_.add_stiffness_product(state, displacements, scratch, product);
}

template <class Scalar>
void Torsion<Scalar>::add_rest_stiffness(const State<Scalar>& rest,
                                         std::vector<PairStiffness<Scalar>>& pairs) const {
  straight_.add_rest_stiffness(rest, pairs);
  for (Eigen::Index e = 0; e < bent_.size(); ++e) {
    using std::sqrt;
    const LineTurn<Scalar> turn = turn_of(e, bent_.at(rest, e));
    if (!turn.has_sides || !(turn.squared_sine > Scalar(kOppositeSquaredSine))) continue;
    const Corners<Scalar, 3> gradient =
        turn.gradient_times(Scalar(Scalar(1) / sqrt(turn.squared_sine)));
    const auto stiffness = [&](std::size_t corner, std::size_t other) -> Scalar {
      return stiffness_[e] * gradient[corner].dot(gradient[other]);
    };
    bent_.add_pairs(e, stiffness, pairs);
  }
}

template <class Scalar>
Scalar Torsion<Scalar>::potential_energy(const State<Scalar>& state) const {
  const Scalar of_bent = bent_.sum(state, [&](Eigen::Index e, const auto& line) -> Scalar {
    using std::sqrt;
    const LineTurn<Scalar> turn = turn_of(e, line);
    if (!turn.has_sides) return Scalar(0);
    const Scalar theta = arc_tangent(Scalar(sqrt(turn.squared_sine)), turn.cosine);
    const Scalar off = side(state, e, line) * theta - rest_angles_[e];
    return Scalar(0.5) * stiffness_[e] * off * off;
  });
  return straight_.potential_energy(state) + of_bent;
}

WEFT_INSTANTIATE_LAW(Torsion);

}  // namespace weft::forces
