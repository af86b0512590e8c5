#include <weft/validation/cases/analytic/bending/bent_strip.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cloth_grid.hpp>
#include <weft/mesh/topology/hinges.hpp>
#include <weft/reference/statics/coupling.hpp>
#include <weft/validation/cases/analytic/statics/lattice_strip.hpp>

namespace weft::validation {
namespace bent_strip {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

int num_diagonals(const Strip& strip) {
  return std::max(1, static_cast<int>(std::lround(strip.num_cells / std::numbers::sqrt2)));
}

/// Rows of nodes along the strip, for 0 and 90 degrees the grid's own.
ClothMesh straight_strip(const Strip& strip) {
  const double spacing = strip.length / strip.num_cells;
  const int along = strip.num_cells + 2;
  const int across = strip.width_cells + 1;
  const double whole = spacing * (along - 1);
  const double width = spacing * strip.width_cells;
  ClothGrid grid;
  grid.stencil = GridStencil::k8Neighbour;
  grid.center = {whole / 2 - spacing, 0, 0};
  grid.total_mass = strip.area_density * whole * width;
  if (strip.angle == 0) {
    grid.nodes = {along, across};
    grid.size = {whole, width};
  } else {
    grid.nodes = {across, along};
    grid.size = {width, whole};
    grid.u_axis = {0, 0, 1};
    grid.v_axis = {1, 0, 0};
  }
  ClothMesh mesh = make_cloth_grid(grid);
  mesh.line_sets.clear();
  return mesh;
}

/// Rows of nodes half a diagonal apart; in every second row they stand half a diagonal off.
struct DiagonalRows {
  int num_rows = 0;
  int num_columns = 0;  ///< of the odd rows; the even ones have one node more
  [[nodiscard]] int count(int row) const { return num_columns + (row % 2 == 0 ? 1 : 0); }
  [[nodiscard]] int node(int row, int column) const {
    return row / 2 * (2 * num_columns + 1) + (row % 2) * (num_columns + 1) + column;
  }
  [[nodiscard]] bool has(int row, int column) const {
    return row >= 0 && row < num_rows && column >= 0 && column < count(row);
  }
};

/// The triangles whose right angles stand on the rows that are not of this parity: their long sides
/// run along the strip and across it between nodes of the parity's rows. Where the strip ends some
/// are missing.
Triangles diagonal_triangles(const DiagonalRows& rows, int parity) {
  std::vector<Eigen::Vector3i> triangles;
  const auto add = [&](std::array<std::pair<int, int>, 3> corners) {
    Eigen::Vector3i nodes;
    for (int k = 0; k < 3; ++k) {
      const auto [row, column] = corners[static_cast<std::size_t>(k)];
      if (!rows.has(row, column)) return;
      nodes[k] = rows.node(row, column);
    }
    triangles.push_back(nodes);
  };
  for (int row = parity - 2; row < rows.num_rows; row += 2) {
    for (int c = -1; c <= rows.num_columns; ++c) {
      const int m = parity == 0 ? c : c + 1;  // middle row: between columns c and c + 1
      add({{{row, c}, {row + 1, m}, {row, c + 1}}});
      add({{{row + 2, c}, {row + 2, c + 1}, {row + 1, m}}});
      add({{{row, c}, {row + 2, c}, {row + 1, m}}});
      add({{{row, c + 1}, {row + 1, m}, {row + 2, c + 1}}});
    }
  }
  Triangles result(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    result.col(static_cast<Eigen::Index>(t)) = triangles[t];
  }
  return result;
}

ClothMesh diagonal_strip(const Strip& strip) {
  constexpr int kClampRows = 2;
  const int periods = num_diagonals(strip);
  const double diagonal = strip.length / periods;
  const DiagonalRows rows{2 * periods + 1 + kClampRows, strip.width_cells};
  ClothMesh mesh;
  mesh.triangles = diagonal_triangles(rows, 0);
  mesh.crossed_triangles = diagonal_triangles(rows, 1);
  const int num_nodes = rows.node(rows.num_rows - 1, rows.count(rows.num_rows - 1) - 1) + 1;
  mesh.rest_positions.resize(3, num_nodes);
  mesh.masses.resize(num_nodes);
  for (int row = 0; row < rows.num_rows; ++row) {
    const bool is_odd = row % 2 == 1;
    const bool is_end = row == 0 || row == rows.num_rows - 1;
    for (int c = 0; c < rows.count(row); ++c) {
      const int node = rows.node(row, c);
      mesh.rest_positions.col(node) << (row - kClampRows) * diagonal / 2, 0,
          -(c + (is_odd ? 0.5 : 0.0)) * diagonal;
      // The area of a cell for every inner node.
      const bool is_side = !is_odd && (c == 0 || c == strip.width_cells);
      mesh.masses[node] = strip.area_density * diagonal * diagonal / 2 * (is_end ? 0.5 : 1.0) *
                          (is_side ? 0.5 : 1.0);
    }
  }
  mesh.edge_sets.push_back({"net", edges_of_triangles(mesh.triangles)});
  return mesh;
}

/// Numbers in [-1, 1], the same on every machine.
class Noise {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 33U) / 1073741824.0 - 1.0;
  }

