#include <weft/validation/motion/swing.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <weft/core/error.hpp>
#include <weft/validation/motion/motion_scenes.hpp>

namespace weft::validation {
namespace {

constexpr double kStep = 1.0 / 60;  // [s]

ClothMesh mesh_of() {
  return make_mesh(swinging_sheet(9, 0.5, 1000).cloths[0]);
}

double height_energy(const ClothMesh& mesh, const Matrix3X<double>& places) {
  return 9.81 * mesh.masses.dot(places.row(1).transpose());
}

TEST(Swing, ThePlateKeepsItsEnergyAndItsShape) {
  const ClothMesh mesh = mesh_of();
  const Places fine = rigid_plate(mesh, kStep / 100, 4000);  // 0.67 s
  // Kinetic energy of one hundredth of a step against the height that has been lost.
  const SwingTrack track(mesh, kStep / 100, fine);
  const double kinetic = track.kinetic_energy(3999 * kStep / 100, 4000 * kStep / 100);
  const double lost = height_energy(mesh, fine.front()) -
                      0.5 * (height_energy(mesh, fine[3999]) + height_energy(mesh, fine[4000]));
  EXPECT_NEAR(kinetic / lost, 1.0, 1e-3);
  EXPECT_LT(track.stretch().largest, 1e-12);
}

TEST(Swing, ThePlateTurnsAfterHalfItsPeriod) {
  const ClothMesh mesh = mesh_of();
  const SwingTrack track(mesh, kStep / 10, rigid_plate(mesh, kStep / 10, 1200));
  // From 90 degrees: 1.18034 times the period of small swings, of a plate with masses at nine rows.
  const double axis = mesh.rest_positions.row(2).maxCoeff();
  const VectorX<double> lever = (axis - mesh.rest_positions.row(2).array()).matrix().transpose();
  const double rate = std::sqrt(9.81 * mesh.masses.dot(lever) / mesh.masses.dot(lever.cwiseAbs2()));
  EXPECT_NEAR(track.turning_time(), 1.18034 * M_PI / rate, 1e-3);
}

TEST(Swing, WhatStaysHasNoEnergyAndDoesNotTurn) {
  const ClothMesh mesh = mesh_of();
  const SwingTrack track(mesh, kStep, frozen(mesh, 60));
  EXPECT_EQ(track.kinetic_energy(0, 1), 0.0);
  EXPECT_TRUE(std::isnan(track.turning_time()));
  EXPECT_TRUE(std::isnan(track.kinetic_energy(2, 3)));
}

TEST(Swing, DistancesAreRootMeanSquares) {
  const ClothMesh mesh = mesh_of();
  Places moved = frozen(mesh, 4);
  for (Matrix3X<double>& state : moved) state.row(1).array() += 0.25;
  EXPECT_NEAR(rms_distance(moved, frozen(mesh, 4)), 0.25, 1e-12);
  // From flat to hanging: sqrt(2) times the lever of each node.
  const double axis = mesh.rest_positions.row(2).maxCoeff();
  const double levers = (axis - mesh.rest_positions.row(2).array()).square().mean();
  EXPECT_NEAR(rms_distance(hanging_flat(mesh, 4), frozen(mesh, 4)), std::sqrt(2 * levers), 1e-12);
}

TEST(Swing, RefusesWhatDoesNotFit) {
  const ClothMesh mesh = mesh_of();
  EXPECT_THROW(SwingTrack(mesh, kStep, {mesh.rest_positions}), InvalidArgument);
  EXPECT_THROW(SwingTrack(mesh, kStep, Places(3, Matrix3X<double>::Zero(3, 4))), InvalidArgument);
  EXPECT_THROW((void)rms_distance(frozen(mesh, 2), Places(3, Matrix3X<double>::Zero(3, 4))),
               InvalidArgument);
}

}  // namespace
}  // namespace weft::validation
