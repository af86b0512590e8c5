#include <weft/custom_forces/laws/elastic/nonlocal_torsion.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/custom_forces/laws/elastic/turning_angle.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kNonlocalTorsionParameters[] = {
    {.name = "stiffness", .symbol = "kappa", .unit = "N*m/rad", .summary = "torque per angle"},
};

Edges law_connections(const LawSpecification& specification, const ClothMesh& mesh) {
  std::string known;
  for (const ConnectionSet& set : mesh.connection_sets) {
    known += (known.empty() ? "" : ", ") + set.name;
  }
  std::vector<std::string> names = specification.sets;
  if (names.empty()) {
    for (const ConnectionSet& set : mesh.connection_sets) names.push_back(set.name);
  }
  Edges connections(2, 0);
  for (const std::string& name : names) {
    const ConnectionSet* found = nullptr;
    for (const ConnectionSet& set : mesh.connection_sets) {
      if (set.name == name) found = &set;
    }
    if (found == nullptr) {
      throw InvalidArgument("nonlocal_torsion: connection_sets = '" + name +
                            "', expected sets of the mesh: " + known);
    }
    const Eigen::Index old = connections.cols();
    connections.conservativeResize(2, old + found->connections.cols());
    connections.rightCols(found->connections.cols()) = found->connections;
  }
  if (connections.size() > 0 &&
      (connections.minCoeff() < 0 || connections.maxCoeff() >= mesh.num_nodes())) {
    throw InvalidArgument("nonlocal_torsion: a connection names a node outside 0 to " +
                          std::to_string(mesh.num_nodes() - 1));
  }
  return connections;
}

[[noreturn]] void refuse(int node, const std::string& what) {
  throw InvalidArgument("nonlocal_torsion: node " + std::to_string(node) + " " + what);
}

}  // namespace

/// The frame and the far node as they are now.
template <class Scalar>
template <class Number>
struct NonlocalTorsion<Scalar>::Pose {
  std::array<Vector3<Number>, kMaxRing> ring;  ///< from c [m]
  Number area;                                 ///< length of the area vector [m^2]
  Vector3<Number> normal;                      ///< n
  Number along_normal;                         ///< u . n, u the weighted sum of the ring
  Number tangent_length;                       ///< of u without its normal part
  Vector3<Number> second;                      ///< n x e1
  Vector3<Number> wanted;                      ///< R d0
  Vector3<Number> direction;                   ///< d
  Number distance;                             ///< of p from c [m]
  Number cosine;                               ///< of phi
  Number squared_sine;
};

template <class Scalar>
const LawInfo NonlocalTorsion<Scalar>::kInfo{
    .id = "nonlocal_torsion",
    .summary = "Far nodes keep their direction in the local frame of a node",
    .formula = "E = kappa phi^2 / 2, phi the angle between d and R d0",
    .source = "Werth 2008: non-local connections with torsion; frame and energy ours",
    .checked_by = "case nonlocal_torsion; tests NonlocalTorsion.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .free_at_rest = true,
               .has_energy = true,
               .elements = ElementKind::kConnections},
    .parameters = kNonlocalTorsionParameters};

template <class Scalar>
auto NonlocalTorsion<Scalar>::elements(const LawSpecification& specification, const ClothMesh& mesh)
    -> typename ElementForce<Scalar, kNodes>::Elements {
  const Edges connections = law_connections(specification, mesh);
  std::vector<int> centres(connections.row(0).begin(), connections.row(0).end());
  const std::vector<Ring> all_rings = rings(mesh.triangles, centres);
  typename ElementForce<Scalar, kNodes>::Elements result(kNodes, connections.cols());
  for (Eigen::Index e = 0; e < connections.cols(); ++e) {
    const std::vector<int>& ring = all_rings[static_cast<std::size_t>(e)].nodes;
    if (ring.size() < 2) {
      refuse(connections(0, e), "has no triangles around it, expected a node of the surface");
    }
    const std::size_t used = std::min<std::size_t>(ring.size(), kMaxRing);
    result.col(e).setConstant(connections(0, e));
    result(1, e) = connections(1, e);
    for (std::size_t k = 0; k < used; ++k) {
      result(2 + static_cast<Eigen::Index>(k), e) = ring[k * ring.size() / used];
    }
  }
  return result;
}

