// What sheet a lattice of springs is: its moduli in every direction, as patches that are stretched at their rim.
// Tested by tests/validation/cases/support/parameters_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/reference/statics/static_solver.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>
#include <weft/validation/cases/support/closed_form_check.hpp>
#include <weft/validation/cases/support/parameters.hpp>

namespace weft::validation {
namespace lattice_moduli {
namespace {

using Strain = Eigen::Vector3d;  ///< e11, e22, 2 e12
using Moduli = Eigen::Matrix3d;  ///< C of energy per area e . C e / 2 [N/m]

constexpr double kSpacing = 0.02;  // a [m]

/// A patch of cells x cells square cells with both diagonals.
struct Patch {
  int cells = 10;
  double leg = 100.0;      ///< k1 [N/m]
  double diagonal = 50.0;  ///< k2 [N/m]
  double jitter = 0.0;     ///< of inner nodes, in spacings
  bool full_rim = false;   ///< sabotage: springs of the rim count as a whole cell's
};

double noise(double i, double j) {
  const double value = std::sin(12.9898 * i + 78.233 * j) * 43758.5453;
  return 2 * (value - std::floor(value)) - 1;
}

reference::Body make_patch(const Patch& patch) {
  reference::Body body;
  body.name = "patch";
  const int side = patch.cells + 1;
  ClothMesh& mesh = body.mesh;
  mesh.rest_positions = Matrix3X<double>::Zero(3, side * side);
  mesh.masses = VectorX<double>::Ones(side * side);
  mesh.triangles.resize(3, 0);
  std::vector<Eigen::Vector2i> inner;
  std::vector<Eigen::Vector2i> rim;
  std::vector<Eigen::Vector2i> diagonals;
  const auto is_rim = [&](int i) { return i == 0 || i == patch.cells; };
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const int node = j * side + i;
      mesh.rest_positions.col(node) << i * kSpacing, j * kSpacing, 0;
      if (is_rim(i) || is_rim(j)) {
        mesh.pinned.push_back(node);
      } else {
        mesh.rest_positions(0, node) += patch.jitter * kSpacing * noise(i, j);
        mesh.rest_positions(1, node) += patch.jitter * kSpacing * noise(j + 100, i);
      }
      if (i < patch.cells) (is_rim(j) ? rim : inner).emplace_back(node, node + 1);
      if (j < patch.cells) (is_rim(i) ? rim : inner).emplace_back(node, node + side);
      if (i < patch.cells && j < patch.cells) {
        diagonals.emplace_back(node, node + side + 1);
        diagonals.emplace_back(node + 1, node + side);
      }
    }
  }
  const auto add = [&](const char* name, const std::vector<Eigen::Vector2i>& list, double k) {
    Edges edges(2, static_cast<Eigen::Index>(list.size()));
    for (std::size_t e = 0; e < list.size(); ++e) edges.col(static_cast<Eigen::Index>(e)) = list[e];
    mesh.edge_sets.push_back({name, edges});
    return forces::LawSpecification{"tension", {name}, {{"stiffness", {k}}}};
  };
  const std::array laws = {add("inner", inner, patch.leg),
                           add("rim", rim, patch.full_rim ? patch.leg : patch.leg / 2),
                           add("diagonals", diagonals, patch.diagonal)};
  for (const auto& law : laws) body.laws.add(forces::make_law<double>(law, mesh));
  return body;
}

Matrix3X<double> affine(const ClothMesh& mesh, const Strain& strain) {
  Matrix3<double> gradient = Matrix3<double>::Zero();
  gradient << strain[0], strain[2] / 2, 0, strain[2] / 2, strain[1], 0, 0, 0, 0;
  return gradient * mesh.rest_positions;
}

struct PatchTest {
  Moduli moduli = Moduli::Zero();
  double unbalance = 0.0;  ///< largest force on an inner node over k1 a, at affine displacement [-]
};

/// Linear response of the patch to three displacements of its rim; inner nodes find their equilibrium.
PatchTest test_patch(const Patch& patch) {
  reference::Body body = make_patch(patch);
  reference::StaticProblem problem = reference::static_problem(body, 1.0);
  const Matrix3X<double>& rest = body.mesh.rest_positions;
  const auto product = [&body, stiffness = problem.stiffness_product](const Matrix3X<double>& u) {
    Matrix3X<double> force(3, u.cols());
    stiffness(body.mesh.rest_positions, u, force);
    return force;
  };
  // Springs of a flat sheet hold nothing across it: a stiffness there keeps the matrix regular.
  const auto with_plane = [&](const Matrix3X<double>& u) {
    Matrix3X<double> force = product(u);
    force.row(2) -= patch.leg * u.row(2);
    return force;
  };
  problem.forces = [&](const Matrix3X<double>& u, Matrix3X<double>& f) { f = with_plane(u); };
  problem.stiffness_product = [&](const Matrix3X<double>&, const Matrix3X<double>& u,
                                  Matrix3X<double>& f) { f = with_plane(u); };
  problem.load = patch.leg * kSpacing;
  PatchTest result;
  std::array<Matrix3X<double>, 3> moved;
  for (int c = 0; c < 3; ++c) {
    Matrix3X<double>& u = moved[static_cast<std::size_t>(c)];
    u = affine(body.mesh, Strain::Unit(c));
    const Matrix3X<double> force = product(u);
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      if (problem.fixed[static_cast<std::size_t>(node)]) continue;
      result.unbalance = std::max(result.unbalance, force.col(node).norm() / problem.load);
    }
    reference::StaticOptions options;
    options.residual = 1e-13 * patch.cells;
    options.max_move = rest.cwiseAbs().maxCoeff();
    (void)reference::solve_statics(problem, u, options);
  }
  const double area = std::pow(patch.cells * kSpacing, 2);
  for (int a = 0; a < 3; ++a) {
    const Matrix3X<double> force = product(moved[static_cast<std::size_t>(a)]);
    for (int b = 0; b < 3; ++b) {
      result.moduli(a, b) = -force.cwiseProduct(moved[static_cast<std::size_t>(b)]).sum() / area;
    }
  }
  return result;
}

