#pragma once

// Tested by tests/validation/theory_test.cpp, tests/validation/cases/support/parameters_test.cpp.

namespace weft::validation {

/// A chain between two points of one height.
struct Cable {
  double length = 1.2;     ///< unstretched, over the span [-]
  double stiffness = 120;  ///< EA over weight per length times span [-]
  int springs = 100;
};

struct CableShape {
  double pull = 0.0;     ///< horizontal, over w d [-]
  double sag = 0.0;      ///< over d [-]
  double tension = 0.0;  ///< largest, over w d [-]
};

/// The elastic catenary: d = H L0 / EA + (2 H / w) asinh(w L0 / (2 H)), solved for H.
[[nodiscard]] CableShape exact_cable(const Cable& cable);

}  // namespace weft::validation
