// What a solver does in each step.
// Tested by tests/bridge/solver_test.cpp, tests/bridge/solver_checks_test.cpp.
#include <weft/bridge/solver.hpp>

#include <algorithm>
#include <optional>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/classic/body_lists.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/bridge/implicit/history/node_prediction.hpp>
#include <weft/bridge/rigid/rigid_substeps.hpp>
#include <weft/core/parallel/parallel_for.hpp>
#include <weft/core/parallel/threads.hpp>
#include <weft/core/trace.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void SoftBodySolver::predictMotion(btScalar time_step) {
  const TraceScope trace("predict motion");
  time_step_ = time_step;
  attachments_->note_order();
  attachments_->hulls.begin_step();
  for (const auto& entry : attachments_->contacts) entry->begin_step();
  attachments_->pairs.clear();
  for (const auto& attachment : attachments_->list) {
    attachment->concave_met.clear();
    attachment->has_ended = false;
    if (attachment->fast && attachment->was_in_world) attachment->begin_fast_step();
  }
  for_bodies([&](btSoftBody&, Attachment* attachment) {
    if (!attachment) return;
    attachment->predict(time_step);
    attachment->rigid_response.begin_step();
  });
  for (int i = 0; i < m_softBodySet.size(); ++i) {
    btSoftBody& body = *m_softBodySet[i];
    if (!body.isActive() || is_still(body)) continue;  // the forces may have exploded
    Attachment* const attachment = find(body);
    if (attachment && attachment->fast) {
      publish_bounds(body);
    } else {
      body.predictMotion(time_step);
      if (attachment) attachment->check_prediction();
    }
    if (attachment) attachment->is_moving = true;
  }
}

// What touches only the body: several at the same time. Each is one task, whose bits depend on no other.
void SoftBodySolver::for_bodies(const std::function<void(btSoftBody&, Attachment*)>& work) {
  const auto work_on = [&](int i) {
    btSoftBody& body = *m_softBodySet[i];
    if (!body.isActive() || is_still(body)) return;
    Attachment* const attachment = find(body);
    if (!attachment) return work(body, nullptr);
    attachment->guard([&] { work(body, attachment); });
  };
  if (m_softBodySet.size() == 1) return work_on(0);
  parallel_for(static_cast<std::size_t>(m_softBodySet.size()),
               [&](std::size_t i) { work_on(static_cast<int>(i)); });
}

namespace {

/// Whether contacts between cloths, or of one with itself, may move nodes in this step. Those of bodies with other solvers do
/// so once fast bodies are solved.
bool may_cloth_meet(const btAlignedObjectArray<btSoftBody*>& bodies,
                    const std::vector<std::unique_ptr<ContactEntry>>& entries) {
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->m_scontacts.size() > 0) return true;
  }
  return std::any_of(entries.begin(), entries.end(),
                     [](const auto& entry) { return entry->was_in_world; });
}

/// Solves bodies that share nothing with others, which leave the list. all: those of the world.
template <class Entry>
void solve_alone(btScalar time_step, const btAlignedObjectArray<btSoftBody*>& all,
                 const std::vector<std::unique_ptr<ContactEntry>>& contacts,
                 std::vector<Entry*>& bodies, std::vector<Entry*>& alone) {
  if (may_cloth_meet(all, contacts)) return;
  const auto first = std::stable_partition(bodies.begin(), bodies.end(), [](const Entry* one) {
    return !one->fast->is_alone(*one->body);
  });
  alone.assign(first, bodies.end());
  bodies.erase(first, bodies.end());
  if (!alone.empty()) in_parallel(alone, [&](Entry& one) { one.solve_alone(time_step); });
}

}  // namespace

