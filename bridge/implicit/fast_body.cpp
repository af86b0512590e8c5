#include <weft/bridge/implicit/fast_body.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/nodes/node_state.hpp>
#include <weft/bridge/implicit/energy_limit.hpp>
#include <weft/bridge/implicit/history/node_prediction.hpp>
#include <weft/core/trace.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// [m] Positions are counted from a multiple of this near the body.
constexpr btScalar kOriginGrid = btScalar(0.25);
constexpr btScalar kFarFromOrigin = 2;  // [m] from which on another one is chosen
/// The longest step of a program that can still be played [s].
constexpr btScalar kLongestStep = btScalar(1) / 15;
void include_in_bounds(const Matrix3X<btScalar>& positions, btSoftBody& body) {
  body.m_bounds[0].setMin(to_bullet(positions.rowwise().minCoeff()));
  body.m_bounds[1].setMax(to_bullet(positions.rowwise().maxCoeff()));
}

}  // namespace

FastBody::FastBody(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
                   VectorX<double> masses, const FastSettings& settings)
    : bending_(mesh, laws),
      network_(fast::make_network(mesh, laws)),
      masses_(std::move(masses)),
      wave_speed_(wave_speed(network_, masses_)),
      explicit_(network_, masses_),
      settings_(settings) {
  check(settings);
  bending_.set_masses(masses_);
  set_num_nodes(masses_.size());
}

// A rest length changes forces, and no basis that the solver has made of stiffness.
void FastBody::set_rest_length(int first, int second, double rest_length) {
  fast::set_rest_length(first, second, rest_length, network_);
  fast::set_rest_length(first, second, rest_length, limited_.as_given);
  if (solver_) solver_->set_rest_length(first, second, rest_length);
  ++history_.num_new_rest_lengths;
  wake();
}

// What the body knew of the steps before is of other nodes.
void FastBody::tear(const fast::SpringNetwork& springs, const std::vector<char>& is_changed,
                    VectorX<double> masses, const std::vector<int>& origins) {
  masses_ = std::move(masses);
  explicit_.forget();
  history_.is_replaced = true;
  bending_.set_masses(masses_);
  set_num_nodes(masses_.size());
  if (solver_) {
    if (limited_.as_given.edges.cols() > 0) {
      fast::replace_springs(is_changed, springs, limited_.as_given);
    }
    fast::SpringNetwork limited = springs;
    limit_stiffness(limited_.step, masses_, limited);
    solver_->tear(limited, is_changed, masses_, origins);
    for (const int origin : origins) {
      if (!is_free_[static_cast<std::size_t>(origin)]) {
        solver_pins_.push_back(static_cast<int>(is_free_.size()));
      }
      is_free_.push_back(is_free_[static_cast<std::size_t>(origin)]);
    }
  } else {
    fast::replace_springs(is_changed, springs, network_);
  }
  contacts_.clear();
  colliders_.clear();
  swept_.invalidate();
  excess_ = 0;
  force_history_.forget();
  last_step_ = 0;
  wake();
}

void FastBody::wake() {
  if (is_asleep()) {
    last_step_ = 0;
    excess_ = 0;
  }
  sleep_.wake();
  steady_.forget();
}

btVector3 FastBody::in_world(int node) const {
  return to_bullet(positions_.col(node) + origin_);
}

// Far from the world's origin numbers in single precision are coarse. A multiple of a power of two changes them
// least: what is near the world's origin stays as it is.
void FastBody::choose_origin(const btSoftBody& body) {
  if (body.m_nodes.size() == 0) return;
  const Vector3<btScalar> near = from_bullet<btScalar>(body.m_nodes[0].m_x);
  const bool is_far = (near - origin_).norm() > kFarFromOrigin;
  if ((last_starts_.cols() > 0 && !is_far) || !near.allFinite()) return;
  const Vector3<btScalar> origin = (near / kOriginGrid).array().round() * kOriginGrid;
  last_starts_.colwise() += origin_ - origin;
  positions_.colwise() += origin_ - origin;
  origin_ = origin;
}

