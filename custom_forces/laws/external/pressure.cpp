#include <weft/custom_forces/laws/external/pressure.hpp>

#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include <weft/core/error.hpp>
#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>
#include <weft/mesh/topology/hinges.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kPressureParameters[] = {
    {.name = "pressure",
     .symbol = "p0",
     .unit = "Pa",
     .summary = "pressure of the gas at the rest volume"},
    {.name = "outside_pressure",
     .symbol = "p_a",
     .unit = "Pa",
     .summary = "pressure around the mesh",
     .required = false,
     .default_value = 0.0},
    {.name = "reservoir_volume",
     .symbol = "V_r",
     .unit = "m^3",
     .summary = "volume of gas outside the mesh; a very large one keeps the pressure constant",
     .required = false,
     .default_value = 0.0},
};

/// Six times the volume between a face and the point from. Positions are taken relative to a point
/// of the mesh, or far from the origin the sum would be lost in rounding.
template <class Scalar>
Scalar six_volumes(const Vector3<Scalar>& from, const Vector3<Scalar>& a, const Vector3<Scalar>& b,
                   const Vector3<Scalar>& c) {
  const Vector3<Scalar> u = a - from;
  const Vector3<Scalar> v = b - from;
  const Vector3<Scalar> w = c - from;
  return u.dot(v.cross(w));
}

Triangles closed_faces(const LawSpecification& specification, const ClothMesh& mesh) {
  Triangles faces = law_faces(specification, mesh);
  if (!is_closed_surface(faces)) {
    throw InvalidArgument(specification.law +
                          ": the surface of the mesh is open, expected every edge to belong to two "
                          "triangles that turn the same way round");
  }
  return faces;
}

double rest_volume(const LawSpecification& specification, const ClothMesh& mesh) {
  const Vector3<double> from = mesh.rest_positions.col(mesh.triangles(0, 0));
  double sum = 0.0;
  for (const auto& face : mesh.triangles.colwise()) {
    sum += six_volumes<double>(from, mesh.rest_positions.col(face[0]),
                               mesh.rest_positions.col(face[1]), mesh.rest_positions.col(face[2]));
  }
  const double volume = sum / 6;
  if (!(volume > 0) || !std::isfinite(volume)) {
    throw InvalidArgument(specification.law + ": volume at rest = " + std::to_string(volume) +
                          " [m^3], expected > 0: the front of the faces must be outside");
  }
  return volume;
}

/// x - ln(1 + x), x > -1, without the loss of digits where x is small, as with a large reservoir.
template <class Scalar>
Scalar excess_over_log(const Scalar& x) {
  using std::log;
  if (x > Scalar(0.25) || x < Scalar(-0.25)) return x - Scalar(log(Scalar(Scalar(1) + x)));
  // ln(1 + x) = 2 (y + y^3/3 + y^5/5 + ...), |y| <= 1/7: the first term left out is 1e-18 of y^3.
  constexpr int kTerms = 10;
  const Scalar y = x / Scalar(Scalar(2) + x);
  const Scalar squared = y * y;
  Scalar sum(0);
  for (int term = kTerms; term >= 1; --term) sum = sum * squared + Scalar(1.0 / (2 * term + 1));
  return x * y - Scalar(2) * squared * y * sum;  // x - 2 y = x y
}

/// Area times normal of a face [m^2].
template <class Number>
Vector3<Number> area_vector(const std::array<Vector3<Number>, 3>& x) {
  const Vector3<Number> edge1 = x[1] - x[0];
  const Vector3<Number> edge2 = x[2] - x[0];
  return edge1.cross(edge2) * Number(0.5);
}

}  // namespace

template <class Scalar>
const LawInfo Pressure<Scalar>::kInfo{
    .id = "pressure",
    .summary = "Gas of one temperature in a closed mesh",
    .formula =
        "p = p0 (V0 + V_r) / (V + V_r) - p_a, f = p dV/dx, "
        "E = -p0 (V0 + V_r) ln((V + V_r) / (V0 + V_r)) + p_a (V - V0)",
    .source = "Boyle's law",
    .checked_by = "case balloon; tests Pressure.*",
    .traits = {.internal = true,
               .ignores_rigid_motion = true,
               .has_energy = true,
               .elements = ElementKind::kFaces,
               .needs_closed_surface = true},
    .parameters = kPressureParameters};