template <class Scalar>
NonlocalTorsion<Scalar>::NonlocalTorsion(const LawSpecification& specification,
                                         const ClothMesh& mesh)
    : ties_(elements(specification, mesh), mesh.num_nodes(), 16),
      stiffness_(law_scalar(specification, "stiffness")) {
  const std::vector<int> centres(ties_.elements().row(0).begin(), ties_.elements().row(0).end());
  const std::vector<Ring> all_rings = rings(mesh.triangles, centres);
  for (Eigen::Index e = 0; e < ties_.size(); ++e) {
    frames_.push_back(rest_frame(mesh, e, all_rings[static_cast<std::size_t>(e)].is_open));
  }
}

template <class Scalar>
auto NonlocalTorsion<Scalar>::rest_frame(const ClothMesh& mesh, Eigen::Index e, bool is_open) const
    -> Frame {
  const auto nodes = ties_.elements().col(e);
  Frame frame;
  while (frame.ring_size < kMaxRing && nodes[2 + frame.ring_size] != nodes[0]) ++frame.ring_size;
  frame.is_open = is_open;

  const Vector3<double> centre = mesh.rest_positions.col(nodes[0]);
  const Vector3<double> far = mesh.rest_positions.col(nodes[1]) - centre;
  Vector3<double> area = Vector3<double>::Zero();
  double spread = 0;
  for (int k = 0; k < frame.ring_size; ++k) {
    const Vector3<double> here = mesh.rest_positions.col(nodes[2 + k]) - centre;
    spread += here.squaredNorm();
    if (frame.is_open && k + 1 == frame.ring_size) break;
    const int after = (k + 1) % frame.ring_size;
    area += here.cross(Vector3<double>(mesh.rest_positions.col(nodes[2 + after]) - centre)) / 2;
  }
  if (!(far.norm() > 0) || !far.allFinite())
    refuse(nodes[1], "is where node " + std::to_string(nodes[0]) +
                         " is at rest, expected a distance > 0 [m]");
  if (!(area.norm() > 0) || !area.allFinite())
    refuse(nodes[0], "has a ring without area, expected > 0 [m^2]");

  // e1 points about where p is, so that its direction is well known in the frame; for a p straight
  // above any direction will do.
  const Vector3<double> normal = area.normalized();
  Vector3<double> towards = far - far.dot(normal) * normal;
  if (towards.norm() < 1e-3 * far.norm()) towards = mesh.rest_positions.col(nodes[2]) - centre;
  towards.normalize();
  Vector3<double> sum = Vector3<double>::Zero();
  Eigen::Matrix<double, kMaxRing, 1> weights = Eigen::Matrix<double, kMaxRing, 1>::Zero();
  for (int k = 0; k < frame.ring_size; ++k) {
    const Vector3<double> here = mesh.rest_positions.col(nodes[2 + k]) - centre;
    weights[k] = here.dot(towards) / spread;
    sum += weights[k] * here;
  }
  const Vector3<double> first = (sum - sum.dot(normal) * normal).normalized();
  const Vector3<double> direction = far.normalized();
  frame.weights = weights.template cast<Scalar>();
  frame.rest_direction << Scalar(direction.dot(first)), Scalar(direction.dot(normal.cross(first))),
      Scalar(direction.dot(normal));
  const double smallest = kMinRatio * area.norm();
  const double shortest = kMinRatio * far.norm();
  frame.smallest_area = Scalar(smallest * smallest);
  frame.shortest = Scalar(shortest * shortest);
  return frame;
}

template <class Scalar>
template <class Number>
bool NonlocalTorsion<Scalar>::pose_of(const Frame& frame, const ElementState<Number, kNodes>& tie,
                                      Pose<Number>& pose) {
  using std::sqrt;
  const Vector3<Number> none = Vector3<Number>::Constant(Number(0));
  Vector3<Number> area = none;
  Vector3<Number> sum = none;
  for (int k = 0; k < frame.ring_size; ++k) {
    const auto place = static_cast<std::size_t>(k);
    pose.ring[place] = tie.x[2 + place] - tie.x[0];
    sum += pose.ring[place] * Number(frame.weights[k]);
    if (k > 0) area += pose.ring[place - 1].cross(pose.ring[place]);
  }
  if (!frame.is_open) {
    area += pose.ring[static_cast<std::size_t>(frame.ring_size - 1)].cross(pose.ring[0]);
  }
  area = area * Number(Scalar(0.5));
  const Number squared_area = area.squaredNorm();
  if (!(squared_area > Number(frame.smallest_area))) return false;
  pose.area = sqrt(squared_area);
  pose.normal = area / pose.area;
  pose.along_normal = sum.dot(pose.normal);
  const Vector3<Number> tangent = sum - pose.normal * pose.along_normal;
  const Number squared_tangent = tangent.squaredNorm();
  // The weights make u about 1/2 long at rest.
  if (!(squared_tangent > Number(Scalar(kMinRatio * kMinRatio)))) return false;
  pose.tangent_length = sqrt(squared_tangent);
  const Vector3<Number> first = tangent / pose.tangent_length;
  pose.second = pose.normal.cross(first);
  pose.wanted = first * Number(frame.rest_direction[0]) +
                pose.second * Number(frame.rest_direction[1]) +
                pose.normal * Number(frame.rest_direction[2]);
  const Vector3<Number> far = tie.x[1] - tie.x[0];
  const Number squared_distance = far.squaredNorm();
  if (!(squared_distance > Number(frame.shortest))) return false;
  pose.distance = sqrt(squared_distance);
  pose.direction = far / pose.distance;
  pose.cosine = pose.direction.dot(pose.wanted);
  pose.squared_sine = pose.direction.cross(pose.wanted).squaredNorm();
  return true;
}