void SoftBodySolver::solve_fast_bodies() {
  std::vector<Attachment*>& bodies = attachments_->stepped;
  bodies.clear();
  for (const auto& attachment : attachments_->list) {
    const bool is_stepped = attachment->was_in_world && attachment->body->isActive();
    if (attachment->fast && is_stepped && attachment->fast->is_predicted() &&
        !is_still(*attachment->body)) {
      bodies.push_back(attachment.get());
    }
  }
  const int num_each = std::max(1, num_threads() / std::max(1, static_cast<int>(bodies.size())));
  for (Attachment* one : bodies) one->fast->set_num_threads(num_each);
  solve_alone(time_step_, m_softBodySet, attachments_->contacts, bodies, attachments_->asked);
  Attachment* const single = bodies.size() == 1 ? bodies[0] : nullptr;
  std::optional<fast::WorkerTeam::Scope> threads;
  const bool may_meet = may_meet_cloth();                        // which has threads of its own
  if (single && !may_meet) single->fast->hold_threads(threads);  // to call for them takes long
  in_parallel(bodies, [](Attachment& one) { one.fast->prepare(*one.body); });
  attachments_->foresee_contacts(time_step_);
  detect_contacts(time_step_);
  solve_in_substeps();
  if (bodies.empty()) return;
  solve_listed_bodies(time_step_);
  attachments_->share_cloth_impulses(time_step_);
  apply_listed_solutions(time_step_, may_meet);
  const bool is_final = single && !may_meet && single->limits.is_empty() &&
                        m_softBodySet.size() == 1 && !single->blow_up;
  if (is_final) single->fast->update_normals(*single->body);
}

void SoftBodySolver::detect_contacts(btScalar time_step) {
  std::vector<Attachment*>& bodies = attachments_->stepped;
  in_parallel(bodies, [&](Attachment& one) {
    if (one.fast->detects_alone()) one.fast->detect_contacts(*one.body, time_step);
  });
  in_turn(bodies, [&](Attachment& one) {
    if (!one.fast->detects_alone()) one.fast->detect_contacts(*one.body, time_step);
  });
}

// Bodies with the same substeps are solved together, and leave the list.
void SoftBodySolver::solve_in_substeps() {
  std::vector<Attachment*>& bodies = attachments_->stepped;
  if (attachments_->meet_other_solvers()) return;
  const auto count = [this](const Attachment* one) {
    return std::max(one->fast->num_substeps(*one->body, time_step_),
                    attachments_->num_layer_substeps(*one->body, time_step_));
  };
  while (true) {
    const auto first = std::find_if(bodies.begin(), bodies.end(),
                                    [&](const Attachment* one) { return count(one) > 1; });
    if (first == bodies.end()) return;
    const auto [group, num_substeps] = attachments_->group_of(**first, count);
    std::vector<Attachment*> rest = bodies;
    std::erase_if(rest, [&, &members = group](const Attachment* one) {
      return std::find(members.begin(), members.end(), one) != members.end();
    });
    solve_group(group, num_substeps);
    bodies = rest;
  }
}

void SoftBodySolver::solve_group(const std::vector<Attachment*>& group, int num_implicit) {
  std::vector<Attachment*>& bodies = attachments_->stepped;
  bodies = group;
  const bool has_layers = may_meet_cloth();
  const SubstepPlan plan = attachments_->plan_of_stepped(num_implicit, has_layers, time_step_);
  const TraceScope trace("step in parts");
  const btScalar substep_time = time_step_ / static_cast<btScalar>(plan.count);
  std::vector<MovableObject> dynamic;
  for (const Attachment* one : group) one->fast->list_dynamic(*one->body, dynamic);
  RigidSubsteps rigid(dynamic, time_step_, plan.count);
  for (std::size_t b = 0; b < dynamic.size(); ++b) {
    const bool is_borne = std::any_of(group.begin(), group.end(), [&](const Attachment* one) {
      return one->fast->pushed().has_borne(dynamic[b], time_step_);
    });
    if (is_borne) rigid.share_out_gravity(b, group.front()->body->m_worldInfo->m_dispatcher);
  }
  ClothPairs other_pairs = attachments_->take_other_pairs();
  in_parallel(bodies, [&](Attachment& one) { one.fast->begin_substeps(*one.body, time_step_); });
  for (int substep = 0; substep < plan.count && !bodies.empty(); ++substep) {
    in_parallel(bodies, [&](Attachment& one) {
      one.fast->begin_substep(*one.body, rigid, substep, plan, substep_time);
    });
    rigid.begin_substep();
    detect_contacts(substep_time);
    for (Attachment* one : bodies) one->body->m_scontacts.resizeNoInitialize(0);
    solve_listed_bodies(substep_time);
    attachments_->share_cloth_impulses(substep_time);
    apply_listed_solutions(substep_time, has_layers);
    rigid.end_substep();
  }
  rigid.finish();
  attachments_->pairs.take_back(std::move(other_pairs));
  in_parallel(bodies, [&](Attachment& one) { one.fast->end_substeps(*one.body, time_step_); });
}

