// What hinges make of a curved sheet: its energy per area is that of an isotropic plate, for every
// kind of curvature in every direction, and a uniformly curved sheet has no reason to give way.
// Tested by tests/apps/CMakeLists.txt.
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/validation/cases/support/analytic_cases.hpp>

namespace weft::validation {
namespace plate_rigidity {
namespace {

constexpr double kSpacing = 0.01;   // [m]
constexpr double kCurvature = 0.1;  // [1/m]: 1e-3 per cell, so that squares of slopes do not count
constexpr double kRigidity = 1e-5;  // [N m]
constexpr std::array<int, 7> kAngles = {0, 15, 30, 45, 60, 75, 90};  // [deg]

struct Shape {
  const char* name;
  double first;  ///< principal curvatures over kCurvature [-]
  double second;
};
constexpr std::array<Shape, 3> kShapes = {
    {{"cylinder", 1, 0}, {"sphere", 1, 1}, {"saddle", 1, -1}}};

struct Sheet {
  double jitter = 0.0;  ///< of nodes, in cells
  bool cut_one_way = false;
};

/// A square grid of cells x cells; sheets of all sizes share the nodes they have in common.
ClothMesh make_sheet(int cells, const Sheet& sheet) {
  ClothGrid grid;
  grid.nodes = {cells + 1, cells + 1};
  grid.size = {kSpacing * cells, kSpacing * cells};
  grid.center = {kSpacing * cells / 2, kSpacing * cells / 2, 0};
  grid.v_axis = {0, 1, 0};
  grid.stencil = GridStencil::k8Neighbour;
  ClothMesh mesh = make_cloth_grid(grid);
  if (sheet.cut_one_way) mesh.crossed_triangles.resize(3, 0);
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const double i = node % (cells + 1);
    const double j = node / (cells + 1);
    // Without a pattern of the grid's own, and the same for every size.
    const double u = std::sin(12.9898 * i + 78.233 * j) * 43758.5453;
    const double v = std::sin(39.3468 * i + 11.135 * j) * 24634.6345;
    mesh.rest_positions(0, node) += sheet.jitter * kSpacing * (2 * (u - std::floor(u)) - 1);
    mesh.rest_positions(1, node) += sheet.jitter * kSpacing * (2 * (v - std::floor(v)) - 1);
  }
  return mesh;
}

Matrix3X<double> curved(const ClothMesh& mesh, const Shape& shape, int angle) {
  const double turn = angle * std::numbers::pi / 180;
  Matrix3X<double> positions = mesh.rest_positions;
  const Vector3<double> middle = positions.rowwise().mean();
  for (Eigen::Index node = 0; node < positions.cols(); ++node) {
    const double x = positions(0, node) - middle[0];
    const double y = positions(1, node) - middle[1];
    const double along = std::cos(turn) * x + std::sin(turn) * y;
    const double across = -std::sin(turn) * x + std::cos(turn) * y;
    positions(2, node) =
        kCurvature / 2 * (shape.first * along * along + shape.second * across * across);
  }
  return positions;
}

double energy(int cells, const Sheet& sheet, const Shape& shape, int angle) {
  const ClothMesh mesh = make_sheet(cells, sheet);
  const auto law =
      forces::make_law<double>({"hinge_torsion", {}, {{"rigidity", {kRigidity}}}}, mesh);
  const Matrix3X<double> positions = curved(mesh, shape, angle);
  const Matrix3X<double> still = Matrix3X<double>::Zero(3, mesh.num_nodes());
  return law->potential_energy({positions, still, mesh.masses});
}

/// Energy of an inner cell over that of a cell of plate: sides and corners cancel in the second
/// difference over sizes.
double rigidity_ratio(const Sheet& sheet, const Shape& shape, int angle) {
  constexpr int kCells = 12;
  const double second_difference = energy(3 * kCells, sheet, shape, angle) -
                                   2 * energy(2 * kCells, sheet, shape, angle) +
                                   energy(kCells, sheet, shape, angle);
  const double per_cell = second_difference / (2.0 * kCells * kCells);
  const double squared = shape.first * shape.first + shape.second * shape.second;
  return per_cell / (kRigidity / 2 * squared * kCurvature * kCurvature * kSpacing * kSpacing);
}

double largest_error(const Sheet& sheet) {
  double largest = 0.0;
  for (const Shape& shape : kShapes) {
    for (const int angle : kAngles) {
      const double error = std::abs(rigidity_ratio(sheet, shape, angle) - 1);
      if (!(error <= largest)) largest = error;
    }
  }
  return largest;
}

/// Largest force on an inner node of a cylinder, in units of moment per width: D kappa.
double largest_inner_force(const Sheet& sheet) {
  constexpr int kCells = 12;
  const ClothMesh mesh = make_sheet(kCells, sheet);
  const auto law =
      forces::make_law<double>({"hinge_torsion", {}, {{"rigidity", {kRigidity}}}}, mesh);
  double largest = 0.0;
  for (const int angle : kAngles) {
    const Matrix3X<double> positions = curved(mesh, kShapes[0], angle);
    const Matrix3X<double> still = Matrix3X<double>::Zero(3, mesh.num_nodes());
    Matrix3X<double> scratch(3, law->scratch_columns());
    Matrix3X<double> force = Matrix3X<double>::Zero(3, mesh.num_nodes());
    law->add_forces({positions, still, mesh.masses}, scratch, force);
    for (int j = 2; j + 2 <= kCells; ++j) {
      for (int i = 2; i + 2 <= kCells; ++i) {
        largest = std::max(largest, force.col(j * (kCells + 1) + i).norm());
      }
    }
  }
  return largest / (kRigidity * kCurvature);
}

CheckResult base_check(const CaseInfo& info) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "laws";
  check.unit = "1";
  check.source = "energy of a quadratic surface; docs/force_laws.md, hinge_torsion";
  return check;
}

void judge_with(CheckResult& check, double measured, const Tolerance& tolerance,
                const std::string& sabotage, double sabotaged) {
  check.measured = measured;
  check.tolerance = tolerance;
  check.verdict = judge(measured, tolerance);
  check.sabotages.push_back({sabotage, sabotaged, judge(sabotaged, tolerance) == Verdict::kFail});
}

}  // namespace
}  // namespace plate_rigidity

