#include <weft/bridge/classic/attachment.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <weft/bridge/adoption/suitable_body.hpp>
#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/classic/nodes/position_limits.hpp>
#include <weft/bridge/implicit/history/node_prediction.hpp>
#include <weft/core/trace.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

using LawSet = forces::LawSet<btScalar>;
using Level = forces::LawTraits::Level;
using State = forces::State<btScalar>;

// Laws made for another mesh throw here, at attach, and not in Bullet's step.
SoftBodySolver::Attachment::Attachment(btSoftBody& of, LawSet own_laws,
                                       VectorX<btScalar> own_masses, DampingPlace place)
    : body(&of), laws(std::move(own_laws)), damping(place) {
  check_attachment("soft body solver", of, own_masses);
  followed = FollowedMasses(of, std::move(own_masses));
  read_nodes(of, positions, velocities);
  forces.setZero(3, positions.cols());
  const State state{positions, velocities, masses(), time};
  (void)laws.add_forces(state, LawSet::VelocityLaws::kAsForces, forces);
  laws.redistribute_forces(state, forces);
  life = follow_life(of);
}

void SoftBodySolver::Attachment::follow_masses() {
  const int node = followed.follow(*body);
  if (node < 0) return;
  const Eigen::Index num_nodes = masses().size();
  for (Eigen::Index i = 0; i < num_nodes; ++i) {
    if (masses()[i] > 0 && std::isfinite(masses()[i])) continue;
    blow_up =
        BodyBlowUp{static_cast<int>(i),
                   "its m_im is not a number, negative or infinite, expected 1 / mass [1/kg]"};
    return;
  }
  if (!fast) return;
  // No spring is another one.
  fast->tear({}, std::vector<char>(static_cast<std::size_t>(num_nodes), 0), masses().cast<double>(),
             {});
}

void SoftBodySolver::Attachment::stop(std::string reason) {
  blow_up = BodyBlowUp{-1, std::move(reason)};
  deferred.drop();
  if (!is_moving) return;
  is_moving = false;
  for (int i = 0; i < body->m_nodes.size(); ++i) body->m_nodes[i].m_x = body->m_nodes[i].m_q;
}

bool SoftBodySolver::Attachment::acts_after_projection(Level level) const {
  if (!laws.has_level(level)) return false;
  if (damping != DampingPlace::kAutomatic) return damping == DampingPlace::kAfterProjection;
  return level == Level::kVelocity || body->m_links.size() > 0 || fast != nullptr;
}

// Velocity-level laws state how fast velocities decay: inertia does not slow them down.
void SoftBodySolver::Attachment::sum_laws() {
  const State state{positions, velocities, masses(), time};
  const forces::ForceReport report = deferred.finish(state, forces);
  if (!report.ok()) {
    blow_up = BodyBlowUp{*report.first_non_finite_node, "position or velocity is not finite"};
    return;
  }
  if (!acts_after_projection(Level::kInertia)) laws.redistribute_forces(state, forces);
  if (!acts_after_projection(Level::kVelocity)) {
    (void)laws.add_forces(state, LawSet::VelocityLaws::kAlone, forces);
  }
}

void SoftBodySolver::Attachment::begin_fast_step() {
  fast->begin_step(*body);
  for (const auto& [first, second, rest_length] : links.changes(*body)) {
    fast->set_rest_length(first, second, rest_length);
  }
}

// Bullet tells of each triangle of a concave object near the body, as of a solid.
bool SoftBodySolver::Attachment::collide(const btCollisionObjectWrapper& object, HullTable& hulls,
                                         btScalar time_step) {
  const btCollisionObject& whole = *object.getCollisionObject();
  if (!fast && !(has_coulomb_contacts() && RigidResponse::knows(whole))) return false;
  if (!moves_finitely(whole)) return true;
  const btCollisionShape* const concave = concave_shape_of(object);
  if (concave != nullptr) {
    if (std::find(concave_met.begin(), concave_met.end(), &whole) != concave_met.end()) return true;
    concave_met.push_back(&whole);
  }
  const btCollisionObjectWrapper met(
      nullptr, concave != nullptr ? concave : object.getCollisionShape(), &whole,
      concave != nullptr ? whole.getWorldTransform() : object.getWorldTransform(), -1, -1);
  if (!fast) {
    rigid_response.collide(*body, met, hulls, time_step);
    return true;
  }
  fast->meet(whole, met.getWorldTransform());
  if (!fast->is_asleep()) fast->collide(*body, met, hulls, time_step);
  return true;
}