/// Modulus along a direction: stress over strain where nothing pulls across.
double along(const Moduli& moduli, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const Strain stress(c * c, s * s, c * s);
  return 1 / stress.dot(moduli.inverse() * stress);
}

Moduli square_lattice(const Patch& patch) {
  Moduli moduli = Moduli::Zero();
  moduli(0, 0) = moduli(1, 1) = patch.leg + patch.diagonal;
  moduli(0, 1) = moduli(1, 0) = moduli(2, 2) = patch.diagonal;
  return moduli;
}

double largest_error(const Moduli& measured, const Patch& patch) {
  const Moduli exact = square_lattice(patch);
  double largest = (measured - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  for (int degrees = 0; degrees <= 90; degrees += 15) {
    const double error = std::abs(along(measured, degrees) / along(exact, degrees) - 1);
    if (!(error <= largest)) largest = error;
  }
  return largest;
}

void add_regular_checks(const CaseInfo& info, const Patch& patch, Report& report) {
  const std::string what = fmt::format("k1 = {} N/m, k2 = {} N/m, {} x {} cells", patch.leg,
                                       patch.diagonal, patch.cells, patch.cells);
  Patch full_rim = patch;
  full_rim.full_rim = true;
  CheckResult moduli =
      judged(info,
             {"a square lattice has the moduli of its springs, " + what,
              "largest relative error of C and of the moduli along 0, 15, ... 90 degrees",
              "C11 = k1 + k2, C12 = C66 = k2; 1 / E45 = (2 / (k1 + 2 k2) + 1 / k2) / 4",
              "energy of an affine displacement; springs of the rim belong to half a cell",
              {1e-14 * std::max(patch.leg / patch.diagonal, patch.diagonal / patch.leg),
               Basis::kRoundoff, "a linear system of some hundred springs"},
              "the tension law's stiffness, or the rim",
              "reference statics"},
             largest_error(test_patch(patch).moduli, patch));
  add_sabotage(moduli, "rim of whole springs", largest_error(test_patch(full_rim).moduli, patch));
  report.checks.push_back(std::move(moduli));
  Patch moved = patch;
  moved.jitter = 1e-6;
  CheckResult balance = judged(info,
                               {"a uniform strain leaves every inner node in balance, " + what,
                                "largest force on an inner node over k1 a, unit strains",
                                "0",
                                "patch test",
                                {1e-13 * std::max(1.0, patch.diagonal / patch.leg),
                                 Basis::kRoundoff, "a sum of eight forces"},
                                "the tension law's stiffness",
                                "reference statics"},
                               test_patch(patch).unbalance);
  add_sabotage(balance, "nodes off by 1e-6 of a spacing", test_patch(moved).unbalance);
  report.checks.push_back(std::move(balance));
}

void add_isotropy_check(const CaseInfo& info, Report& report) {
  const auto spread = [](const Patch& patch) {
    const Moduli measured = test_patch(patch).moduli;
    double largest = 0;
    for (int degrees = 0; degrees <= 90; degrees += 15) {
      largest = std::max(largest, std::abs(along(measured, degrees) / (4.0 / 3 * patch.leg) - 1));
    }
    return largest;
  };
  CheckResult check = judged(info,
                             {"with k1 = 2 k2 the lattice is isotropic",
                              "largest relative error of E = 4 k1 / 3",
                              "E = 4 k1 / 3 in every direction, Poisson's ratio 1 / 3",
                              "C11 - C12 = 2 C66",
                              {1e-14, Basis::kRoundoff, "a linear system of some hundred springs"},
                              "the stiffness of legs or diagonals",
                              "reference statics"},
                             spread({}));
  add_sabotage(check, "k1 = 2.02 k2", spread({.leg = 101}));
  report.checks.push_back(std::move(check));
}

void add_jittered_check(const CaseInfo& info, double jitter, Report& report) {
  const Patch patch{.cells = 20, .jitter = jitter};
  Patch wrong = patch;
  wrong.diagonal *= 1.1;
  CheckResult check = judged(
      info,
      {"an irregular lattice is nearly the same sheet",
       fmt::format("largest relative error of C and of the moduli, nodes off by up to {:.0f} %",
                   100 * jitter),
       "moduli of the regular lattice",
       "energy of the equilibrium under an affine rim",
       {0.05, Basis::kModelGap, "no constant of springs is exact on irregular cells"},
       "the equilibrium of inner nodes",
       "reference statics"},
      largest_error(test_patch(patch).moduli, patch));
  add_sabotage(check, "diagonals 10 % stiffer", largest_error(test_patch(wrong).moduli, patch));
  report.checks.push_back(std::move(check));
}

/// Energy per area of the six springs of a node of the triangular lattice, each shared by two nodes.
Moduli triangular_star(double stiffness, int springs) {
  reference::Body body;
  body.mesh.rest_positions = Matrix3X<double>::Zero(3, springs + 1);
  body.mesh.masses = VectorX<double>::Ones(springs + 1);
  Edges edges(2, springs);
  for (int i = 0; i < springs; ++i) {
    const double angle = i * std::numbers::pi / 3;
    body.mesh.rest_positions.col(i + 1) << kSpacing * std::cos(angle), kSpacing * std::sin(angle),
        0;
    edges.col(i) << 0, i + 1;
  }
  body.mesh.edge_sets.push_back({"star", edges});
  body.laws.add(forces::make_law<double>({"tension", {}, {{"stiffness", {stiffness}}}}, body.mesh));
  const reference::StaticProblem problem = reference::static_problem(body, 1.0);
  const double area = std::sqrt(3.0) / 2 * kSpacing * kSpacing;
  Moduli moduli;
  for (int a = 0; a < 3; ++a) {
    Matrix3X<double> force(3, springs + 1);
    problem.stiffness_product(body.mesh.rest_positions, affine(body.mesh, Strain::Unit(a)), force);
    for (int b = 0; b < 3; ++b) {
      moduli(a, b) = -0.5 * force.cwiseProduct(affine(body.mesh, Strain::Unit(b))).sum() / area;
    }
  }
  return moduli;
}

void add_triangular_check(const CaseInfo& info, Report& report) {
  constexpr double kStiffness = 80.0;  // [N/m]
  const auto error = [](const Moduli& measured) {
    Moduli exact = Moduli::Zero();
    exact(0, 0) = exact(1, 1) = 3;
    exact(0, 1) = exact(1, 0) = exact(2, 2) = 1;
    return (measured / (std::sqrt(3.0) / 4 * kStiffness) - exact).cwiseAbs().maxCoeff();
  };
  CheckResult check = judged(info,
                             {"a triangular lattice is isotropic with E = 2 k / sqrt(3)",
                              "largest error of C over sqrt(3) k / 4",
                              "C11 = 3 sqrt(3) k / 4, C12 = C66 = sqrt(3) k / 4",
                              "Ostoja-Starzewski 2002; energy of an affine displacement",
                              {3e-14, Basis::kRoundoff, "a sum of six springs"},
                              "the tension law's stiffness",
                              "reference statics"},
                             error(triangular_star(kStiffness, 6)));
  add_sabotage(check, "a spring is missing", error(triangular_star(kStiffness, 5)));
  report.checks.push_back(std::move(check));
}

constexpr std::array kParameters = {
    CaseParameter{"leg", "N/m", "stiffness k1 of the legs", 1.0, 1e5, 100.0},
    CaseParameter{"diagonal", "N/m", "stiffness k2 of the diagonals", 0.1, 1e5, 50.0},
    CaseParameter{"cells", "1", "along a side of the patch", 2, 60, 10, true},
};

}  // namespace
}  // namespace lattice_moduli

std::span<const CaseParameter> lattice_moduli_parameters() {
  using namespace lattice_moduli;
  return kParameters;
}

void evaluate_lattice_moduli(const CaseInfo& info, const CaseOptions& options, const EngineRuns&,
                             Report& report) {
  using namespace lattice_moduli;
  if (asks_for_point(options)) {
    add_regular_checks(info,
                       {.cells = static_cast<int>(value_of(info, options, "cells")),
                        .leg = value_of(info, options, "leg"),
                        .diagonal = value_of(info, options, "diagonal")},
                       report);
    return;
  }
  add_regular_checks(info, {}, report);
  add_regular_checks(info, {.cells = 7, .leg = 100, .diagonal = 13}, report);
  add_isotropy_check(info, report);
  add_jittered_check(info, 0.15, report);
  add_triangular_check(info, report);
}

}  // namespace weft::validation
