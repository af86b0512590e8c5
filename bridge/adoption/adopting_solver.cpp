#include <weft/bridge/adoption/adopting_solver.hpp>

#include <algorithm>
#include <exception>

#include <weft/bridge/adoption/suitable_body.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void AdoptingSolver::optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool force_update) {
  std::erase_if(refused_, [&](const Refused& one) {
    return bodies.findLinearSearch(one.body) == bodies.size();
  });
  give_back_changed();
  for (int i = 0; i < bodies.size(); ++i) {
    if (!has_laws(*bodies[i])) adopt_one(*bodies[i]);
  }
  SoftBodySolver::optimize(bodies, force_update);
}

AdoptingSolver::Source AdoptingSolver::Source::of(const btSoftBody& body) {
  Source source{
      body.m_nodes.size(), body.m_links.size(), body.m_faces.size(), body.m_cfg.piterations, {}};
  for (int m = 0; m < body.m_materials.size(); ++m) {
    source.factors.push_back(body.m_materials[m]->m_kLST);
  }
  return source;
}

// They are adopted again at once, if they can be. A body that has blown up keeps its laws, which say so.
void AdoptingSolver::give_back_changed() {
  std::erase_if(adopted_, [this](const Adopted& one) {
    btSoftBody* const body = one.cloth.body();
    if (body == nullptr || !has_laws(*body)) return true;
    if (blow_up(*body)) return false;
    if (Source::of(*body) == one.source && !reason_against_implicit(*body)) return false;
    detach(*body);
    return true;
  });
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
  if (report.refusal) {
    refused_.push_back({&body, is_final});
  } else {
    adopted_.push_back({cloth(body), Source::of(body)});
    std::erase_if(refused_, [&](const Refused& one) { return one.body == &body; });
  }
  if (on_adoption_) on_adoption_(body, report);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