void SoftBodySolver::Attachment::predict(btScalar time_step) {
  follow_masses();
  if (!blow_up) blow_up = blow_up_by_pressure(*body, time_step, kMaxSpeed);
  if (blow_up) return;
  // The program may have done since what attach() and attach_fast() refuse.
  if (fast) {
    auto reason = reason_against_implicit(*body);
    if (!reason) reason = links.reason_against(*body);
    if (reason) return stop("it cannot be fast any more: " + *reason);
  }
  if (body->m_cfg.timescale != btScalar(1)) {
    return stop("m_cfg.timescale = " + std::to_string(body->m_cfg.timescale) + " [1], expected 1");
  }
  const bool is_measured_anew = body->m_bUpdateRtCst;
  const auto predict_fast = [&] {
    fast->predict(*body, time_step, positions, velocities);
    if (is_measured_anew) links.restore(*body);
    check_prediction();
  };
  const bool fits = masses().size() == body->m_nodes.size();  // if not, the laws say so
  if (fast && fits) fast->apply_external_impulses(*body, time_step);
  if (fast && fits && !deferred.is_in_flight() && laws.is_node_by_node()) {
    const auto threads = fast->hold_threads();
    if (add_forces_node_by_node(time_step)) return predict_fast();
  }
  add_forces(time_step);
  if (fast && !blow_up) predict_fast();
}

// Bullet adds wind, pressure and volume on its own, and divides by areas and volumes that may be none.
void SoftBodySolver::Attachment::check_prediction() {
  if (!is_plain(*body)) check_motion("velocity is not finite after forces of Bullet's own (m_cfg)");
}

void SoftBodySolver::Attachment::check_motion(const char* fault) {
  const int first = first_non_finite_node(*body);
  if (first < 0) return;
  blow_up = BodyBlowUp{first, fault};
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    body->m_nodes[i].m_x = body->m_nodes[i].m_q;
    body->m_nodes[i].m_v.setZero();
  }
}

// add_forces() by the threads that work on the body, each on its own nodes, which are in its cache. False if something
// is wrong with any of them; then nothing has been done to the body.
bool SoftBodySolver::Attachment::add_forces_node_by_node(btScalar time_step) {
  const TraceScope trace("forces");
  for (Matrix3X<btScalar>* vectors : {&positions, &velocities, &forces}) {
    vectors->resize(3, body->m_nodes.size());
  }
  std::atomic<bool> is_fine = true;
  fast->for_nodes([&](int begin, int count) {
    const fast::NodeRange nodes{begin, begin + count};
    read_nodes(*body, nodes, positions, velocities);
    const State state{positions.middleCols(begin, count), velocities.middleCols(begin, count),
                      masses().segment(begin, count), time};
    auto sum = forces.middleCols(begin, count);
    sum.setZero();
    bool is_finite = false;
    try {
      is_finite = laws.add_forces(state, LawSet::VelocityLaws::kSeparate, sum).ok();
      if (!acts_after_projection(Level::kVelocity)) {
        (void)laws.add_forces(state, LawSet::VelocityLaws::kAlone, sum);
      }
    } catch (...) {  // it must not leave another thread; add_forces() meets it again
      is_finite = false;
    }
    if (!is_finite ||
        predicted_blow_up(*body, velocities, forces, time_step, SoftBodySolver::kMaxSpeed, nodes)) {
      is_fine = false;
    }
  });
  if (!is_fine) return false;
  fast->for_nodes([&](int begin, int count) {
    add_node_forces(forces, {begin, begin + count}, *body);
  });
  return true;
}

void SoftBodySolver::Attachment::add_forces(btScalar time_step) {
  const TraceScope trace("forces");
  read_nodes(*body, positions, velocities);
  if (acts_after_projection(Level::kInertia)) start_velocities = velocities;
  sum_laws();
  if (blow_up) return;
  // Now, on the velocities that predictMotion is about to make: afterwards would be too late, for a
  // node whose position is not finite ruins the body's bounding-volume tree.
  blow_up = predicted_blow_up(*body, velocities, forces, time_step, SoftBodySolver::kMaxSpeed);
  if (!blow_up) add_node_forces(forces, *body);
}