void FastBody::apply_external_impulses(btSoftBody& body, btScalar time_step) {
  limited_.asked_step = time_step;
  const btScalar most = body.m_worldInfo->m_maxDisplacement / time_step;
  impulses_.resize(3, 0);
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_f.isZero()) continue;
    if (impulses_.cols() == 0) impulses_.setZero(3, body.m_nodes.size());
    btVector3 change = node.m_f * (node.m_im * time_step);
    change.setMin(btVector3(most, most, most));  // as btSoftBody::predictMotion
    change.setMax(btVector3(-most, -most, -most));
    node.m_v += change;
    impulses_.col(i) = from_bullet<btScalar>(change);
    node.m_f.setZero();
  }
}

void FastBody::note_velocities(const btSoftBody& body) {
  const fast::WorkerTeam::Scope scope(team_, team_size());
  left_velocities_.resize(3, body.m_nodes.size());
  for_nodes([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      const btVector3& velocity = body.m_nodes[i].m_v;
      left_velocities_.col(i) << velocity.x(), velocity.y(), velocity.z();
    }
  });
}

void FastBody::predict(btSoftBody& body, btScalar time_step, const Matrix3X<btScalar>& positions,
                       const Matrix3X<btScalar>& velocities) {
  const fast::WorkerTeam::Scope scope(team_, team_size());
  last_starts_.swap(starts_);
  last_spacing_ = time_step;
  last_velocities_.swap(start_velocities_);
  choose_origin(body);
  starts_.resize(3, positions.cols());
  start_velocities_.resize(3, positions.cols());
  for_nodes([&](int begin, int count) {
    starts_.middleCols(begin, count) = positions.middleCols(begin, count).colwise() - origin_;
    start_velocities_.middleCols(begin, count) = velocities.middleCols(begin, count);
  });
  last_num_substeps_ = std::exchange(num_substeps_, 1);
  steady_.begin_step(contacts_);
  colliders_.clear();
  led_links_.begin_step(time_step);
  pushed_.begin_step();
  is_support_missing_ = false;
  swept_.invalidate();
  if (is_plain(body)) {
    const bool keeps_tree =
        settings_.keeps_node_tree || (body.m_cfg.collisions & btSoftBody::fCollision::VF_SS) != 0;
    predict_nodes(body, time_step, last_velocities_, keeps_tree, scratch_, team_);
  } else {
    // Bullet would tell the broadphase, which all bodies share.
    btBroadphaseProxy* const proxy = body.getBroadphaseHandle();
    body.setBroadphaseHandle(nullptr);
    body.predictMotion(time_step);
    body.setBroadphaseHandle(proxy);
    include_in_bounds(positions, body);
  }
  is_predicted_ = true;
  has_normals_ = false;
}

// Reads the present velocities, because somebody may have pushed or pinned nodes since predict().
void FastBody::read_prediction(const btSoftBody& body) {
  predicted_.resize(3, body.m_nodes.size());
  std::array<bool, fast::WorkerTeam::kMostParts> has_pins{};
  fast::run_parts(team_, body.m_nodes.size(), [&](int range, int begin, int end) {
    bool any = false;
    for (int i = begin; i < end; ++i) {
      const btSoftBody::Node& node = body.m_nodes[i];
      predicted_.col(i) << node.m_v.x(), node.m_v.y(), node.m_v.z();
      any = any || node.m_im <= 0;
    }
    has_pins[static_cast<std::size_t>(range)] = any;
  });
  pins_.clear();
  const fast::NodePartition ranges(body.m_nodes.size());
  for (int range = 0; range < ranges.count(); ++range) {
    if (!has_pins[static_cast<std::size_t>(range)]) continue;
    for (int i = ranges[range].begin; i < std::min(ranges[range].end, body.m_nodes.size()); ++i) {
      if (body.m_nodes[i].m_im <= 0) pins_.push_back(i);
    }
  }
}

void FastBody::collide(const btSoftBody& body, const btCollisionObjectWrapper& object,
                       HullTable& hulls, btScalar time_step) {
  if ((body.m_cfg.collisions & btSoftBody::fCollision::SDF_RS) == 0) return;
  colliders_.push_back(make_collider(object, hulls.find(*object.getCollisionShape()),
                                     static_cast<int>(colliders_.size()), time_step));
}