 private:
  std::uint64_t state_ = 12345;
};

void jitter(const Strip& strip, ClothMesh& mesh) {
  const double spacing = strip.length / strip.num_cells;
  const double near = 0.01 * spacing;
  const double left = mesh.rest_positions.row(2).minCoeff();
  const double right = mesh.rest_positions.row(2).maxCoeff();
  Noise noise;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const double x = mesh.rest_positions(0, node);
    const double z = mesh.rest_positions(2, node);
    if (x < near || x > strip.length - near) continue;
    mesh.rest_positions(0, node) += strip.jitter * spacing * noise.next();
    const bool is_inside = z > left + near && z < right - near;
    if (is_inside) mesh.rest_positions(2, node) += strip.jitter * spacing * noise.next();
  }
}

/// The endless sheet: the strip's columns of one period stand for all others.
struct Periodicity {
  std::vector<int> original;    ///< node of the period that a node copies
  std::vector<double> shift;    ///< how far it stands from it, along z [m]
  std::vector<int> unknowns;    ///< nodes of the period
  std::vector<int> unknown_of;  ///< their number, -1 for copies
};

Periodicity periodicity_of(const ClothMesh& mesh, double period, double begin) {
  Periodicity result;
  const double near = 1e-3 * period;
  const int n = mesh.num_nodes();
  const auto in_period = [&](double z) { return z > begin - near && z < begin + period - near; };
  result.unknown_of.assign(static_cast<std::size_t>(n), -1);
  for (int node = 0; node < n; ++node) {
    if (!in_period(mesh.rest_positions(2, node))) continue;
    result.unknown_of[static_cast<std::size_t>(node)] = static_cast<int>(result.unknowns.size());
    result.unknowns.push_back(node);
  }
  for (int node = 0; node < n; ++node) {
    const Vector3<double> x = mesh.rest_positions.col(node);
    const double shift = std::floor((x[2] - begin + near) / period) * period;
    const auto found =
        std::find_if(result.unknowns.begin(), result.unknowns.end(), [&](int candidate) {
          const Vector3<double> there(x[0], x[1], x[2] - shift);
          return (mesh.rest_positions.col(candidate) - there).norm() < near;
        });
    result.original.push_back(*found);
    result.shift.push_back(shift);
  }
  return result;
}

/// All nodes from those of the period.
Matrix3X<double> unfold(const Periodicity& period, const Matrix3X<double>& unknowns,
                        bool with_shift) {
  Matrix3X<double> all(3, static_cast<Eigen::Index>(period.original.size()));
  for (std::size_t node = 0; node < period.original.size(); ++node) {
    const auto column = static_cast<Eigen::Index>(node);
    const int original = period.original[node];
    all.col(column) = unknowns.col(period.unknown_of[static_cast<std::size_t>(original)]);
    if (with_shift) all(2, column) += period.shift[node];
  }
  return all;
}

Matrix3X<double> fold(const Periodicity& period, const Matrix3X<double>& all) {
  Matrix3X<double> unknowns(3, static_cast<Eigen::Index>(period.unknowns.size()));
  for (std::size_t u = 0; u < period.unknowns.size(); ++u) {
    unknowns.col(static_cast<Eigen::Index>(u)) = all.col(period.unknowns[u]);
  }
  return unknowns;
}