bool SoftBodySolver::may_meet_cloth() const {
  const std::vector<Attachment*>& bodies = attachments_->stepped;
  return std::any_of(bodies.begin(), bodies.end(), [&](const Attachment* one) {
    return one->body->m_scontacts.size() > 0 || find_contact(*one->body) != nullptr;
  });
}

void SoftBodySolver::solve_listed_bodies(btScalar time_step) {
  std::vector<Attachment*>& bodies = attachments_->stepped;
  std::vector<const void*>& pushed = attachments_->pushed;
  const auto list_coupled = [&] {
    pushed.clear();
    for (const Attachment* one : bodies) one->fast->list_coupled(*one->body, pushed);
    std::sort(pushed.begin(), pushed.end());
  };
  list_coupled();
  in_parallel(bodies,
              [&](Attachment& one) { one.fast->begin_solve(*one.body, time_step, pushed); });
  std::vector<Attachment*>& asked = attachments_->asked;
  asked.assign(bodies.begin(), bodies.end());
  for (int look = 0; look < FastBody::kMostRedetections && !asked.empty(); ++look) {
    in_parallel(asked, [&](Attachment& one) {
      if (one.fast->detects_alone()) one.fast->redetect_contacts(*one.body, time_step);
    });
    in_turn(asked, [&](Attachment& one) {
      if (!one.fast->detects_alone()) one.fast->redetect_contacts(*one.body, time_step);
    });
    std::erase_if(asked, [](const Attachment* one) { return !one->fast->is_unfinished(); });
    drop_stopped(bodies);
    list_coupled();
    in_parallel(asked,
                [&](Attachment& one) { one.fast->solve_again(*one.body, time_step, pushed); });
  }
  in_parallel(bodies,
              [&](Attachment& one) { one.fast->solve_anew_if_it_gains(*one.body, time_step); });
}

void SoftBodySolver::apply_listed_solutions(btScalar time_step, bool may_meet) {
  std::vector<Attachment*>& bodies = attachments_->stepped;
  in_turn(bodies,
          [&](Attachment& one) { one.fast->apply_solution(*one.body, time_step, may_meet); });
  // Where springs have led the nodes, not where they would fly without them: in steps of 1/100 s layers that were found there
  // threw each other about.
  attachments_->pairs.add_contacts(time_step);
  const bool meet = std::any_of(bodies.begin(), bodies.end(), [](const Attachment* one) {
    return one->body->m_scontacts.size() > 0;
  });
  for (int sweep = 0; meet && sweep < FastBody::kClothContactSweeps; ++sweep) {
    in_turn(bodies, [](Attachment& one) { one.fast->project_cloth_contacts(*one.body); });
  }
  attachments_->keep_layers_apart();
  in_parallel(bodies, [&](Attachment& one) { one.fast->end_solve(*one.body, time_step); });
}