void FastBody::prepare_solver(const btSoftBody& body) {
  // A little longer does no harm, and steps that vary would make a solver each.
  if (solver_ && limited_.as_given.edges.cols() > 0 && limited_.asked_step > 2 * limited_.step) {
    network_ = std::exchange(limited_.as_given, {});
    solver_.reset();
  }
  const auto num_nodes = static_cast<std::size_t>(body.m_nodes.size());
  const bool is_same = solver_ != nullptr && pins_ == solver_pins_ && is_free_.size() == num_nodes;
  if (!is_same) {
    std::vector<bool> is_free(num_nodes, true);
    for (const int pin : pins_) is_free[static_cast<std::size_t>(pin)] = false;
    set_free(is_free);
    is_free_ = std::move(is_free);
    solver_pins_ = pins_;
  }
}

void FastBody::set_free(const std::vector<bool>& is_free) {
  const TraceScope trace("factorise");
  const fast::WorkerTeam::Pause pause(team_);  // workers would wait for long
  if (solver_) return solver_->set_free(is_free);
  fast::SpringNetwork limited = network_;
  limited_.step = limited_.asked_step;
  limit_stiffness(limited_.step, masses_, limited);
  solver_ = prepared_ ? prepared_->make(limited, masses_, is_free)
                      : std::make_unique<fast::ImplicitSolver<btScalar>>(limited, masses_, is_free);
  // A longer step needs a lower limit, of what the laws say.
  const bool may_be_limited =
      limit_stiffness(std::max(kLongestStep, limited_.step), masses_, limited);
  if (may_be_limited) limited_.as_given = std::move(network_);
  network_ = {};  // the solver has it now
}

void FastBody::apply_solution(btSoftBody& body, btScalar time_step, bool is_looked_at) {
  is_projected_ = active_solver().was_clamped();
  project_out_of_missed_colliders(body, time_step);
  project_out_of_planes();
  exchange_impulses(body, time_step);
  is_written_ = is_looked_at;
  if (is_looked_at) write_positions(body);
}

// Pinned nodes are where the program has put them, to the last bit.
void FastBody::write_positions(btSoftBody& body) {
  for_nodes([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      if (body.m_nodes[i].m_im > 0) body.m_nodes[i].m_x = in_world(i);
    }
  });
}

void FastBody::project_cloth_contacts(btSoftBody& body) {
  if (body.m_scontacts.size() > 0) btSoftBody::PSolve_SContacts(&body, 1, 0);
  project_out_of_colliders(body);
}

// Other cloth may have moved nodes since the solution was written to them.
bool FastBody::take_changed_positions(const btSoftBody& body) {
  bool any = false;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im <= 0 || node.m_x == in_world(i)) continue;
    any = true;
    positions_.col(i) = from_bullet<btScalar>(node.m_x) - origin_;
  }
  return any;
}

void FastBody::end_solve(btSoftBody& body, btScalar time_step) {
  const TraceScope trace("write back");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  is_predicted_ = false;
  const bool is_pushed = is_written_ && take_changed_positions(body);
  const bool meets_cloth = body.m_scontacts.size() > 0 || is_pushed;
  find_velocities();
  step_error_.include(active_solver().report(), static_cast<double>(inertia_step_), masses_.sum());
  keep_forces(body, time_step);
  if (meets_cloth) {
    excess_ = 0;
  } else {
    limit_kinetic_energy(time_step);
  }
  for_nodes([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      btSoftBody::Node& node = body.m_nodes[i];
      node.m_f.setZero();
      if (node.m_im > 0) {
        if (!is_written_) node.m_x = in_world(i);
        node.m_v = (1 - body.m_cfg.kDP) * to_bullet(velocities_.col(i));
      } else {
        node.m_v = (node.m_x - node.m_q) / time_step;
      }
    }
    if (origin_.isZero(0)) return;
    auto rounded = positions_.middleCols(begin, count);  // with Bullet's rounding
    rounded.colwise() += origin_;
    rounded.colwise() -= origin_;
  });
  const bool met_something = !contacts_.empty() || meets_cloth;
  last_step_ = met_something ? btScalar(0) : time_step;
}

void FastBody::update_normals(btSoftBody& body) {
  has_normals_ = true;
  if (!settings_.keeps_normals && !has_air(body.m_cfg)) return;
  const TraceScope trace("normals");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  normals_.update(body, team_);
}

