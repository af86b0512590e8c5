#include <weft/bridge/adoption/adopting_solver.hpp>

#include <algorithm>
#include <exception>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void AdoptingSolver::optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool force_update) {
  std::erase_if(refused_, [&](const Refused& one) {
    return bodies.findLinearSearch(one.body) == bodies.size();
  });
  for (int i = 0; i < bodies.size(); ++i) {
    if (!has_laws(*bodies[i])) adopt_one(*bodies[i]);
  }
  SoftBodySolver::optimize(bodies, force_update);
}

// No exception leaves a step: what adopt() throws is why the body is left to Bullet, and is not tried again in every step.
void AdoptingSolver::adopt_one(btSoftBody& body) {
  const auto known = std::find_if(refused_.begin(), refused_.end(),
                                  [&](const Refused& one) { return one.body == &body; });
  if (known != refused_.end() && known->is_final) return;
  AdoptionReport report;
  bool is_final = false;
  try {
    const std::optional<AdoptionSettings> settings = policy_ ? policy_(body) : settings_;
    if (!settings) return;
    report = adopt(*this, body, *settings);
  } catch (const std::exception& error) {
    report = {.refusal = error.what(), .properties = {}};
    is_final = true;
  }
  if (report.refusal && known != refused_.end()) return;
  if (report.refusal) refused_.push_back({&body, is_final});
  if (on_adoption_) on_adoption_(body, report);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
