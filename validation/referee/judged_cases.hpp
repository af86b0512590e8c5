#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <weft/validation/cases/support/case.hpp>

namespace weft::validation {

/// The case that a recording is judged by: the one with the recording's scene (ask_the_same), or the named one. recorded.scene becomes
/// the case's. A named case with a single scene also takes a recording of another scene, such as that of a program's own loop, which
/// has no laws: what counts is in its frames. Every frame is looked at (check_frames).
/// @throws InvalidArgument that names the file and the cases that can be judged, for a scene of no case, for a case that cannot be
/// judged from a recording, for several names, and for an engine without bounds.
[[nodiscard]] const CaseInfo& case_of_recording(const std::vector<std::string>& names,
                                                RecordedResult& recorded);

/// Cases that no recording can pass, with the reason.
struct NotJudged {
  const char* reason;  ///< a clause that goes on after "because"
  std::vector<std::string_view> cases;
};
[[nodiscard]] std::span<const NotJudged> not_judged();
/// "Not judged from a recording, because ...: a, b, c." for each reason.
[[nodiscard]] std::vector<std::string> not_judged_texts();

}  // namespace weft::validation
