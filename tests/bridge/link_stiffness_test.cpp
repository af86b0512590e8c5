#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <weft/bridge/link_stiffness.hpp>
#include <weft/bridge/soft_world.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
namespace {

constexpr double kMass = 0.02;                  // [kg]
constexpr double kRestLength = 0.5;             // [m]
constexpr double kLinkStiffnessGravity = 9.81;  // [m/s^2]
constexpr double kLinkStiffnessTimeStep =
    1.0 / 128;  // [s] exact in single precision, so that Bullet's rounding plays no part

/// One node hangs from a pinned one on one Bullet link; extension [m] once it rests.
double extension_at_rest(double link_factor, int iterations, double pin_inverse_mass = 0.0) {
  SoftWorld world({});
  const btVector3 positions[2] = {btVector3(0, 0, 0), btVector3(0, btScalar(-kRestLength), 0)};
  const btScalar masses[2] = {btScalar(pin_inverse_mass), btScalar(kMass)};
  auto owned = std::make_unique<btSoftBody>(&world.info(), 2, positions, masses);
  btSoftBody::Material* material = owned->appendMaterial();
  material->m_kLST = static_cast<btScalar>(link_factor);
  owned->appendLink(0, 1, material);
  owned->m_cfg.piterations = iterations;
  owned->updateConstants();
  owned->m_bUpdateRtCst = false;
  btSoftBody& body = world.add(std::move(owned));
  world.info().m_gravity.setValue(0, btScalar(-kLinkStiffnessGravity), 0);
  for (int step = 0; step < 20000; ++step) world.step(kLinkStiffnessTimeStep);
  return -static_cast<double>(body.m_nodes[1].m_x.y()) - kRestLength;
}

/// Relative error of the extension that Bullet's approximation of the length makes. With r = k h^2
/// / mu a visit finds the strain e* = (1 + r) e of the predicted position and removes (1 + e* / 2)
/// of its share; at rest that shortens the extension by e* (1 + r) / 2. Twice that leaves room for
/// the next order.
double length_approximation_bound(double stiffness) {
  const double magnified = 1 + stiffness * kLinkStiffnessTimeStep * kLinkStiffnessTimeStep / kMass;
  return kMass * kLinkStiffnessGravity / stiffness / kRestLength * magnified * magnified;
}

TEST(LinkStiffness, MapIsItsOwnInverse) {
  // expm1 and log1p are good to an ulp or two; their chain of four calls stays within a dozen.
  const double tolerance = 32 * std::numeric_limits<double>::epsilon();
  for (const double stiffness : {1e-3, 0.5, 40.0, 3000.0}) {
    for (const int iterations : {1, 4, 20, 100}) {
      const LinkContext context{kMass, iterations, kLinkStiffnessTimeStep};
      const double factor = link_factor_from_stiffness(stiffness, context);
      EXPECT_GT(factor, 0.0);
      EXPECT_LE(factor, 1.0);
      EXPECT_NEAR(
          stiffness_from_link_factor(factor, context) / stiffness, 1.0,
          tolerance * (1 + stiffness * kLinkStiffnessTimeStep * kLinkStiffnessTimeStep / kMass));
    }
  }
}

TEST(LinkStiffness, HangingWeightStretchesOneBulletLinkByForceOverStiffness) {
  for (const double stiffness : {20.0, 100.0, 400.0}) {
    for (const int iterations : {1, 5, 20}) {
      const double expected = kMass * kLinkStiffnessGravity / stiffness;
      const double factor =
          link_factor_from_stiffness(stiffness, {kMass, iterations, kLinkStiffnessTimeStep});
      const double measured = extension_at_rest(factor, iterations);
      const double model = length_approximation_bound(stiffness);
      // Round-off of the position (0.5 m) as seen by the extension, over the steps in which it can
      // build up.
      const double roundoff =
          64 * std::numeric_limits<btScalar>::epsilon() * kRestLength / expected;
      EXPECT_NEAR(measured / expected, 1.0, model + roundoff)
          << "k = " << stiffness << " N/m, " << iterations << " iterations";
    }
  }
}

TEST(LinkStiffness, OnePercentMoreStiffnessIsNoticed) {
  const int iterations = 5;
  const double stiffness = 400.0;
  const double model = length_approximation_bound(stiffness);
  const double factor =
      link_factor_from_stiffness(1.01 * stiffness, {kMass, iterations, kLinkStiffnessTimeStep});
  const double measured = extension_at_rest(factor, iterations);
  EXPECT_GT(std::abs(measured / (kMass * kLinkStiffnessGravity / stiffness) - 1.0), model);
}

TEST(LinkStiffness, ValuesOutOfTheirDomainAreRefused) {
  const LinkContext good{kMass, 4, kLinkStiffnessTimeStep};
  EXPECT_THROW((void)link_factor_from_stiffness(-1, good), InvalidArgument);
  EXPECT_THROW((void)link_factor_from_stiffness(std::nan(""), good), InvalidArgument);
  EXPECT_THROW((void)stiffness_from_link_factor(1.0, good), InvalidArgument);
  EXPECT_THROW((void)stiffness_from_link_factor(-0.1, good), InvalidArgument);
  EXPECT_THROW((void)link_factor_from_stiffness(1, {0, 4, kLinkStiffnessTimeStep}),
               InvalidArgument);
  EXPECT_THROW((void)link_factor_from_stiffness(1, {kMass, 0, kLinkStiffnessTimeStep}),
               InvalidArgument);
  EXPECT_THROW((void)link_factor_from_stiffness(1, {kMass, 4, 0}), InvalidArgument);
}

}  // namespace
}  // namespace weft::bridge
