#pragma once

#include <string>
#include <string_view>

#include <weft/validation/report/report.hpp>
#include <weft/validation/run/engine_runs.hpp>

namespace weft::validation {

/// What a case may use.
struct CaseOptions {
  bool pictures = true;  ///< render pictures for the report
  bool bullet = true;    ///< this program was built with Bullet
};

/// A row of the case table.
struct CaseInfo {
  std::string_view id;       ///< "hang"
  std::string_view summary;  ///< one sentence, what is claimed
  /// Asks for the simulations the case needs; may be null.
  void (*plan)(const CaseInfo& info, const CaseOptions& options, EngineRuns& runs);
  /// Judges them and adds checks and a section to the report.
  void (*evaluate)(const CaseInfo& info, const CaseOptions& options, const EngineRuns& runs,
                   Report& report);
};

}  // namespace weft::validation