template <class Scalar>
template <class Number>
void NonlocalTorsion<Scalar>::add_tie(Eigen::Index e, const ElementState<Number, kNodes>& tie,
                                      ElementForces<Number, kNodes>& parts) const {
  const Frame& frame = frames_[static_cast<std::size_t>(e)];
  Pose<Number> pose;
  if (!pose_of(frame, tie, pose) || is_opposite(pose.cosine, pose.squared_sine)) return;
  const Number torque_ratio = angle_over_sine(pose.cosine, pose.squared_sine) * Number(stiffness_);
  const Vector3<Number> torque = pose.direction.cross(pose.wanted) * torque_ratio;
  parts[1] = torque.cross(pose.direction) / pose.distance;
  parts[0] = -parts[1];

  // The frame feels the opposite torque. A change of the ring turns the frame by n x dn, and about n
  // by e2 . (du - (u . n) dn) / |u_t|; the work of the torque on that, sorted by dn and du:
  const Number about_normal = -torque.dot(pose.normal) / pose.tangent_length;
  const Vector3<Number> by_sum = pose.second * about_normal;
  const Vector3<Number> by_area =
      (pose.normal.cross(torque) - pose.second * Number(about_normal * pose.along_normal)) *
      Number(Number(Scalar(0.5)) / pose.area);
  const auto add = [&](int place, const Vector3<Number>& force) {
    parts[2 + static_cast<std::size_t>(place)] += force;
    parts[0] -= force;
  };
  for (int k = 0; k < frame.ring_size; ++k) {
    add(k, by_sum * Number(frame.weights[k]));
    if (frame.is_open && k + 1 == frame.ring_size) break;
    const int after = (k + 1) % frame.ring_size;
    add(k, pose.ring[static_cast<std::size_t>(after)].cross(by_area));
    add(after, by_area.cross(pose.ring[static_cast<std::size_t>(k)]));
  }
}

template <class Scalar>
void NonlocalTorsion<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                         Matrix3XRef<Scalar> forces) const {
  const auto kernel = [this](Eigen::Index e, const auto& tie, auto& parts) {
    this->add_tie(e, tie, parts);
  };
  ties_.add_forces(state, kernel, scratch, forces);
}

template <class Scalar>
void NonlocalTorsion<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                                    ConstMatrix3XRef<Scalar> displacements,
                                                    Matrix3XRef<Scalar> scratch,
                                                    Matrix3XRef<Scalar> product) const {
  const auto kernel = [this](Eigen::Index e, const auto& tie, auto& parts) {
    this->add_tie(e, tie, parts);
  };
  ties_.add_stiffness_product(state, kernel, displacements, scratch, product);
}

template <class Scalar>
Scalar NonlocalTorsion<Scalar>::potential_energy(const State<Scalar>& state) const {
  return ties_.sum(state, [this](Eigen::Index e, const auto& tie) -> Scalar {
    using std::sqrt;
    Pose<Scalar> pose;
    if (!pose_of(frames_[static_cast<std::size_t>(e)], tie, pose)) return Scalar(0);
    if (pose.cosine > Scalar(0)) {
      const Scalar ratio = angle_over_sine(pose.cosine, pose.squared_sine);
      return Scalar(0.5) * stiffness_ * ratio * ratio * pose.squared_sine;
    }
    const Scalar angle = arc_tangent(Scalar(sqrt(pose.squared_sine)), pose.cosine);
    return Scalar(0.5) * stiffness_ * angle * angle;
  });
}

WEFT_INSTANTIATE_LAW(NonlocalTorsion);

}  // namespace weft::forces