reference::StaticProblem endless(const reference::StaticProblem& whole, const Periodicity& period) {
  reference::StaticProblem problem;
  problem.load = whole.load;
  for (const int node : period.unknowns) {
    problem.fixed.push_back(whole.fixed[static_cast<std::size_t>(node)]);
  }
  std::set<std::pair<int, int>> pairs;
  for (Eigen::Index e = 0; e < whole.coupled.cols(); ++e) {
    const auto unknown = [&](int node) {
      const int original = period.original[static_cast<std::size_t>(node)];
      return period.unknown_of[static_cast<std::size_t>(original)];
    };
    const int a = unknown(whole.coupled(0, e));
    const int b = unknown(whole.coupled(1, e));
    if (a != b) pairs.emplace(std::min(a, b), std::max(a, b));
  }
  problem.coupled.resize(2, static_cast<Eigen::Index>(pairs.size()));
  Eigen::Index column = 0;
  for (const auto& [a, b] : pairs) problem.coupled.col(column++) << a, b;
  problem.forces = [&whole, &period](const Matrix3X<double>& x, Matrix3X<double>& f) {
    Matrix3X<double> all(3, static_cast<Eigen::Index>(period.original.size()));
    whole.forces(unfold(period, x, true), all);
    f = fold(period, all);
  };
  problem.stiffness_product = [&whole, &period](const Matrix3X<double>& x,
                                                const Matrix3X<double>& b, Matrix3X<double>& kb) {
    Matrix3X<double> all(3, static_cast<Eigen::Index>(period.original.size()));
    whole.stiffness_product(unfold(period, x, true), unfold(period, b, false), all);
    kb = fold(period, all);
  };
  return problem;
}

bool is_odd(const Strip& strip) {
  return strip.angle != 0 && strip.angle != 45 && strip.angle != 90;
}

ClothMesh odd_strip(const Strip& strip) {
  return make_lattice_strip(nearest_direction(strip.angle), strip.num_cells, strip.length,
                            strip.area_density);
}

/// Across the strip, until its nodes repeat [m].
double repeat_of(const Strip& strip, const ClothMesh& mesh) {
  const double spacing = strip.length / strip.num_cells;
  if (is_odd(strip)) {
    // The two legs of a triangle are a spacing long.
    const double edge = (mesh.rest_positions.col(mesh.triangles(1, 0)) -
                         mesh.rest_positions.col(mesh.triangles(0, 0)))
                            .norm();
    const double other = (mesh.rest_positions.col(mesh.triangles(2, 0)) -
                          mesh.rest_positions.col(mesh.triangles(0, 0)))
                             .norm();
    return nearest_direction(strip.angle).period() * std::min(edge, other);
  }
  return strip.angle == 45 ? strip.length / num_diagonals(strip) : 2 * spacing;
}

double width_of(const ClothMesh& mesh) {
  return mesh.rest_positions.row(2).maxCoeff() - mesh.rest_positions.row(2).minCoeff();
}

}  // namespace
}  // namespace bent_strip

ClothMesh make_strip(const Strip& strip) {
  using namespace bent_strip;
  ClothMesh mesh = is_odd(strip)       ? odd_strip(strip)
                   : strip.angle == 45 ? diagonal_strip(strip)
                                       : straight_strip(strip);
  const double near = 1e-3 * strip.length / strip.num_cells;
  for (int node = 0; node < mesh.num_nodes() && !is_odd(strip); ++node) {
    if (mesh.rest_positions(0, node) < near) mesh.pinned.push_back(node);
  }
  if (strip.jitter > 0) jitter(strip, mesh);
  return mesh;
}

StripTip strip_tip(const ClothMesh& mesh, ConstMatrix3XRef<double> positions) {
  using namespace bent_strip;
  const double end = mesh.rest_positions.row(0).maxCoeff();
  StripTip tip;
  int count = 0;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (mesh.rest_positions(0, node) < end * (1 - 1e-9)) continue;
    tip.drop -= positions(1, node);
    tip.reach += positions(0, node);
    ++count;
  }
  return {tip.drop / count, tip.reach / count};
}