// On other threads, from a copy of the state: the body may leave or be deleted meanwhile.
void SoftBodySolver::Attachment::begin_forces() {
  read_nodes(*body, positions, velocities);
  deferred.begin({positions, velocities, masses(), time});
}

// The change of momentum over the step stands for the sum of all forces on the body.
void SoftBodySolver::Attachment::slow_down_changes() {
  forces = (velocities - start_velocities) * masses().asDiagonal();
  laws.redistribute_forces(State{positions, velocities, masses(), time}, forces);
  velocities = start_velocities + forces * masses().cwiseInverse().asDiagonal();
}

void SoftBodySolver::Attachment::damp_velocities(btScalar time_step) {
  const TraceScope trace("damp velocities");
  const bool slows_down = acts_after_projection(Level::kInertia);
  const bool advances = acts_after_projection(Level::kVelocity);
  if (!slows_down && !advances) return;
  read_nodes(*body, positions, velocities);
  if (slows_down) slow_down_changes();
  if (advances) {
    forces = velocities;  // the laws see the state as it is and change a copy
    laws.advance_velocities(State{positions, velocities, masses(), time}, time_step, forces);
    velocities.swap(forces);
  }
  write_node_velocities(velocities, *body);
}

void SoftBodySolver::Attachment::solve_alone(btScalar time_step) {
  if (!fast->repeat_step(*body, time_step)) solve_by_stages(time_step);
  finish_velocities(time_step);
  fast->update_normals(*body);
  end_fast_step(time_step);
  has_ended = true;
}

void SoftBodySolver::Attachment::solve_by_stages(btScalar time_step) {
  const auto threads = fast->hold_threads();  // to call for them takes longer than most loops
  fast->prepare(*body);
  fast->detect_contacts(*body, time_step);
  fast->begin_solve(*body, time_step, {});
  for (int look = 0; look < FastBody::kMostRedetections; ++look) {
    fast->redetect_contacts(*body, time_step);
    if (!fast->is_unfinished()) break;
    fast->solve_again(*body, time_step, {});
  }
  fast->solve_anew_if_it_gains(*body, time_step);
  fast->apply_solution(*body, time_step, false);
  fast->end_solve(*body, time_step);
}

void SoftBodySolver::Attachment::finish_velocities(btScalar time_step) {
  apply_position_limits(limits, static_cast<double>(time_step), *body);
  damp_velocities(fast ? fast->velocity_step() : time_step);
  check_motion("position or velocity is not finite after the step");
}

void SoftBodySolver::Attachment::end_fast_step(btScalar time_step) {
  if (blow_up) return;
  if (limits.is_empty()) fast->end_step(*body, time_step);
  fast->note_velocities(*body);
}

SoftBodySolver::Attachment* SoftBodySolver::Attachments::find(const btSoftBody& body) const {
  const auto known = std::lower_bound(order.begin(), order.end(), std::pair(&body, std::size_t{0}));
  if (known != order.end() && known->first == &body && known->second < list.size()) {
    Attachment& attachment = *list[known->second];
    if (attachment.is_of(body)) return &attachment;  // the list may have changed since
  }
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& one) { return one->is_of(body); });
  return found != list.end() ? found->get() : nullptr;
}

void SoftBodySolver::Attachments::note_order() {
  order.clear();
  for (std::size_t k = 0; k < list.size(); ++k) order.emplace_back(list[k]->body, k);
  std::sort(order.begin(), order.end());
}

void ContactEntry::remember_solution() {
  solved.resize(static_cast<std::size_t>(body->m_nodes.size()));
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    solved[static_cast<std::size_t>(i)] = body->m_nodes[i].m_x;
  }
}

void ContactEntry::derive_velocities() {
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    btSoftBody::Node& node = body->m_nodes[i];
    node.m_v = (node.m_x - node.m_q) * body->m_sst.isdt;
  }
}

void ContactEntry::add_later_motion() {
  const btScalar share = body->m_sst.isdt * (1 - body->m_cfg.kDP);
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    btSoftBody::Node& node = body->m_nodes[i];
    node.m_v += share * (node.m_x - solved[static_cast<std::size_t>(i)]);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
