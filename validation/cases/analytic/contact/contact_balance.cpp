// A cloth falls freely, is carried by what it lies on, and does not pass through it however fast it comes.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/small_systems.hpp>

namespace weft::validation {
namespace contact_balance {
namespace {

constexpr double kGravity = 9.81;    // [m/s^2]
constexpr double kSide = 0.5;        // [m]
constexpr double kMass = 0.05;       // [kg]
constexpr double kMargin = 0.005;    // [m]
constexpr double kStep = 1.0 / 240;  // [s], of the falls
constexpr double kSmallStep = 1e-3;  // [s], of the cloth at rest
constexpr double kHalf = 0.1;        // [m] of the box: thickness / 2
constexpr double kRadius = 0.2;      // [m]

enum class Under { kNothing, kPlane, kBox, kSphere };

struct Fall {
  Under under = Under::kNothing;
  double height = 0.0;      ///< of the cloth above the surface's top [m]
  double speed = 0.0;       ///< downward [m/s]
  double damping = 0.0;     ///< velocity_damping [1/s]
  bool no_contact = false;  ///< sabotage: the collider is out of reach
};

reference::SpringSolver make_fall(const Fall& fall) {
  ClothGrid grid;
  grid.nodes = {11, 11};
  grid.size = {kSide, kSide};
  grid.stencil = GridStencil::k8Neighbour;
  grid.total_mass = kMass;
  grid.center = {0, fall.height + kMargin, 0};
  reference::Body body;
  body.name = "cloth";
  body.mesh = make_cloth_grid(grid);
  for (const forces::LawSpecification& law :
       {tension_law(5.0), gravity_law({0, -kGravity, 0}), velocity_damping_law(fall.damping)}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities = Vector3<double>(0, -fall.speed, 0).replicate(1, body.mesh.num_nodes());
  body.collision_margin = kMargin;
  body.friction = 0.3;
  reference::System system;
  system.bodies.push_back(std::move(body));
  if (fall.under != Under::kNothing && !fall.no_contact) {
    reference::Collider collider;
    collider.name = "under";
    collider.shape = reference::Plane{};
    if (fall.under == Under::kBox) {
      collider.shape = reference::Box{{1, kHalf, 1}};
      collider.position = {0, -kHalf, 0};
    } else if (fall.under == Under::kSphere) {
      collider.shape = reference::Sphere{kRadius};
      collider.position = {0, -kRadius, 0};
    }
    system.colliders.push_back(collider);
  }
  return reference::SpringSolver(std::move(system), {});
}

/// Largest relative error of the way fallen after n steps.
double fall_error(double gravity) {
  reference::SpringSolver solver = make_fall({.height = 1.0});
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) (void)solver.step(kStep);
  const double exact = gravity * kStep * kStep * kSteps * (kSteps + 1) / 2;
  const reference::Body& end = solver.system().bodies[0];
  return ((end.mesh.rest_positions.row(1) - end.positions.row(1)).array() / exact - 1)
      .abs()
      .maxCoeff();
}

/// |sum of normal impulses / h - weight| / weight at rest. On a sphere the normals differ: only the plane and
/// the box carry the weight with their normal forces alone.
double carried_error(Under under, bool no_contact) {
  reference::SpringSolver solver =
      make_fall({.under = under, .height = 0.02, .damping = 20.0, .no_contact = no_contact});
  constexpr int kSteps = 2000;
  double impulse = 0;
  for (int i = 0; i < kSteps; ++i) impulse = solver.step(kSmallStep).contact.normal_impulse;
  return std::abs(impulse / (kSmallStep * kMass * kGravity) - 1);
}

/// Depth of a node's centre below the surface grown by the margin [m]; written apart from the solver's.
double depth(Under under, const Vector3<double>& x) {
  if (under == Under::kSphere) {
    return kRadius + kMargin - (x - Vector3<double>(0, -kRadius, 0)).norm();
  }
  const bool is_beside = under == Under::kBox && std::max(std::abs(x.x()), std::abs(x.z())) > 1;
  return is_beside ? 0.0 : kMargin - x.y();
}

/// Deepest node at the end of any step over all speeds, and how many nodes are below the body at the end.
struct Passage {
  double deepest = 0.0;  ///< [m]
  int passed = 0;
};

Passage throw_down(Under under, bool no_contact) {
  Passage passage;
  for (const double speed : {1.0, 2.0, 5.0, 10.0, 20.0, 40.0}) {
    // A step's way at 40 m/s is 0.17 m: less than the box and the sphere are thick.
    reference::SpringSolver solver =
        make_fall({.under = under, .height = 0.1, .speed = speed, .no_contact = no_contact});
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps; ++i) {
      (void)solver.step(kStep);
      const Matrix3X<double>& x = solver.system().bodies[0].positions;
      for (Eigen::Index node = 0; node < x.cols(); ++node) {
        const Vector3<double> place = x.col(node);
        const double now = depth(under, place);
        // Inside the box or the sphere, or anywhere below a plane.
        const bool is_inside = under == Under::kPlane ||
                               (under == Under::kBox && place.y() > -2 * kHalf - kMargin) ||
                               under == Under::kSphere;
        if (is_inside) passage.deepest = std::max(passage.deepest, now);
        if (i + 1 == kSteps && place.y() < -kHalf / 2) ++passage.passed;
      }
    }
  }
  return passage;
}

const char* name_of(Under under) {
  switch (under) {
    case Under::kPlane:
      return "a plane";
    case Under::kBox:
      return "a box";
    case Under::kSphere:
      return "a sphere";
    case Under::kNothing:
      break;
  }
  return "nothing";
}

}  // namespace
}  // namespace contact_balance

