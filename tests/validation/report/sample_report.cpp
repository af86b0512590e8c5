#include "tests/validation/report/sample_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/validation/report/sample_distance_view.hpp"
#include "tests/validation/report/sample_picture.hpp"

namespace weft::tests {
namespace {

using namespace validation;

const char* const kEngines[] = {"bullet_soft float32", "bullet_forces float32",
                                "bullet_forces float64"};
const Tolerance kSpringBound{4e-3, Basis::kTruncation,
                             "C h with p = 1 tested on h = 8, 4, 2, 1 ms; C = 4 m/s"};
const Tolerance kRoundoffBound{2.3e-11, Basis::kRoundoff,
                               "1000 steps x 100 operations x epsilon x 1 m"};
const Tolerance kSameBits{0.0, Basis::kExact, "the same program twice gives the same bytes"};
const Tolerance kModelBound{0.05, Basis::kModelGap,
                            "solver stiffness differs; measured 3.1 % and 4.1 %"};

CheckResult check(std::string case_id, std::string engine, std::string claim, std::string metric,
                  std::string unit, double measured, std::optional<Tolerance> tolerance) {
  CheckResult result;
  result.case_id = std::move(case_id);
  result.engine = std::move(engine);
  result.claim = std::move(claim);
  result.metric = std::move(metric);
  result.unit = std::move(unit);
  result.measured = measured;
  result.tolerance = std::move(tolerance);
  if (result.tolerance) result.verdict = judge(measured, *result.tolerance);
  return result;
}

void add_spring_checks(Report& report) {
  const double measured[] = {9.7e-4, 2.9e-3, 1.2e-3};
  for (int i = 0; i < 3; ++i) {
    CheckResult row =
        check("oscillator", kEngines[i], "A damped mass on a spring follows the closed form",
              "largest |x - x_exact|, 0 to 2 s", "m", measured[i], kSpringBound);
    row.formula = "x(t) = A exp(-z w t) cos(w_d t + p)";
    row.source = "Rao, Mechanical Vibrations, section 2.6";
    row.sabotages = {{"stiffness +1 %", 0.021, true}, {"damping sign", 3.7, true}};
    report.checks.push_back(row);
  }
}

void add_hang_checks(Report& report) {
  CheckResult follows = check("hang", kEngines[2], "Follows the reference step for step",
                              "largest node distance, 0 to 0.5 s", "m", 8.4e-12, kRoundoffBound);
  follows.source = "reference, symplectic Euler in the same order";
  follows.sabotages = {{"spring constant +1 %", 0.012, true},
                       {"two springs swapped", 4.4e-9, true}};
  report.checks.push_back(follows);
  report.checks.push_back(check(
      "hang", kEngines[1], "Rest shape is the catenary", "largest node distance at rest / length",
      "1", 3.0e-4, Tolerance{0.05, Basis::kModelGap, "coarse chain against a smooth curve"}));
  report.checks.push_back(check("hang", kEngines[0], "Rest shape is the catenary",
                                "largest node distance at rest / length", "1", 0.0412,
                                kModelBound));
  CheckResult drifts =
      check("hang", kEngines[0], "Energy never grows without input",
            "largest rise of the total energy / E(0)", "1", 0.031,
            Tolerance{1e-2, Basis::kStatistical, "3 sigma over 20 seeds, sigma = 3.3e-3"});
  drifts.note = "Energy plot of hang: the rise starts when the lower hem leaves the ground plane.";
  drifts.formula = "E(t) <= E(0)";
  drifts.sabotages = {{"gravity x 1.1 halfway", 0.24, true}, {"one damper missing", 0.004, false}};
  report.checks.push_back(drifts);
}

void add_drape_checks(Report& report) {
  for (const char* engine : kEngines) {
    CheckResult same = check("drape_sphere", engine, "Two runs give the same bytes",
                             "differing bytes", "1", 0.0, kSameBits);
    same.sabotages = {{"one bit of the input flipped", 81422.0, true}};
    report.checks.push_back(same);
  }
  report.checks.push_back(
      check("drape_sphere", kEngines[0], "Does not enter the sphere", "deepest node", "m", 1.8e-3,
            Tolerance{1e-2, Basis::kModelGap, "collision margin of the engine"}));
  CheckResult gap = check("drape_sphere", kEngines[0], "Shape against the reference",
                          "RMS node distance / cloth size", "1", 0.041, std::nullopt);
  gap.note = "Two models that differ on purpose; see Known deviations.";
  report.checks.push_back(gap);
  report.checks.push_back(check("drape_sphere", kEngines[1], "Step time", "median over 600 steps",
                                "ms", 2.31, std::nullopt));
}

void add_hostile_check(Report& report) {
  CheckResult row = check("blow_up", kEngines[0], "Stays finite when the step is too long",
                          "largest |x| at 1 s", "m", std::numeric_limits<double>::quiet_NaN(),
                          Tolerance{10.0, Basis::kModelGap, kHostileText});
  row.note = kHostileText;
  row.sabotages = {{"step x 100", std::numeric_limits<double>::infinity(), true}};
  report.checks.push_back(row);
}

Series curve(std::string name, int count, double step, double (*f)(double)) {
  Series series{std::move(name), {}, {}};
  for (int i = 0; i < count; ++i) {
    series.x.push_back(i * step);
    series.y.push_back(f(i * step));
  }
  return series;
}

Plot motion_plot() {
  Plot plot{"Position of the mass", "time [s]", "x [m]", false, false, {}};
  plot.series = {curve("closed form", 401, 0.005,
                       [](double t) { return 0.1 * std::exp(-t) * std::cos(12 * t); }),
                 curve(kEngines[0], 121, 1 / 60.0,
                       [](double t) { return 0.1 * std::exp(-1.05 * t) * std::cos(11.7 * t); }),
                 curve(kEngines[1], 241, 1 / 120.0,
                       [](double t) { return 0.101 * std::exp(-t) * std::cos(11.95 * t); }),
                 curve(kEngines[2], 481, 1 / 240.0,
                       [](double t) { return 0.1 * std::exp(-t) * std::cos(11.98 * t); })};
  return plot;
}

Plot order_plot() {
  Plot plot{"Error against step size", "time step [s]", "largest error [m]", true, true, {}};
  for (int i = 0; i < 3; ++i) {
    Series series{kEngines[i], {}, {}};
    for (const double h : {8e-3, 4e-3, 2e-3, 1e-3, 5e-4}) {
      series.x.push_back(h);
      series.y.push_back(i == 0 ? 0.02 * std::sqrt(h) : (0.4 + i) * h);
    }
    plot.series.push_back(series);
  }
  plot.series.push_back({"slope 1", {5e-4, 8e-3}, {5e-4, 8e-3}});
  return plot;
}

Plot energy_plot() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Plot plot{"Total energy", "time [s]", "E / E(0) [1]", false, true, {}};
  plot.series = {
      curve(kEngines[0], 300, 0.01,
            [](double t) { return std::exp(-2 * t) + (t > 1.2 ? 0.03 * (t - 1.2) : 0); }),
      curve(kEngines[2], 300, 0.01, [](double t) { return std::exp(-2 * t) + 1e-4; })};
  plot.series[0].y[150] = nan;
  plot.series[1].y[299] = std::numeric_limits<double>::infinity();
  plot.series.push_back({"no number at all", {0, 1, 2}, {nan, nan, nan}});
  return plot;
}

Plot profile_plot() {
  Plot plot{"Outline of the cloth", "x [m]", "z [m]", false, false, {}};
  Series ring{"a closed curve", {}, {}};
  for (int i = 0; i < 60; ++i) {
    ring.x.push_back(std::cos(0.1 * i));
    ring.y.push_back(std::sin(0.1 * i));
  }
  plot.series = {ring};
  return plot;
}

Section drape_section() {
  Section section;
  section.id = "drape_sphere";
  section.summary = "A square cloth of 1 m falls on a sphere of 0.3 m radius and comes to rest.";
  for (const char* when : {"t = 1 s", "t = 6 s"}) {
    PictureRow row{std::string("Cloth at ") + when, {}};
    const double sag = std::string(when) == "t = 1 s" ? 0.3 : 0.8;
    row.pictures.push_back({"reference", when, sample_png(sag)});
    for (int i = 0; i < 3; ++i)
      row.pictures.push_back({kEngines[i], when, sample_png(sag - 0.15 + 0.05 * i)});
    section.picture_rows.push_back(row);
  }
  section.plots = {profile_plot()};
  section.tables = {
      {"Step time",
       {"engine", "median [ms]", "95 % [ms]", "springs", "steps", "threads", "peak memory [MB]"},
       {{kEngines[0], "1.42", "1.90", "7202", "600", "1", "41"},
        {kEngines[1], "2.31", "2.77", "7202", "600", "1", "44"},
        {kEngines[2], "2.66", "3.02", "7202", "600", "1", "52"}}}};
  section.scene_text =
      "name = \"drape_sphere\"\n[cloth]\nsize = [1.0, 1.0]      # m\ndensity = 0.2          # "
      "kg/m^2\n" +
      kHostileText;
  section.distance_views = {sample_distance_view()};
  return section;
}

Report make_report() {
  Report report;
  report.title = "Weft validation report";
  add_spring_checks(report);
  add_hang_checks(report);
  add_drape_checks(report);
  add_hostile_check(report);
  report.sections = {
      {"oscillator",
       "One mass, one spring, one damper; the closed form is known.",
       {},
       {motion_plot(), order_plot()},
       {},
       ""},
      {"hang", "A chain of 40 nodes hangs from both ends.", {}, {energy_plot()}, {}, ""},
      drape_section()};
  report.deviations = {{kEngines[0], "Stiffness depends on iterations and time step",
                        "RMS 4.1 % of cloth size, drape_sphere at rest",
                        "Position-based links: each iteration removes a share of the stretch, so "
                        "fewer iterations mean softer cloth."},
                       {"all", "No self-collision", "not measured", "Not modelled."}};
  report.limits = {"Cloth thicker than the collision margin.", "Frame rates below 30 Hz.",
                   "Any engine on ARM processors."};
  report.provenance = {
      {"weft", "0.1.0"},
      {"Bullet", "3.24, float32 and float64"},
      {"compiler", "g++ 12.2.0 -O3"},
      {"machine", "2 cores, x86-64"},
      {"state hash", "9f1c0e77a2b4d6835e1f9f1c0e77a2b4d6835e1f9f1c0e77a2b4d6835e1f"}};
  return report;
}

}  // namespace