void FastBody::solve(btSoftBody& body, btScalar time_step,
                     const fast::SolverSettings& solver_settings, bool is_again) {
  read_constraints(body, time_step, is_again);
  const bool is_bending = method_ != Method::kExplicit && !bending_.empty();
  active_solver().solve(
      {targets_, starts_, time_step, inertia_step_, plane_contacts_, kinematic_, pushed_.inertias(),
       is_bending ? &bending_ : nullptr, is_again, pushed_.couplings(), supports_},
      solver_settings, positions_, team_);
  pushed_.read_displacements(active_solver(), time_step);
}

void FastBody::prepare(const btSoftBody& body) {
  const fast::WorkerTeam::Scope scope(team_, team_size());
  read_prediction(body);
  prepare_solver(body);
}

void FastBody::detect_contacts(const btSoftBody& body, btScalar time_step) {
  const TraceScope trace("detect contacts");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  follow_colliders(false);
  for (const Collider& collider : colliders_) find_contacts(body, collider, time_step, contacts_);
  pinches_.find(contacts_, body, body.m_sst.sdt);  // fingers have no substeps
}

void FastBody::begin_solve(btSoftBody& body, btScalar time_step,
                           std::span<const void* const> pushed) {
  const TraceScope trace("fast body");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  pushed_.begin_solve(pushed);
  if (excess_ > 0 && (was_changed_outside() || !are_positions_kept())) excess_ = 0;
  set_targets(body, choose_method(body, time_step), time_step);
  solve(body, time_step, settings_.solver, false);
}

void FastBody::solve_anew_if_it_gains(btSoftBody& body, btScalar time_step) {
  if (method_ != Method::kForces) return;
  const TraceScope trace("fast body");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  find_velocities();
  const EnergyBalance balance = energy_balance(time_step, pushed_.energy_to_come(time_step));
  if (balance.kinetic <= balance.most) return;
  set_targets(body, Method::kImplicitEuler, time_step);
  solve(body, time_step, settings_.solver, true);
}

void FastBody::redetect_contacts(btSoftBody& body, btScalar time_step) {
  const TraceScope trace("look again");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  follow_colliders(true);
  is_contact_missing_ = find_missed_contacts(body, time_step);
  is_support_missing_ = pushed_.are_supports_wrong(time_step);
}

bool FastBody::detects_alone() const {
  return std::all_of(colliders_.begin(), colliders_.end(), is_detected_alone);
}

bool FastBody::repeat_step(btSoftBody& body, btScalar time_step) {
  // Neither a method that looks back, nor anything that the program has done since.
  const bool may_repeat = last_step_ == 0 && method_ == Method::kImplicitEuler && excess_ == 0 &&
                          pins_.empty() && impulses_.cols() == 0 && solver_ != nullptr;
  const SteadyStep::State state{starts_,          last_starts_, positions_, start_velocities_,
                                last_velocities_, predicted_,   velocities_};
  const bool is_same = steady_.has_same_surroundings(body, colliders_, time_step) && may_repeat;
  if (!steady_.is_known(is_same && begins_as_last(body, state), solver_.get())) return false;
  is_predicted_ = false;
  steady_.restore(contacts_);
  step_error_.include(solver_->report(), static_cast<double>(inertia_step_), masses_.sum());
  stay(velocities_, body);
  return true;
}

bool FastBody::is_alone(const btSoftBody& body) const {
  std::vector<MovableObject> dynamic;
  return list_dynamic(body, dynamic), dynamic.empty() && detects_alone();
}

// Momentum goes from one body to another in the same step only if both integrate by the same formula.
void FastBody::solve_again(btSoftBody& body, btScalar time_step,
                           std::span<const void* const> pushed, bool is_moved) {
  const TraceScope trace("fast body");
  const fast::WorkerTeam::Scope scope(team_, team_size());
  pushed_.begin_solve(pushed);
  if (is_moved) {
    const Matrix3X<btScalar> solved = positions_;
    if (!take_changed_positions(body)) return;
    const Matrix3X<btScalar> displacements = positions_ - solved;
    positions_ = solved;
    if (method_ != Method::kImplicitEuler) set_targets(body, Method::kImplicitEuler, time_step);
    targets_ += displacements;
  }
  solve(body, time_step, settings_.solver, true);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