void evaluate_contact_balance(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                              Report& report) {
  using namespace contact_balance;
  CheckResult fall = judged(
      info,
      {"a cloth falls freely as its scheme says",
       "largest relative error of the way, 100 steps",
       "g h^2 n (n + 1) / 2",
       "recurrence of modified Euler",
       {1e-13, Basis::kRoundoff, "100 steps, each with a rounding of a place of 1 m by 1e-16"},
       "gravity, or an order of operations"},
      fall_error(kGravity));
  add_sabotage(fall, "the continuum's g t^2 / 2", fall_error(kGravity * 100 / 101));
  report.checks.push_back(std::move(fall));
  for (const Under under : {Under::kPlane, Under::kBox}) {
    CheckResult carried =
        judged(info,
               {fmt::format("{} carries the weight of the cloth on it", name_of(under)),
                "|normal impulses of a step / h - weight| / weight, after 2 s",
                "sum of N = m g",
                "balance of forces",
                {1e-11, Basis::kTruncation, "what exp(-20 t / 1 s) leaves of the motion after 2 s"},
                "an impulse that is not counted, or a cloth that is not at rest"},
               carried_error(under, false));
    add_sabotage(carried, "contact switched off", carried_error(under, true));
    report.checks.push_back(std::move(carried));
  }
  for (const Under under : {Under::kPlane, Under::kBox, Under::kSphere}) {
    const Passage right = throw_down(under, false);
    const Passage wrong = throw_down(under, true);
    CheckResult deepest =
        judged(info,
               {fmt::format("no node ends a step inside {}", name_of(under)),
                "deepest node at 1, 2, 5, 10, 20 and 40 m/s",
                "0",
                "exact signed distance",
                {1e-15, Basis::kRoundoff, "rounding of a distance of up to 0.2 m"},
                "a contact that is missed or not solved to its end"},
               right.deepest);
    deepest.unit = "m";
    add_sabotage(deepest, "contact switched off", wrong.deepest);
    report.checks.push_back(std::move(deepest));
    // Round a sphere the cloth may close.
    if (under == Under::kSphere) continue;
    CheckResult passed = judged(info,
                                {fmt::format("no node passes through {}", name_of(under)),
                                 "nodes below it at 1, 2, 5, 10, 20 and 40 m/s",
                                 "0",
                                 "a step's way is less than its thickness",
                                 {0, Basis::kExact, "a count"},
                                 "a contact that is missed"},
                                right.passed);
    add_sabotage(passed, "contact switched off", wrong.passed);
    report.checks.push_back(std::move(passed));
  }
}

}  // namespace weft::validation
