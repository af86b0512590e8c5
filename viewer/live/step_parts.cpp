#include <weft/viewer/live/step_parts.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <weft/custom_forces/registry.hpp>
#include <weft/custom_forces/spectrum.hpp>
#include <weft/scenes/engine_kind.hpp>

namespace weft::viewer {
namespace {

/// Part of the critical step that is used [-]: springs stiffen and winds freshen until the next estimate.
constexpr double kSafety = 0.6;
/// Steps between two estimates.
constexpr int kEstimateInterval = 10;
/// Power iterations of an estimate. forces::spectrum() iterates to eight digits, which takes seconds for
/// a large cloth; here the vectors are kept, so that later estimates need few.
constexpr int kFirstIterations = 24;
constexpr int kLaterIterations = 4;

const scenes::EngineKind& kind_of(std::string_view engine) {
  return *scenes::find_engine_kind(engine);
}

/// Laws that an implicit engine solves for.
bool is_implicit_law(const forces::LawSpecification& law) {
  const forces::LawRole role = forces::role_of(law.law);
  return role == forces::LawRole::kSpring || role == forces::LawRole::kSpringDamper ||
         role == forces::LawRole::kBending;
}

bool is_simulated(const scenes::Cloth& cloth) {
  const auto* skin = std::get_if<scenes::SkinSource>(&cloth.source);
  return skin == nullptr || skin->is_cloth;
}

/// Without a symmetry, so that it has a part of every stiff mode.
Matrix3X<double> start_vector(Eigen::Index num_nodes) {
  Matrix3X<double> vector(3, num_nodes);
  for (Eigen::Index i = 0; i < num_nodes; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      vector(axis, i) = std::sin(2.5 * static_cast<double>(i) + 1.3 * axis);
    }
  }
  return vector;
}

/// Power iteration on M^-1 times the matrix that product() applies: its largest eigenvalue, from below.
template <class Product>
double largest_eigenvalue(const Product& product, const VectorX<double>& inverse_masses,
                          Matrix3X<double>& vector) {
  const bool is_first = vector.cols() == 0;
  if (is_first) vector = start_vector(inverse_masses.size());
  double eigenvalue = 0.0;
  Matrix3X<double> image(3, vector.cols());
  for (int i = 0; i < (is_first ? kFirstIterations : kLaterIterations); ++i) {
    image.setZero();
    product(vector, image);
    image = (image * inverse_masses.asDiagonal()).eval();
    eigenvalue = image.norm() / vector.norm();
    if (!std::isfinite(eigenvalue) || eigenvalue == 0.0) {
      vector.resize(3, 0);  // starts anew next time
      return 0.0;
    }
    vector = image / image.norm();
  }
  return eigenvalue;
}

}  // namespace

StepParts::StepParts(std::string_view engine)
    : can_divide_(!kind_of(engine).has_links && !kind_of(engine).is_deformable),
      springs_are_implicit_(kind_of(engine).is_implicit) {}

void StepParts::set_laws(const scenes::Scene& scene) {
  bodies_.clear();
  steps_since_estimate_ = kEstimateInterval;
  for (const scenes::Cloth& cloth : scene.cloths) {
    const ClothMesh mesh = scenes::make_mesh(cloth);
    Body& body = bodies_.emplace_back();
    body.masses = mesh.masses;
    body.inverse_masses = mesh.masses.cwiseInverse();
    for (const int node : mesh.pinned) body.inverse_masses[node] = 0.0;
    if (!is_simulated(cloth)) continue;
    for (const forces::LawSpecification& law : cloth.laws) {
      // Dampers of velocities act exactly, and added inertia only lengthens the step.
      if (forces::find_law(law.law)->traits.level != forces::LawTraits::Level::kForce) continue;
      if (springs_are_implicit_ && is_implicit_law(law)) continue;
      body.laws.add(forces::make_law<double>(law, mesh));
    }
  }
}

double StepParts::critical_step(const scenes::SceneState& state) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < bodies_.size(); ++c) {
    Body& body = bodies_[c];
    const scenes::ClothState& cloth = state.cloths[c];
    if (body.laws.empty() || cloth.positions.cols() != body.masses.size()) continue;
    if (!cloth.positions.allFinite() || !cloth.velocities.allFinite()) continue;
    const forces::State<double> now{cloth.positions, cloth.velocities, body.masses, state.time};
    forces::Spectrum spectrum;
    spectrum.omega_max = std::sqrt(largest_eigenvalue(
        [&](const Matrix3X<double>& v, Matrix3X<double>& image) {
          body.laws.add_stiffness_product(now, v, image);
        },
        body.inverse_masses, body.stiffest));
    spectrum.gamma_force_max = largest_eigenvalue(
        [&](const Matrix3X<double>& v, Matrix3X<double>& image) {
          body.laws.add_damping_product(now, v, image);
        },
        body.inverse_masses, body.dampest);
    least = std::min(least, forces::critical_time_step(spectrum));
  }
  return least;
}

int StepParts::count(const scenes::SceneState& state, double time_step) {
  if (!can_divide_ || bodies_.empty()) return 1;
  if (++steps_since_estimate_ > kEstimateInterval) {
    critical_step_ = critical_step(state);
    steps_since_estimate_ = 0;
  }
  const double parts = std::ceil(time_step / (kSafety * critical_step_));
  return static_cast<int>(std::clamp(parts, 1.0, static_cast<double>(kMaxParts)));
}

}  // namespace weft::viewer