void SoftBodySolver::solveConstraints(btScalar /*time_step*/) {
  const TraceScope trace("solve constraints");
  // Velocities decay over the step that predictMotion was given. The argument here is the same time
  // before Bullet rounds it to single precision; to use it would mix two clocks in one step.
  solve_fast_bodies();
  for (const auto& entry : attachments_->contacts) {
    const bool may_be_pushed = entry->was_in_world && entry->contact.settings().with_others;
    if (may_be_pushed && is_fast(*entry->body)) entry->remember_solution();
  }
  for (int i = 0; i < m_softBodySet.size(); ++i) {
    btSoftBody& body = *m_softBodySet[i];
    if (!body.isActive() || is_still(body) || is_fast(body)) continue;
    Attachment* const attachment = find(body);
    if (attachment) {
      attachment->guard([&] { solve_other_body(body, attachment); });
    } else {
      solve_other_body(body, nullptr);
    }
  }
  settle_contact_velocities();
  for_bodies([&](btSoftBody&, Attachment* attachment) {
    if (attachment && !attachment->has_ended) attachment->finish_velocities(time_step_);
  });
  for (const auto& attachment : attachments_->list) {
    if (attachment->was_in_world) attachment->time += static_cast<double>(time_step_);
  }
}

// One that is not fast.
void SoftBodySolver::solve_other_body(btSoftBody& body, Attachment* attachment) {
  ContactEntry* const entry = find_contact_entry(body);
  if (entry) entry->contact.add_self_contacts(body, time_step_);
  if (attachment && attachment->has_coulomb_contacts()) {
    attachment->rigid_response.solve(body);
  } else {
    body.solveConstraints();
  }
  if (entry && entry->contact.settings().with_others && attachment) entry->remember_solution();
}

// A contact of a later body moves the nodes of an earlier one, whose velocities Bullet has derived by
// then: without this their momentum would be lost.
void SoftBodySolver::settle_contact_velocities() {
  for (const auto& entry : attachments_->contacts) {
    btSoftBody& body = *entry->body;
    if (!entry->was_in_world || !entry->contact.settings().with_others) continue;
    if (!body.isActive() || is_still(body)) continue;
    const Attachment* const attachment = find(body);
    if (attachment && (attachment->fast || attachment->has_coulomb_contacts())) {
      entry->add_later_motion();
    } else {
      entry->derive_velocities();
    }
  }
}

// The last thing that Bullet does in a step: positions and velocities are final.
void SoftBodySolver::updateSoftBodies() {
  const TraceScope trace("update soft bodies");
  for_bodies([&](btSoftBody& body, Attachment* attachment) {
    if (attachment && attachment->has_ended) return;
    if (!attachment || !attachment->fast) return body.integrateMotion();
    if (!attachment->fast->has_normals()) attachment->fast->update_normals(body);
    attachment->end_fast_step(time_step_);
  });
  for (const auto& attachment : attachments_->list) attachment->is_moving = false;
  if (is_deferred_) {
    for_bodies([&](btSoftBody&, Attachment* attachment) {
      if (attachment) attachment->begin_forces();
    });
  }
  tell_of_blow_ups();
}

// The step that is about to end is no place for an exception: one that a callback lets go ends the program.
void SoftBodySolver::tell_of_blow_ups() noexcept {
  struct News {
    Cloth cloth;
    BodyBlowUp blow_up;
    std::function<void(const BodyBlowUp&)> callback;
  };
  std::vector<News> news;  // callbacks may attach, detach and set others
  std::vector<std::pair<Cloth, std::function<void(const std::vector<ClothContactPoint>&)>>> touched;
  const auto callback = attachments_->on_blow_up;
  for (const auto& attachment : attachments_->list) {
    if (attachment->on_contact && attachment->was_in_world && !attachment->blow_up) {
      touched.emplace_back(cloth(*attachment->body), attachment->on_contact);
    }
    if (!attachment->blow_up || attachment->is_reported) continue;
    if (!callback && !attachment->on_blow_up) continue;
    attachment->is_reported = true;
    news.push_back({cloth(*attachment->body), *attachment->blow_up, attachment->on_blow_up});
  }
  for (const News& one : news) {
    if (one.callback) one.callback(one.blow_up);
    if (callback && one.cloth.body() != nullptr) callback(*one.cloth.body(), one.blow_up);
  }
  for (const auto& [cloth, tell] : touched) {
    const std::vector<ClothContactPoint> contacts = cloth.contacts();
    if (!contacts.empty()) tell(contacts);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
