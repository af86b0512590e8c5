#include <weft/custom_forces/laws/damping/torsional_rotation_damping.hpp>

#include <gtest/gtest.h>
#include <weft/custom_forces/law_set.hpp>

#include "tests/custom_forces/small_bodies.hpp"

namespace weft::forces {
namespace {

constexpr double kTorsionalRotationDampingRate = 0.8;  // [1/s]
constexpr double kTimeStep = 0.3;                      // [s]
const LawSpecification kTorsionalRotationDampingLaw{
    .law = "torsional_rotation_damping",
    .sets = {},
    .parameters = {{"rate", {kTorsionalRotationDampingRate}}}};

/// Sums of 7 terms of size 10, divided by 3 x 3 matrices of condition 10: round-off.
constexpr double kTorsionalRotationDampingSumRoundoff = 100 * kRoundoff;

/// Pi v: the force of a law of rate 1, without masses.
Matrix3X<double> swirl(const ClothMesh& mesh, const Matrix3X<double>& velocities) {
  const LawSpecification unit{kTorsionalRotationDampingLaw.law, {}, {{"rate", {1.0}}}};
  return -forces_on(unit, mesh, mesh.rest_positions, velocities) *
         mesh.masses.cwiseInverse().asDiagonal();
}

/// v_i = c_i r_i / |r_i| about the centre of mass, c_i arbitrary.
Matrix3X<double> radial_motion(const ClothMesh& mesh) {
  Matrix3X<double> velocities = mesh.rest_positions.colwise() - center_of_mass(mesh);
  velocities.colwise().normalize();
  return velocities * arbitrary(mesh.num_nodes(), 8).row(0).asDiagonal();
}

/// Rings of 6 nodes with radius 1 m (1 kg each) and 2 m (0.5 kg each), and a node of 3 kg in their
/// centre.
ClothMesh two_rings() {
  Matrix3X<double> positions = Matrix3X<double>::Zero(3, 13);
  VectorX<double> masses = VectorX<double>::Constant(13, 3.0);
  const double pi = std::acos(-1.0);
  for (int i = 0; i < 6; ++i) {
    const Vector3<double> e(std::cos(pi / 3 * i), std::sin(pi / 3 * i), 0);
    positions.col(i) = e;
    positions.col(6 + i) = 2 * e;
    masses[i] = 1.0;
    masses[6 + i] = 0.5;
  }
  ClothMesh mesh = small_mesh(positions, Edges(2, 0));
  mesh.masses = masses;
  return mesh;
}

TEST(TorsionalRotationDamping, SwirlIsAProjection) {
  const ClothMesh mesh = lopsided_body();
  const Matrix3X<double> once = swirl(mesh, arbitrary(7, 1));
  EXPECT_GT(once.norm(), 0.1);
  EXPECT_LT((swirl(mesh, once) - once).norm(), kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, TheProjectionIsOrthogonalInTheMasses) {
  const ClothMesh mesh = lopsided_body();
  const Matrix3X<double> a = arbitrary(7, 1);
  const Matrix3X<double> b = arbitrary(7, 2);
  const auto product = [&](const Matrix3X<double>& u, const Matrix3X<double>& v) {
    return u.cwiseProduct(v * mesh.masses.asDiagonal()).sum();
  };
  EXPECT_NEAR(product(a, swirl(mesh, b)), product(b, swirl(mesh, a)),
              kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, RigidAndRadialMotionIsAllThatIsLeftOut) {
  const ClothMesh mesh = lopsided_body();
  EXPECT_LT(swirl(mesh, rigid_motion(mesh, {1, -2, 0.5}, {3, 1, -1})).norm(),
            kTorsionalRotationDampingSumRoundoff);
  EXPECT_LT(swirl(mesh, radial_motion(mesh)).norm(), kTorsionalRotationDampingSumRoundoff);
  // The trace of a projection is the dimension of what it keeps: 3 n without n radial motions, 3
  // translations and 3 rotations.
  double trace = 0.0;
  for (Eigen::Index i = 0; i < 21; ++i) {
    Matrix3X<double> unit = Matrix3X<double>::Zero(3, 7);
    unit.data()[i] = 1.0;
    trace += swirl(mesh, unit).data()[i];
  }
  EXPECT_NEAR(trace, 2 * 7 - 6, kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, MomentaStay) {
  const ClothMesh mesh = lopsided_body();
  const Matrix3X<double> before = arbitrary(7, 1);
  const Matrix3X<double> after = advanced(kTorsionalRotationDampingLaw, mesh, before, kTimeStep);
  EXPECT_GT((after - before).norm(), 0.1);
  EXPECT_LT((momentum(mesh, after) - momentum(mesh, before)).norm(),
            kTorsionalRotationDampingSumRoundoff);
  EXPECT_LT((spin_momentum(mesh, after) - spin_momentum(mesh, before)).norm(),
            kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, CentreAgainstRimDecaysAtTheRate) {
  const ClothMesh mesh = two_rings();
  // Per node m r v: 1 * 1 * 1 against 0.5 * 2 * 1.
  Matrix3X<double> mode = rigid_motion(mesh, {0, 0, 1}, {0, 0, 0});
  mode.middleCols(6, 6) *= -0.5;
  const Matrix3X<double> rest = rigid_motion(mesh, {0.2, 0.1, -1}, {1, 2, 3});
  const Matrix3X<double> after =
      advanced(kTorsionalRotationDampingLaw, mesh, rest + mode, kTimeStep);
  EXPECT_LT((after - rest - std::exp(-kTorsionalRotationDampingRate * kTimeStep) * mode).norm(),
            kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, AndRotationDampingMindEachOthersWork) {
  // In a set each law goes on with the velocities that the one before it left. The two parts are
  // orthogonal, so the order does not matter.
  const ClothMesh mesh = lopsided_body();
  const LawSpecification rotation{"rotation_damping", {}, {{"rate", {2.0}}}};
  const Matrix3X<double> before = arbitrary(7, 1);
  LawSet<double> laws;
  laws.add(make_law<double>(kTorsionalRotationDampingLaw, mesh));
  laws.add(make_law<double>(rotation, mesh));
  Matrix3X<double> together = before;
  laws.advance_velocities({mesh.rest_positions, before, mesh.masses}, kTimeStep, together);
  const Matrix3X<double> one_way = advanced(
      rotation, mesh, advanced(kTorsionalRotationDampingLaw, mesh, before, kTimeStep), kTimeStep);
  const Matrix3X<double> other_way = advanced(
      kTorsionalRotationDampingLaw, mesh, advanced(rotation, mesh, before, kTimeStep), kTimeStep);
  EXPECT_EQ(together, one_way);
  EXPECT_LT((one_way - other_way).norm(), kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, ABreathingBodyBreathesOn) {
  const ClothMesh mesh = two_rings();
  const Matrix3X<double> breath = 0.3 * mesh.rest_positions;
  EXPECT_LT((advanced(kTorsionalRotationDampingLaw, mesh, breath, kTimeStep) - breath).norm(),
            kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, OnALineItIsTheBendingMotion) {
  Matrix3X<double> positions = Matrix3X<double>::Zero(3, 3);
  positions.row(0) << -1, 0, 1;
  const ClothMesh mesh = small_mesh(positions, Edges(2, 0));
  Matrix3X<double> bending = Matrix3X<double>::Zero(3, 3);
  bending.row(2) << 1, -2, 1;
  Matrix3X<double> rest = rigid_motion(mesh, {0, 2, 1}, {1, 1, 1});
  rest(0, 2) += 0.7;  // along the line
  const Matrix3X<double> after =
      advanced(kTorsionalRotationDampingLaw, mesh, rest + bending, kTimeStep);
  EXPECT_LT((after - rest - std::exp(-kTorsionalRotationDampingRate * kTimeStep) * bending).norm(),
            kTorsionalRotationDampingSumRoundoff);
}

TEST(TorsionalRotationDamping, ADumbbellFeelsNothing) {
  const ClothMesh mesh = one_spring(2.0);
  const Matrix3X<double> before = arbitrary(2, 5);
  EXPECT_LT((advanced(kTorsionalRotationDampingLaw, mesh, before, kTimeStep) - before).norm(),
            kTorsionalRotationDampingSumRoundoff);
}

}  // namespace
}  // namespace weft::forces
