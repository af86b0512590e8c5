// Tested by tests/reference/contact_test.cpp, tests/reference/friction_test.cpp.

#include <weft/reference/contact/contact_stages.hpp>

namespace weft::reference {
namespace {

class ImpulseContact final : public ContactModel {
 public:
  [[nodiscard]] ContactOutcome resolve(const System& system, SystemStep& step) const override {
    Touches touches;
    const ContactOutcome landing = run_position_stage(system, {}, step, touches);
    if (step.mean_is_end || landing.exhausted) return landing;
    return combined(landing, run_velocity_stage(system, /*friction=*/true, touches, step));
  }
};

}  // namespace

std::unique_ptr<ContactModel> make_impulse_contact() {
  return std::make_unique<ImpulseContact>();
}

}  // namespace weft::reference
