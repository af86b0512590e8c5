// Bodies whose steps are divided alike.
// Tested by tests/bridge/implicit/fast_body_impact_test.cpp, tests/bridge/contact/layer_impacts_test.cpp.
#include <algorithm>

#include <weft/bridge/classic/attachment.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

// They touch or hang on the same dynamic bodies, or may meet each other, or do so by way of others.
SoftBodySolver::Attachments::Group SoftBodySolver::Attachments::group_of(
    Attachment& first, const std::function<int(const Attachment*)>& count) const {
  std::vector<Attachment*> members{&first};
  int num_substeps = 1;
  std::vector<MovableObject> reached;
  for (std::size_t g = 0; g < members.size(); ++g) {
    const Attachment& member = *members[g];
    num_substeps = std::max(num_substeps, count(&member));
    member.fast->list_dynamic(*member.body, reached);
    for (Attachment* other : stepped) {
      if (std::find(members.begin(), members.end(), other) != members.end()) continue;
      std::vector<MovableObject> of_other;
      other->fast->list_dynamic(*other->body, of_other);
      const bool shares = std::any_of(of_other.begin(), of_other.end(), [&](const auto& one) {
        return std::find(reached.begin(), reached.end(), one) != reached.end();
      });
      if (shares || pairs.are_pair(*member.body, *other->body)) members.push_back(other);
    }
  }
  return {members, num_substeps};
}

// Bodies that may meet cloth have implicit substeps: impulses between layers are given to the solver of springs.
SubstepPlan SoftBodySolver::Attachments::plan_of_stepped(int num_implicit, bool has_layers,
                                                         btScalar time_step) const {
  if (has_layers) return {num_implicit, false, num_implicit};
  btScalar num_explicit = 1;
  int last_num_implicit = 1;
  for (const Attachment* one : stepped) {
    num_explicit = std::max(num_explicit, one->fast->num_explicit_substeps(time_step));
    last_num_implicit = std::max(last_num_implicit, one->fast->last_num_substeps());
  }
  return plan_substeps(num_implicit, last_num_implicit, num_explicit);
}

bool SoftBodySolver::Attachments::meet_other_solvers() const {
  return std::any_of(stepped.begin(), stepped.end(),
                     [](const Attachment* one) { return one->body->m_scontacts.size() > 0; });
}

bool SoftBodySolver::Attachments::is_stepped(const btSoftBody& body) const {
  return std::any_of(stepped.begin(), stepped.end(),
                     [&](const Attachment* one) { return one->body == &body; });
}

ClothPairs SoftBodySolver::Attachments::take_other_pairs() {
  return pairs.take_apart([this](const btSoftBody& body) { return is_stepped(body); });
}

void SoftBodySolver::Attachments::drop_stopped_pairs() {
  pairs.drop_stopped([this](const btSoftBody& body) { return !is_stepped(body); });
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
