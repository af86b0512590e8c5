// Bodies with implicit springs that meet each other in a step.
// Tested by tests/bridge/contact/cloth_pairs_test.cpp.
#include <algorithm>
#include <cmath>

#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/classic/body_lists.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How often impulses are found and given to the solver. One leaves twice the stretch in a pile, four gain little.
constexpr int kRounds = 2;

int most_layer_substeps(btScalar time_step) {
  constexpr btScalar kLongest = btScalar(1.0 / 240);  // [s]
  constexpr btScalar kRounding = btScalar(1e-3);
  return std::max(1, static_cast<int>(std::ceil(time_step / kLongest - kRounding)));
}

}  // namespace

bool SoftBodySolver::Attachments::add_pair(const Attachment* one, ClothContact& contact,
                                           const Attachment* other, ClothContact& other_contact) {
  const auto is_solved_for = [](const Attachment* attachment) {
    return attachment && attachment->fast && attachment->fast->is_predicted();
  };
  if (!is_solved_for(one) || !is_solved_for(other)) return false;
  pairs.add(*one->body, contact, *other->body, other_contact);
  return true;
}

ContactEntry* SoftBodySolver::Attachments::contact_of(const btSoftBody& body) const {
  for (const auto& entry : contacts) {
    if (entry->is_of(body)) return entry.get();
  }
  return nullptr;
}

void SoftBodySolver::Attachments::add_self_pairs() {
  for (const Attachment* one : stepped) {
    ContactEntry* const entry = contact_of(*one->body);
    if (entry && entry->contact.settings().with_itself) pairs.add_self(*one->body, entry->contact);
  }
}

// Layers that lie on each other give way only after springs are solved for, and what falls by g h^2 in between stretches springs. That
// energy grows with h^4: sheets on each other throw each other about in steps of 1/60 s, and lie in those of 1/240 s.
int SoftBodySolver::Attachments::num_layer_substeps(const btSoftBody& body,
                                                    btScalar time_step) const {
  const ContactEntry* const entry = contact_of(body);
  const bool is_asked = entry != nullptr && entry->was_in_contact;
  // A body that encloses a volume is no layer, and lies well on others in steps of 1/60 s.
  return is_asked && !entry->contact.encloses_volume() ? most_layer_substeps(time_step) : 1;
}

// Where nodes would fly without springs. The first contact would be the hardest one.
void SoftBodySolver::Attachments::foresee_contacts(btScalar time_step) {
  add_self_pairs();
  drop_stopped_pairs();
  if (pairs.empty() || meet_other_solvers() || most_layer_substeps(time_step) == 1) return;
  pairs.add_contacts(time_step);
  for (const Attachment* one : stepped) {
    auto& found = one->body->m_scontacts;
    if (found.size() > 0) contact_of(*one->body)->was_in_contact = true;
    found.resizeNoInitialize(0);
  }
}

void SoftBodySolver::Attachments::keep_layers_apart() {
  for (const Attachment* one : stepped) {
    if (ContactEntry* const entry = contact_of(*one->body))
      entry->is_in_contact = entry->is_in_contact || one->body->m_scontacts.size() > 0;
  }
  drop_stopped_pairs();
  if (pairs.empty()) return;
  pairs.keep_apart([this](const btSoftBody& body, const LayerImpacts::Outcome& outcome) {
    if (outcome.num_impacts > 0) contact_of(body)->is_in_contact = true;
    const auto one = std::find_if(stepped.begin(), stepped.end(),
                                  [&](const Attachment* each) { return each->body == &body; });
    if (!outcome.is_clear && one != stepped.end()) (*one)->fast->note_unsolved();
  });
}

// A contact moves the nodes at it, and what springs make of that would come a step late: a body that lies on another is carried
// by a few nodes, which it would sink over and draw out as spikes. So these impulses are part of the solution. Each round
// gives what is still missing, and no more than that: projections that move nodes alone know none of the mass behind them.
void SoftBodySolver::Attachments::share_cloth_impulses(btScalar time_step) {
  drop_stopped_pairs();
  if (pairs.empty()) return;
  pairs.set_others_aside();
  for (int round = 0; round < kRounds; ++round) {
    in_parallel(stepped, [](Attachment& one) { one.fast->write_positions(*one.body); });
    if (!pairs.find_contacts(time_step)) break;
    for (int sweep = 0; sweep < FastBody::kClothContactSweeps; ++sweep) {
      in_turn(stepped, [](Attachment& one) { one.fast->project_cloth_contacts(*one.body); });
    }
    in_parallel(stepped, [&](Attachment& one) {
      one.fast->solve_again(*one.body, time_step, pushed, true);
    });
  }
  pairs.take_others_back();
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