template <class Scalar>
Pressure<Scalar>::Pressure(const LawSpecification& specification, const ClothMesh& mesh)
    : faces_(closed_faces(specification, mesh), mesh.num_nodes(), 2),
      outside_pressure_(law_scalar(specification, "outside_pressure")),
      reservoir_(law_scalar(specification, "reservoir_volume")) {
  const double volume = rest_volume(specification, mesh);
  rest_volume_ = Scalar(volume);
  smallest_volume_ = Scalar(kMinVolumeRatio * volume);
  amount_ = Scalar(law_scalar(specification, "pressure") *
                   (volume + law_scalar(specification, "reservoir_volume")));
}

template <class Scalar>
Scalar Pressure<Scalar>::volume(const State<Scalar>& state) const {
  const Vector3<Scalar> from = state.positions.col(faces_.elements()(0, 0));
  return faces_.sum(state, [&](Eigen::Index, const auto& face) -> Scalar {
    return six_volumes<Scalar>(from, face.x[0], face.x[1], face.x[2]);
  }) / Scalar(6);
}

template <class Scalar>
typename Pressure<Scalar>::Gas Pressure<Scalar>::gas_at(const Scalar& volume) const {
  const bool is_crushed = volume < smallest_volume_;
  const Scalar space = (is_crushed ? smallest_volume_ : volume) + reservoir_;
  const Scalar pressure = amount_ / space;
  return {pressure - outside_pressure_, is_crushed ? Scalar(0) : Scalar(-pressure / space)};
}

template <class Scalar>
void Pressure<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                                  Matrix3XRef<Scalar> forces) const {
  const Scalar third = gas_at(volume(state)).pressure / Scalar(3);
  faces_.add_forces(
      state,
      [&](Eigen::Index, const auto& face, auto& parts) {
        parts[0] = parts[1] = parts[2] = area_vector(face.x) * third;
      },
      scratch, forces);
}

template <class Scalar>
void Pressure<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                             ConstMatrix3XRef<Scalar> displacements,
                                             Matrix3XRef<Scalar> scratch,
                                             Matrix3XRef<Scalar> product) const {
  // The volume changes by dV/dx . b, and with it the pressure on every face.
  Scalar volume_change(0);
  for (Eigen::Index f = 0; f < faces_.size(); ++f) {
    const Eigen::Vector3i nodes = faces_.elements().col(f);
    const Vector3<Scalar> moved =
        displacements.col(nodes[0]) + displacements.col(nodes[1]) + displacements.col(nodes[2]);
    volume_change += area_vector(faces_.at(state, f).x).dot(moved);
  }
  volume_change /= Scalar(3);
  const Gas gas = gas_at(volume(state));
  const Tangent<Scalar> third(gas.pressure / Scalar(3), gas.slope * volume_change / Scalar(3));
  faces_.add_stiffness_product(
      state,
      [&](Eigen::Index, const auto& face, auto& parts) {
        parts[0] = parts[1] = parts[2] = area_vector(face.x) * third;
      },
      displacements, scratch, product);
}

template <class Scalar>
Scalar Pressure<Scalar>::potential_energy(const State<Scalar>& state) const {
  const Scalar now = volume(state);
  const bool is_crushed = now < smallest_volume_;
  const Scalar known = is_crushed ? smallest_volume_ : now;
  // With x = dV / (V0 + V_r): -p0 (V0 + V_r) ln(1 + x) = amount (x - ln(1 + x)) - p0 dV. Inside and
  // outside pressure nearly cancel in a balloon, and should do so before dV is multiplied.
  const Scalar change = known - rest_volume_;
  const Scalar whole = rest_volume_ + reservoir_;
  Scalar energy = amount_ * excess_over_log(Scalar(change / whole)) +
                  (outside_pressure_ - amount_ / whole) * change;
  if (is_crushed) energy -= gas_at(now).pressure * Scalar(now - known);
  return energy;
}

WEFT_INSTANTIATE_LAW(Pressure);

}  // namespace weft::forces
