#include <weft/custom_forces/laws/external/wind.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <weft/custom_forces/instantiate_law.hpp>
#include <weft/custom_forces/law_input.hpp>

namespace weft::forces {
namespace {

constexpr ParameterInfo kWindParameters[] = {
    {.name = "velocity", .symbol = "u", .unit = "m/s", .summary = "velocity of the air", .size = 3},
    {.name = "air_density",
     .symbol = "rho",
     .unit = "kg/m^3",
     .summary = "density of the air; 1.2: at 20 degrees Celsius",
     .required = false,
     .default_value = 1.2},
    {.name = "normal_drag",
     .symbol = "C_n",
     .unit = "1",
     .summary = "drag across the face; 1: full dynamic pressure, a stiff square plate has 1.2",
     .required = false,
     .default_value = 1.0},
    {.name = "tangential_drag",
     .symbol = "C_t",
     .unit = "1",
     .summary = "drag along the face",
     .required = false,
     .default_value = 0.0},
};

}  // namespace

template <class Scalar>
const LawInfo Wind<Scalar>::kInfo{
    .id = "wind",
    .summary = "Drag of moving air on the faces, and of still air on moving faces",
    .formula =
        "f = rho (C_n |w.n| (w.n) n + C_t |w_t| w_t) A / 2 per face of area A and normal n, "
        "w = u - v, w_t = w - (w.n) n",
    .source = "quadratic drag, resolved along and across the face",
    .checked_by = "cases hover, wind_hover; tests Wind.*",
    .traits = {.elements = ElementKind::kFaces, .role = LawRole::kWind},
    .parameters = kWindParameters};

template <class Scalar>
Wind<Scalar>::Wind(const LawSpecification& specification, const ClothMesh& mesh)
    : faces_(law_faces(specification, mesh), mesh.num_nodes(), 2),
      velocity_(law_vector(specification, "velocity").template cast<Scalar>()),
      smallest_normals_(faces_.size()) {
  const double half_density = law_scalar(specification, "air_density") / 2;
  normal_factor_ = Scalar(half_density * law_scalar(specification, "normal_drag"));
  tangential_factor_ = Scalar(half_density * law_scalar(specification, "tangential_drag"));
  for (Eigen::Index f = 0; f < faces_.size(); ++f) {
    const Eigen::Vector3i nodes = faces_.elements().col(f);
    const Vector3<double> first = mesh.rest_positions.col(nodes[0]);
    const Vector3<double> second = mesh.rest_positions.col(nodes[1]);
    const Vector3<double> third = mesh.rest_positions.col(nodes[2]);
    const double smallest = kMinAreaRatio * (second - first).cross(third - first).norm();
    smallest_normals_[f] = Scalar(smallest * smallest);
  }
}

template <class Scalar>
template <class Number>
Vector3<Number> Wind<Scalar>::face_force(Eigen::Index f,
                                         const ElementState<Number, 3>& face) const {
  using std::sqrt;
  Vector3<Number> none = Vector3<Number>::Constant(Number(Scalar(0)));
  const Vector3<Number> edge1 = face.x[1] - face.x[0];
  const Vector3<Number> edge2 = face.x[2] - face.x[0];
  const Vector3<Number> normal = edge1.cross(edge2);  // twice the area vector
  const Number squared_normal = normal.squaredNorm();
  if (!(squared_normal > Number(smallest_normals_[f]))) return none;

  const Vector3<Number> wind = velocity_.template cast<Number>() -
                               (face.v[0] + face.v[1] + face.v[2]) * Number(Scalar(1.0 / 3.0));
  const Number across = wind.dot(normal) / squared_normal;  // w = across * normal + w_t
  const Number length = sqrt(squared_normal);
  const Number size = across < Number(Scalar(0)) ? Number(-across) : across;
  const Number half(Scalar(0.5));
  // |w.n| (w.n) A n, with n = normal / length, w.n = across * length and A = length / 2
  Vector3<Number> force =
      normal * Number(Number(normal_factor_) * half * size * across * squared_normal);
  const Vector3<Number> along = wind - normal * across;
  const Number squared_along = along.squaredNorm();
  // At 0 the drag along the face and its derivative vanish, but the derivative of the root does not.
  if (tangential_factor_ > Scalar(0) && squared_along > Number(Scalar(0))) {
    const Number speed = sqrt(squared_along);
    force += along * Number(Number(tangential_factor_) * half * length * speed);
  }
  return force;
}

template <class Scalar>
template <class Number>
void Wind<Scalar>::add_face(Eigen::Index f, const ElementState<Number, 3>& face,
                            ElementForces<Number, 3>& parts) const {
  const Vector3<Number> third = face_force(f, face) * Number(Scalar(1.0 / 3.0));
  for (Vector3<Number>& part : parts) part = third;
}

template <class Scalar>
void Wind<Scalar>::add_forces(const State<Scalar>& state, Matrix3XRef<Scalar> scratch,
                              Matrix3XRef<Scalar> forces) const {
  faces_.add_forces(
      state,
      [this](Eigen::Index f, const auto& face, auto& parts) { this->add_face(f, face, parts); },
      scratch, forces);
}

template <class Scalar>
void Wind<Scalar>::add_stiffness_product(const State<Scalar>& state,
                                         ConstMatrix3XRef<Scalar> displacements,
                                         Matrix3XRef<Scalar> scratch,
                                         Matrix3XRef<Scalar> product) const {
  faces_.add_stiffness_product(
      state,
      [this](Eigen::Index f, const auto& face, auto& parts) { this->add_face(f, face, parts); },
      displacements, scratch, product);
}

template <class Scalar>
void Wind<Scalar>::add_damping_product(const State<Scalar>& state,
                                       ConstMatrix3XRef<Scalar> velocity_changes,
                                       Matrix3XRef<Scalar> scratch,
                                       Matrix3XRef<Scalar> product) const {
  faces_.add_damping_product(
      state,
      [this](Eigen::Index f, const auto& face, auto& parts) { this->add_face(f, face, parts); },
      velocity_changes, scratch, product);
}

template <class Scalar>
Scalar Wind<Scalar>::non_conservative_power(const State<Scalar>& state) const {
  return faces_.sum(state, [this](Eigen::Index f, const auto& face) -> Scalar {
    const Vector3<Scalar> speed = (face.v[0] + face.v[1] + face.v[2]) * Scalar(1.0 / 3.0);
    return this->face_force(f, face).dot(speed);
  });
}

WEFT_INSTANTIATE_LAW(Wind);

}  // namespace weft::forces