reference::Body make_strip_body(const StripModel& model) {
  using namespace bent_strip;
  const Strip& strip = model.strip;
  reference::Body body;
  body.name = "strip";
  body.mesh = make_strip(strip);
  if (model.cut_one_way) body.mesh.crossed_triangles.resize(3, 0);
  const double weight = strip.area_density * kGravity * strip.length;  // per width [N/m]
  if (model.is_tip_load) {
    const double end = body.mesh.rest_positions.row(0).maxCoeff() * (1 - 1e-9);
    const double whole = strip.area_density * strip.length * width_of(body.mesh);
    double at_tip = 0;
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      if (body.mesh.rest_positions(0, node) >= end) at_tip += body.mesh.masses[node];
    }
    for (int node = 0; node < body.mesh.num_nodes(); ++node) {
      // What the others weigh is below rounding.
      const bool is_tip = body.mesh.rest_positions(0, node) >= end;
      body.mesh.masses[node] *= is_tip ? whole / at_tip : 1e-20;
    }
  }
  const double rigidity = weight * strip.length * strip.length / model.gamma;
  const Vector3<double> gravity =
      kGravity * Vector3<double>(std::sin(model.tilt), -std::cos(model.tilt), 0);
  for (const forces::LawSpecification& law : std::vector<forces::LawSpecification>{
           {"tension", {}, {{"stiffness", {weight / model.strain}}}},
           {"hinge_torsion",
            {},
            {{"rigidity", {rigidity}}, {"clamp_factor", {model.clamp_factor}}}},
           {"gravity", {}, {{"acceleration", {gravity.x(), gravity.y(), gravity.z()}}}}}) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  return body;
}

BentStrip bend_strip(const StripModel& model, const Matrix3X<double>& start) {
  using namespace bent_strip;
  constexpr double kFirstGamma = 2.0;  // a straight strip finds its way to this load at once
  if (start.cols() == 0 && model.gamma > kFirstGamma) {
    StripModel softer = model;
    softer.gamma = std::max(kFirstGamma, model.gamma / 3);
    return bend_strip(model, bend_strip(softer).positions);
  }
  BentStrip result;
  const Strip& strip = model.strip;
  reference::Body body = make_strip_body(model);
  const reference::StaticProblem whole =
      reference::static_problem(body, body.mesh.masses.sum() * kGravity);
  reference::StaticOptions options;
  // Springs of weight / 1e-5 times the rounding of positions of about L.
  options.residual = 1e-9;
  options.max_move = strip.length / 5;
  Matrix3X<double> positions = start.cols() > 0 ? start : body.mesh.rest_positions;
  if (model.is_endless) {
    // The period in the middle; the rest is there so that it has neighbors.
    const double spacing = repeat_of(strip, body.mesh);
    const double middle =
        (body.mesh.rest_positions.row(2).minCoeff() + body.mesh.rest_positions.row(2).maxCoeff()) /
        2;
    const double begin =
        body.mesh.rest_positions.row(2).minCoeff() +
        (is_odd(strip)
             ? middle - body.mesh.rest_positions.row(2).minCoeff() - spacing / 2
             : std::floor((middle - body.mesh.rest_positions.row(2).minCoeff()) / spacing) *
                   spacing);
    const Periodicity period = periodicity_of(body.mesh, spacing, begin);
    const reference::StaticProblem problem = endless(whole, period);
    Matrix3X<double> unknowns = fold(period, positions);
    result.converged = reference::solve_statics(problem, unknowns, options).converged;
    positions = unfold(period, unknowns, true);
  } else {
    result.converged = reference::solve_statics(whole, positions, options).converged;
  }
  const StripTip tip = strip_tip(body.mesh, positions);
  const double c = std::cos(model.tilt);
  const double sine = std::sin(model.tilt);
  result.tip = {c * tip.drop + sine * tip.reach, c * tip.reach - sine * tip.drop};
  result.drop_over_reach = result.tip.drop / result.tip.reach;
  result.positions = std::move(positions);
  result.mesh = std::move(body.mesh);
  return result;
}

}  // namespace weft::validation
