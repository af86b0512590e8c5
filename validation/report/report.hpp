#pragma once

#include <optional>
#include <string>
#include <vector>

#include <weft/validation/metrics/series/tolerance.hpp>
#include <weft/validation/report/distance_view.hpp>

namespace weft::validation {

/// A deliberate mistake that a check must notice.
struct SabotageResult {
  std::string name;       ///< "spring constant +1 %"
  double measured = 0;    ///< the check's metric under the sabotage
  bool detected = false;  ///< the check failed, as it must
};

/// What an error is made of: a number with its unit, and the one that it should be.
struct ComparedValue {
  std::string quantity;  ///< "drop of the tip", "H / W"
  double value = 0;      ///< as measured [unit]
  double expected = 0;   ///< by theory, or by the run it is compared with [unit]
  std::string unit;      ///< "m"; "1" if dimensionless
};

/// One row of the report's table: one number against one bound.
struct CheckResult {
  std::string case_id;  ///< "hang"
  std::string engine;   ///< "bullet_forces float64"
  std::string claim;    ///< "follows the reference step for step"
  std::string metric;   ///< "largest node distance, 0 to 0.5 s"
  std::string unit;     ///< "m"; "1" if dimensionless
  std::string formula;  ///< what it is compared with, may be empty
  std::string source;   ///< where the formula or reference comes from
  double measured = 0;
  std::optional<Tolerance> tolerance;  ///< none: measured and shown, not gated
  Verdict verdict = Verdict::kInfo;
  std::vector<SabotageResult> sabotages;
  std::string note;  ///< what to look at when it fails, or what the number means
  /// What measured was computed from; where it is the largest of many, those of the largest. Empty where it is itself the
  /// number of interest.
  std::vector<ComparedValue> values = {};
  std::string cause = {};  ///< of a known deviation (kKnown, kStale): why it is expected to fail
};

struct Series {
  std::string name;  ///< shown in the legend
  std::vector<double> x;
  std::vector<double> y;
};

struct Plot {
  std::string title;
  std::string x_label;  ///< with unit, "time [s]"
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::vector<Series> series;
};

struct Picture {
  std::string title;    ///< "bullet_soft float32"
  std::string caption;  ///< "t = 6 s", "difference to the reference"
  std::string image;    ///< bytes of a PNG or JPEG file
};

/// Pictures that belong side by side.
struct PictureRow {
  std::string title;
  std::vector<Picture> pictures;
};

struct Table {
  std::string title;
  std::vector<std::string> columns;  ///< headings with units
  std::vector<std::vector<std::string>> rows;
};

/// Everything the report shows of one scene or case.
struct Section {
  std::string id;       ///< "drape_sphere"
  std::string summary;  ///< one sentence
  std::vector<PictureRow> picture_rows;
  std::vector<Plot> plots;
  std::vector<Table> tables;
  std::string scene_text;  ///< resolved scene, may be empty
  std::vector<DistanceView> distance_views = {};
};

/// A place where an engine is known to differ, with its measured size and its reason.
struct Deviation {
  std::string engine;
  std::string what;      ///< "stiffness depends on iterations and time step"
  std::string measured;  ///< "RMS 4.1 % of cloth size, drape_sphere at rest"
  std::string reason;
};

struct Report {
  std::string title;
  std::vector<CheckResult> checks;
  std::vector<Section> sections;
  std::vector<Deviation> deviations;
  std::vector<std::string> limits;  ///< what was not tested
  /// machine, compiler, versions, hashes
  std::vector<std::pair<std::string, std::string>> provenance;
  [[nodiscard]] bool passed() const;  ///< no failed or stale check and every sabotage detected
};

/// report.json, pretty-printed, with a schema version; pictures as base64. Numbers read back to the
/// same bits (up to 17 digits); a non-finite one is the string "NaN", "Infinity" or "-Infinity".
[[nodiscard]] std::string to_json(const Report& report);
/// junit.xml: one test case per check (skipped if not gated or a known deviation), one per sabotage.
[[nodiscard]] std::string to_junit(const Report& report);
/// The table for a terminal: one line per check and one for each of its compared values, and the verdict.
[[nodiscard]] std::string to_text(const Report& report);
/// One self-contained page that opens from file://.
[[nodiscard]] std::string to_html(const Report& report);
/// The same from the text of a report.json. @throws Error naming the file (only for the message) if it
/// is not one, or of a schema version that the page does not know.
[[nodiscard]] std::string html_of_json(const std::string& json, const std::string& file);

}  // namespace weft::validation
