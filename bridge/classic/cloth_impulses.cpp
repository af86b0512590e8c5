// Bodies with implicit springs that meet each other in a step.
// Tested by tests/bridge/contact/cloth_pairs_test.cpp.
#include <algorithm>

#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/classic/body_lists.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// How often impulses are found and given to the solver. One leaves twice the stretch in a pile, four gain little.
constexpr int kRounds = 2;

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

// A contact moves the nodes at it, and what springs make of that would come a step late: a body that lies on another is carried
// by a few nodes, which it would sink over and draw out as spikes. So these impulses are part of the solution. Each round
// gives what is still missing, and no more than that: projections that move nodes alone know none of the mass behind them.
void SoftBodySolver::Attachments::share_cloth_impulses(btScalar time_step) {
  pairs.drop_stopped([this](const btSoftBody& body) {
    return std::none_of(stepped.begin(), stepped.end(),
                        [&](const Attachment* one) { return one->body == &body; });
  });
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
