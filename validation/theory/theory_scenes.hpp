#pragma once

// Tested by tests/validation/theory_test.cpp.

#include <vector>

#include <weft/validation/cases/support/case.hpp>
#include <weft/validation/theory/theory_scene.hpp>

namespace weft::validation {

/// The scenes of a case that every engine can run: its table, or the one point that is asked for. Throw InvalidArgument for a
/// value that only the reference's own evaluation can take.
[[nodiscard]] std::vector<TheoryScene> chain_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> catenary_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> cantilever_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> fabric_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> balloon_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> oscillator_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> pendulum_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> vibration_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> flight_scenes(const CaseInfo&, const CaseOptions&);

[[nodiscard]] std::vector<TheoryScene> incline_scenes(const CaseInfo&, const CaseOptions&);
[[nodiscard]] std::vector<TheoryScene> stopping_scenes(const CaseInfo&, const CaseOptions&);

}  // namespace weft::validation
