#pragma once

// Tested by tests/validation/theory_test.cpp, tests/validation/cases/support/parameters_test.cpp.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <weft/validation/referee/recorded_result.hpp>
#include <weft/validation/report/report.hpp>
#include <weft/validation/run/engine_runs.hpp>

namespace weft::validation {

/// How long a case takes, and so how often it is run.
enum class Tier {
  kCommit,   ///< seconds: with every change
  kNightly,  ///< longer: every night, and before a release
};

/// A number of a case that can be asked for on the command line.
struct CaseParameter {
  std::string_view name;     ///< "gamma", the name of the option
  std::string_view unit;     ///< "1", "m"
  std::string_view summary;  ///< half a sentence
  double minimum = 0.0;      ///< inclusive
  double maximum = 0.0;      ///< inclusive
  /// Where it is not asked for but another one is. None: the case chooses it from the others.
  std::optional<double> default_value = std::nullopt;
  bool is_whole = false;  ///< a whole number
};

/// Values of parameters by name.
using CaseValues = std::map<std::string, double, std::less<>>;

/// What a case may use.
struct CaseOptions {
  bool pictures = true;  ///< render pictures for the report
  bool bullet = true;    ///< this program was built with Bullet
  /// Asked for on the command line: the case is evaluated at this one point in place of its table.
  CaseValues values = {};
  std::string engine = {};  ///< asked for; empty: all of the case's
  /// Is judged in place of every engine but the reference; by the case that case_of_recording() finds.
  std::optional<RecordedResult> recorded = std::nullopt;
};

struct CaseInfo;
struct TheoryScene;

/// A row of the case table.
struct CaseInfo {
  std::string_view id;       ///< "hang"
  std::string_view summary;  ///< one sentence, what is claimed
  /// Asks for the simulations the case needs; may be null.
  void (*plan)(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs);
  /// Judges them and adds checks and a section to the report.
  void (*evaluate)(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                   Report& report);
  Tier tier = Tier::kCommit;
  std::span<const CaseParameter> parameters = {};
  /// Scenes of this case that every engine can run and of which a theory knows a number; may be null. Given beside evaluate,
  /// which may be null then.
  std::vector<TheoryScene> (*theory)(const CaseInfo& info, const CaseOptions& options) = nullptr;
  /// Scenes of which a recording can be judged in place of an engine (CaseOptions::recorded), as scene files have them; null: none.
  std::vector<scenes::Scene> (*recordable)(const CaseInfo& info) = nullptr;
};

}  // namespace weft::validation