void evaluate_plate_rigidity(const CaseInfo& info, const CaseOptions&, const EngineRuns&,
                             Report& report) {
  using namespace plate_rigidity;
  const Sheet one_way{0.0, true};
  CheckResult plate = base_check(info);
  plate.claim = "a grid of hinges is an isotropic plate of rigidity D";
  plate.metric = "largest |D measured / D - 1|: cylinder, sphere, saddle at seven angles";
  plate.formula = "energy per area = D (K : K) / 2";
  plate.note = "the weights of hinge_torsion";
  judge_with(plate, largest_error({}),
             {0.02, Basis::kTruncation, "squares of slopes: 2e-2 squared; measured 1e-3"},
             "cells cut one way, weighted by length", largest_error(one_way));
  report.checks.push_back(std::move(plate));

  CheckResult balance = base_check(info);
  balance.claim = "a uniformly curved sheet is in balance: no node gives way";
  balance.metric = "largest force on an inner node over D kappa, cylinders at seven angles";
  balance.formula = "0";
  balance.note = "both ways of cutting must weigh the same";
  judge_with(balance, largest_inner_force({}),
             {0.02, Basis::kTruncation, "squares of slopes; one way of cutting gives 4"},
             "cells cut one way only", largest_inner_force(one_way));
  report.checks.push_back(std::move(balance));

  CheckResult irregular = base_check(info);
  irregular.claim = "an irregular grid of hinges is nearly the same plate";
  irregular.metric = "largest |D measured / D - 1|, nodes off by up to 20 % of a cell";
  irregular.formula = "energy per area = D (K : K) / 2";
  irregular.note = "the weights of hinge_torsion";
  judge_with(irregular, largest_error({0.2, false}),
             {0.05, Basis::kModelGap, "no hinge energy is exact on irregular cells"},
             "cells cut one way, weighted by length", largest_error({0.2, true}));
  report.checks.push_back(std::move(irregular));

  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Plot plot{"Rigidity by direction", "angle [deg]", "D measured / D [1]", false, false, {}};
  for (const double jitter : {0.0, 0.2}) {
    for (const Shape& shape : kShapes) {
      Series series{fmt::format("{}{}", shape.name, jitter > 0 ? ", 20 % jitter" : ""), {}, {}};
      for (const int angle : kAngles) {
        series.x.push_back(angle);
        series.y.push_back(rigidity_ratio({jitter, false}, shape, angle));
      }
      plot.series.push_back(std::move(series));
    }
  }
  section.plots.push_back(std::move(plot));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
