// The drape test after Cusick: a disc of cloth of 30 cm on a disc of 18 cm, from above. Folds may form in more than one
// way, so each cloth falls eight times from slightly uneven starts.
// Tested by tests/apps/CMakeLists.txt.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <weft/core/parallel/parallel_for.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/surface_body.hpp>
#include <weft/validation/cases/support/engine_cases.hpp>
#include <weft/validation/cases/support/small_systems.hpp>
#include <weft/validation/metrics/projected_area.hpp>
#include <weft/validation/metrics/rim_folds.hpp>

namespace weft::validation {
namespace cusick {
namespace {

constexpr double kClothRadius = 0.15;    // [m]
constexpr double kSupportRadius = 0.09;  // [m]
constexpr double kGravity = 9.81;        // [m/s^2]
constexpr int kSeeds = 8;
constexpr double kNoise = 1e-5;    // [m]: unevenness of the start
constexpr double kDrag = 10.0;     // [1/s]: a free flap of 6 cm swings at 13 / s
constexpr double kEndTime = 1.5;   // [s]
constexpr double kStrain = 0.003;  // of the net under the weight of the overhang, about

constexpr double kResolutionGap = 3.0;  // [%]
constexpr double kSeedDeviation = 3.0;  // [%]
constexpr double kRestSpeed = 0.008;    // [m/s]

/// A cloth with real areal density, and what its drape is compared with.
struct Fabric {
  const char* name;
  double areal_density;  ///< [kg/m^2]
  double rigidity;       ///< D [N m]
};

// Volume density, thickness, Young's modulus and Poisson's ratio as in the examples of Codim-IPC (Apache-2.0,
// FEMDiscreteShellBase.py), made rho h and E h^3 / (12 (1 - nu^2)) here.
constexpr std::array kFabrics = {Fabric{"cotton", 0.150, 2.34e-6}, Fabric{"wool", 0.235, 2.81e-6},
                                 Fabric{"polyester", 0.165, 7.46e-7}};

/// Length that a cloth of this rigidity bends over under its weight [m].
double bending_length(const Fabric& fabric) {
  return std::cbrt(fabric.rigidity / (fabric.areal_density * kGravity));
}

// Simulated with another program, ppf-contact-solver (Apache-2.0, folder calibration), whose fabrics were fitted to
// published drape coefficients: bending length [m], found from its own cantilevers, and coefficient [%].
constexpr std::array<std::array<double, 2>, 5> kPeer = {
    {{0.0076, 27.8}, {0.0097, 35.4}, {0.0141, 61.9}, {0.0150, 70.0}, {0.0203, 86.6}}};

/// Rings of nodes from the support's edge outwards; the first two are held.
struct CusickRing {
  int around = 96;
  int cells = 8;  ///< from the support's edge to the rim
  [[nodiscard]] int node(int ring, int at) const { return ring * around + (at % around); }
  [[nodiscard]] double radius(int ring) const {
    return kSupportRadius + (ring - 1) * (kClothRadius - kSupportRadius) / cells;
  }
};

Triangles ring_triangles(const CusickRing& ring, int parity, int num_cells) {
  Triangles triangles(3, 2 * ring.around * num_cells);
  Eigen::Index t = 0;
  for (int r = 0; r < num_cells; ++r) {
    for (int a = 0; a < ring.around; ++a) {
      const int n00 = ring.node(r, a);
      const int n01 = ring.node(r, a + 1);
      const int n10 = ring.node(r + 1, a);
      const int n11 = ring.node(r + 1, a + 1);
      if ((r + a + parity) % 2 == 0) {
        triangles.col(t++) << n00, n11, n10;
        triangles.col(t++) << n00, n01, n11;
      } else {
        triangles.col(t++) << n00, n01, n10;
        triangles.col(t++) << n01, n11, n10;
      }
    }
  }
  return triangles;
}

ClothMesh make_ring(const CusickRing& ring, double areal_density) {
  Surface surface;
  surface.positions.resize(3, ring.around * (ring.cells + 2));
  for (int r = 0; r < ring.cells + 2; ++r) {
    for (int a = 0; a < ring.around; ++a) {
      const double angle = 2 * std::numbers::pi * a / ring.around;
      surface.positions.col(ring.node(r, a)) =
          ring.radius(r) * Vector3<double>(std::cos(angle), 0, std::sin(angle));
    }
  }
  surface.triangles = ring_triangles(ring, 0, ring.cells + 1);
  ClothMesh mesh =
      make_surface_body(surface, {.total_mass = areal_density * surface_area(surface)});
  mesh.crossed_triangles = ring_triangles(ring, 1, ring.cells + 1);
  for (int i = 0; i < 2 * ring.around; ++i) mesh.pinned.push_back(i);
  return mesh;
}

/// Energy of rings bent to y = (first x^2 + second z^2) / 2 over that of a plate of their rigidity. Hinges have half a
/// cell less at each rim: an error of first order, taken out with a mesh twice as fine.
double plate_ratio(double first, double second, bool cut_one_way) {
  const auto ratio = [&](const CusickRing& ring) {
    ClothMesh mesh = make_ring(ring, 0.1);
    mesh.pinned.clear();
    if (cut_one_way) mesh.crossed_triangles.resize(3, 0);
    Matrix3X<double> bent = mesh.rest_positions;
    bent.row(1) =
        (first * bent.row(0).array().square() + second * bent.row(2).array().square()) / 2;
    const auto law = forces::make_law<double>({"hinge_torsion", {}, {{"rigidity", {1.0}}}}, mesh);
    const double energy =
        law->potential_energy({bent, Matrix3X<double>::Zero(3, mesh.num_nodes()), mesh.masses});
    const double area = mesh.masses.sum() / 0.1;
    return energy / (area * (first * first + second * second) / 2);
  };
  return 2 * ratio({192, 16}) - ratio({96, 8});
}

double plate_error(bool cut_one_way) {
  constexpr double kSmall = 0.1;  // [1/m]: slopes of 0.015, whose squares do not count
  double largest = 0;
  for (const auto& [first, second] : {std::pair{1, 0}, std::pair{1, 1}, std::pair{1, -1}}) {
    largest =
        std::max(largest, std::abs(plate_ratio(first * kSmall, second * kSmall, cut_one_way) - 1));
  }
  return largest;
}

struct Drape {
  double coefficient = std::numeric_limits<double>::quiet_NaN();  ///< [%]
  int folds = 0;
  double speed = 0.0;  ///< RMS at the end [m/s]
  std::array<double, kLastFoldMode - kFirstFoldMode + 1> spectrum{};
};

/// Share of the overhang that is left of it from above.
double coefficient_of(const ClothMesh& mesh, const CusickRing& ring,
                      ConstMatrix3XRef<double> positions) {
  const ProjectionRaster raster{
      .cell_size = cusick_cell_size(std::numbers::pi * kClothRadius * kClothRadius)};
  const auto projection = projected_area(positions, mesh.triangles, raster);
  const auto flat = projected_area(mesh.rest_positions, mesh.triangles, raster);
  const auto held = projected_area(mesh.rest_positions, ring_triangles(ring, 0, 1), raster);
  if (!projection) return std::numeric_limits<double>::quiet_NaN();
  return 100 * (*projection - *held) / (*flat - *held);
}

Drape drape_once(const Fabric& fabric, const CusickRing& ring, std::uint32_t seed) {
  reference::Body body;
  body.name = fabric.name;
  body.mesh = make_ring(ring, fabric.areal_density);
  const double stiffness =
      fabric.areal_density * kGravity * (kClothRadius - kSupportRadius) / (1.5 * kStrain);
  forces::LawSpecification net = tension_law(stiffness);
  net.sets = {"stretch"};
  const std::vector<forces::LawSpecification> laws{
      net,
      gravity_law({0, -kGravity, 0}),
      velocity_damping_law(kDrag),
      {"hinge_torsion", {}, {{"rigidity", {fabric.rigidity}}}}};
  for (const forces::LawSpecification& law : laws) {
    body.laws.add(forces::make_law<double>(law, body.mesh));
  }
  body.positions = body.mesh.rest_positions;
  body.velocities.setZero(3, body.mesh.num_nodes());
  std::mt19937 random(seed);  // its numbers are the same everywhere, unlike those of distributions
  for (int i = 2 * ring.around; i < body.mesh.num_nodes(); ++i) {
    body.positions(1, i) += kNoise * (2 * (random() / 4294967296.0) - 1);
  }
  // An inner node of 8 springs and twice this mass would allow 0.7.
  const double time_step = 0.6 * std::sqrt(body.mesh.masses.minCoeff() / stiffness);
  const ClothMesh mesh = body.mesh;
  reference::SpringSolver solver =
      make_solver(std::move(body), reference::IntegratorKind::kVelocityVerlet);
  const int num_steps = static_cast<int>(std::ceil(kEndTime / time_step));
  for (int step = 0; step < num_steps; ++step) {
    if (solver.step(time_step).blow_up) return {};
  }
  const reference::Body& end = solver.system().bodies[0];
  Drape drape;
  drape.coefficient = coefficient_of(mesh, ring, end.positions);
  drape.speed = std::sqrt(end.velocities.colwise().squaredNorm().mean());
  if (const auto rim = rim_folds(mesh, end.positions, {})) {
    drape.folds = rim->num_maxima;
    drape.spectrum = rim->amplitudes;
  }
  return drape;
}

struct Statistics {
  double mean = 0.0;  ///< [%]
  double deviation = 0.0;
  double largest_speed = 0.0;                  ///< [m/s]
  std::array<int, kLastFoldMode + 1> folds{};  ///< how many seeds have so many
  std::array<double, kLastFoldMode - kFirstFoldMode + 1> spectrum{};  ///< mean amplitude [m]
};

Statistics statistics(const Fabric& fabric, const CusickRing& ring, int num_seeds = kSeeds) {
  std::vector<Drape> drapes(static_cast<std::size_t>(num_seeds));
  parallel_for(drapes.size(), [&](std::size_t i) {
    drapes[i] = drape_once(fabric, ring, static_cast<std::uint32_t>(1 + i));
  });
  Statistics result;
  for (const Drape& drape : drapes) {
    result.mean += drape.coefficient / num_seeds;
    result.largest_speed = std::max(result.largest_speed, drape.speed);
    ++result.folds[static_cast<std::size_t>(std::min(drape.folds, kLastFoldMode))];
    for (std::size_t m = 0; m < result.spectrum.size(); ++m) {
      result.spectrum[m] += drape.spectrum[m] / num_seeds;
    }
  }
  for (const Drape& drape : drapes) {
    result.deviation += std::pow(drape.coefficient - result.mean, 2) / (num_seeds - 1);
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

CheckResult check_of(const CaseInfo& info, const std::string& claim, const std::string& metric,
                     double measured, const Tolerance& tolerance) {
  CheckResult check;
  check.case_id = info.id;
  check.engine = "reference";
  check.claim = claim;
  check.metric = metric;
  check.unit = "%";
  check.formula = "100 (A_projected - A_support) / (A_cloth - A_support)";
  check.source = "BS 5058, ISO 9073-9: 30 cm of cloth on 18 cm";
  check.measured = measured;
  check.tolerance = tolerance;
  check.verdict = judge(measured, tolerance);
  check.note = "hinge_torsion on a mesh of rings, damping, or the time until rest";
  return check;
}

std::string folds_text(const Statistics& of) {
  std::string text;
  for (std::size_t n = 0; n < of.folds.size(); ++n) {
    if (of.folds[n] > 0) text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", of.folds[n], n);
  }
  return text;
}

Plot spectrum_plot() {
  return {"Fold spectrum of the rim, mean over eight seeds",
          "folds around [1]",
          "amplitude [mm]",
          false,
          false,
          {}};
}

Series spectrum_of(const char* name, const Statistics& of) {
  Series series{name, {}, {}};
  for (std::size_t m = 0; m < of.spectrum.size(); ++m) {
    series.x.push_back(static_cast<double>(m) + kFirstFoldMode);
    series.y.push_back(1000 * of.spectrum[m]);
  }
  return series;
}

}  // namespace
}  // namespace cusick

void evaluate_cusick(const CaseInfo& info, const CaseOptions&, const EngineRuns&, Report& report) {
  using namespace cusick;
  const CusickRing coarse{72, 6};
  const CusickRing fine{96, 8};
  const Tolerance plate{0.02, Basis::kTruncation, "cells 4 % wider outside than inside"};
  CheckResult rigid =
      check_of(info, "rings of hinges are a plate of their rigidity",
               "energy over a plate's - 1: cylinder, sphere and saddle", plate_error(false), plate);
  rigid.unit = "1";
  rigid.formula = "D K : K / 2 per area";
  rigid.source = "Kirchhoff's plate without transverse contraction";
  const double wrong_cut = plate_error(true);
  rigid.sabotages.push_back(
      {"cells cut one way", wrong_cut, judge(wrong_cut, plate) == Verdict::kFail});
  report.checks.push_back(std::move(rigid));
  Section section{std::string(info.id), std::string(info.summary), {}, {}, {}, ""};
  Table table{"Eight seeds each",
              {"fabric", "density [g/m^2]", "rigidity [uN m]", "bending length [mm]", "drape [%]",
               "deviation [%]", "10 mm cells [%]", "folds (seeds x number)"},
              {}};
  Plot spectrum = spectrum_plot();
  Plot curve{"Drape coefficient against bending length",
             "bending length [mm]",
             "drape coefficient [%]",
             false,
             false,
             {{"reference", {}, {}}, {"ppf-contact-solver", {}, {}}}};
  for (const Fabric& fabric : kFabrics) {
    const Statistics right = statistics(fabric, fine);
    const Statistics rough = statistics(fabric, coarse);
    Fabric stiffer = fabric;
    stiffer.rigidity *= 2.0;
    const Statistics wrong = statistics(stiffer, coarse, 3);
    const Tolerance resolution{
        kResolutionGap, Basis::kTruncation,
        "the instrument repeats itself within 2 %; measured up to 2.3 %: cells of 10 mm are as "
        "long as the cloth bends over"};
    CheckResult finer =
        check_of(info, fmt::format("{}: the drape does not depend on the mesh", fabric.name),
                 "difference of the means over eight seeds, cells of 7.5 and of 10 mm",
                 std::abs(right.mean - rough.mean), resolution);
    const double moved = std::abs(right.mean - wrong.mean);
    finer.sabotages.push_back(
        {"rigidity doubled", moved, judge(moved, resolution) == Verdict::kFail});
    report.checks.push_back(std::move(finer));
    report.checks.push_back(check_of(
        info, fmt::format("{}: eight uneven starts give one drape coefficient", fabric.name),
        "standard deviation over eight seeds", right.deviation,
        {kSeedDeviation, Basis::kStatistical,
         "the instrument's own spread is 2 %, real cloth folds anew each time"}));
    CheckResult rest =
        check_of(info, fmt::format("{}: the cloth is at rest", fabric.name),
                 "RMS speed of the nodes at 1.5 s, largest of eight seeds", right.largest_speed,
                 {kRestSpeed, Basis::kModelGap,
                  "with swings of 13 / s: 0.6 mm to each side, 1 % of the overhang"});
    rest.unit = "m/s";
    report.checks.push_back(std::move(rest));
    const double length = 1000 * bending_length(fabric);
    table.rows.push_back({fabric.name, fmt::format("{:g}", 1000 * fabric.areal_density),
                          fmt::format("{:.3g}", 1e6 * fabric.rigidity),
                          fmt::format("{:.1f}", length), fmt::format("{:.1f}", right.mean),
                          fmt::format("{:.1f}", right.deviation), fmt::format("{:.1f}", rough.mean),
                          folds_text(right)});
    spectrum.series.push_back(spectrum_of(fabric.name, right));
    curve.series[0].x.push_back(length);
    curve.series[0].y.push_back(right.mean);
  }
  for (const auto& [length, coefficient] : kPeer) {
    curve.series[1].x.push_back(1000 * length);
    curve.series[1].y.push_back(coefficient);
  }
  section.tables.push_back(std::move(table));
  section.plots.push_back(std::move(curve));
  section.plots.push_back(std::move(spectrum));
  report.sections.push_back(std::move(section));
}

}  // namespace weft::validation