Report sample_report() {
  static const Report kReport = make_report();  // once: the pictures take time
  return kReport;
}

Report passing_report() {
  Report report = sample_report();
  std::erase_if(report.checks, [](const CheckResult& row) {
    return row.verdict == Verdict::kFail ||
           std::any_of(row.sabotages.begin(), row.sabotages.end(),
                       [](const SabotageResult& s) { return !s.detected; });
  });
  return report;
}

Report deviating_report() {
  const std::string cause = "The bending force forgets its step.";
  Report report;
  report.title = "Weft validation report";
  for (const char* engine :
       {"reference", "bullet_weft float32, 1/60 s", "bullet_weft float64, 1/60 s"}) {
    CheckResult row =
        check("cantilever", engine, "A strip hangs as the elastica", "relative error of H / W", "1",
              0.002, Tolerance{0.01, Basis::kTruncation, "second order in the cells"});
    row.values = {{"H / W", 0.585, 0.5862, "1"}};
    row.sabotages = {{"rigidity +10 %", 0.09, true}};
    if (row.engine != "reference") {
      row.measured = 0.3;
      row.values = {{"H / W", 0.41, 0.5862, "1"}};
      row.verdict = Verdict::kKnown;
      row.cause = cause;
      report.deviations.push_back(
          {row.engine, "cantilever: a strip hangs", "0.3, allowed 0.01", cause});
    }
    report.checks.push_back(std::move(row));
  }
  report.deviations.push_back(
      {"bullet_soft float32", "Stiffness", "4.1 %", "Links are projected."});
  Section section{"cantilever", "A heavy strip bends.", {}, {}, {}, ""};
  section.picture_rows = {{"On the way", {{"reference", "t = 1 s", sample_png(0.2)}}},
                          {"At the end",
                           {{"bullet_weft float32", "t = 2 s", sample_png(0.5)},
                            {"reference", "t = 2 s", sample_png(0.3)}}}};
  report.sections = {section};
  return report;
}

}  // namespace weft::tests
