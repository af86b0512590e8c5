// Tested by tests/reference/contact_test.cpp.

#include <weft/reference/contact/contact_stages.hpp>

namespace weft::reference {
namespace {

class ProjectionContact final : public ContactModel {
 public:
  [[nodiscard]] ContactOutcome resolve(const System& system, SystemStep& step) const override {
    Touches touches;
    ContactOutcome shift = run_position_stage(
        system, {.friction = false, .change_end_velocity = false}, step, touches);
    if (shift.exhausted) return shift;
    shift.normal_impulse = 0.0;  // the shift of positions carries no momentum
    return combined(shift, run_velocity_stage(system, /*friction=*/false, touches, step));
  }
};

}  // namespace

std::unique_ptr<ContactModel> make_projection_contact() {
  return std::make_unique<ProjectionContact>();
}

}  // namespace weft::reference
