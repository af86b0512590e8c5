#include <weft/bridge/fast_body.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <weft/bridge/bullet_vector.hpp>
#include <weft/bridge/energy_limit.hpp>
#include <weft/bridge/node_prediction.hpp>
#include <weft/bridge/node_state.hpp>
#include <weft/custom_forces/core/trace.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Of m |y - q|^2 / (2 h^2), what a step may gain: rounding.
constexpr double kEnergySlack = 0.01;

/// [m] Places are counted from a multiple of this near the body.
constexpr btScalar kOriginGrid = btScalar(0.25);
constexpr btScalar kFarFromOrigin = 2;  // [m] from which on another one is chosen
/// [s] Of a program that can still be played.
constexpr btScalar kLongestStep = btScalar(1) / 15;
void include_in_bounds(const Matrix3X<btScalar>& positions, btSoftBody& body) {
  body.m_bounds[0].setMin(to_bullet(positions.rowwise().minCoeff()));
  body.m_bounds[1].setMax(to_bullet(positions.rowwise().maxCoeff()));
}

}  // namespace

FastBody::FastBody(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
                   VectorX<double> masses, const FastSettings& settings)
    : network_(fast::make_network(mesh, laws)), masses_(std::move(masses)), settings_(settings) {
  check(settings);
}

std::optional<std::string> FastBody::obstacle(const btSoftBody& body) {
  if (body.m_clusters.size() > 0) return "it has clusters";
  if (body.m_pose.m_bframe && body.m_cfg.kMT > 0) return "it is matched to a pose";
  if (body.m_cfg.timescale != btScalar(1)) return "its m_cfg.timescale is not 1";
  return std::nullopt;
}

// What the body knew of the steps before is of other nodes.
void FastBody::tear(const fast::SpringNetwork& springs, const std::vector<char>& is_changed,
                    VectorX<double> masses, const std::vector<int>& origins) {
  masses_ = std::move(masses);
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
  obstacles_.clear();
  ways_.outdate();
  excess_ = 0;
  wake();
}

btVector3 FastBody::in_world(int node) const {
  return to_bullet(places_.col(node) + origin_);
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
  places_.colwise() += origin_ - origin;
  origin_ = origin;
}

void FastBody::take_impulses(btSoftBody& body, btScalar time_step) {
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
  const fast::ThreadTeam::Scope scope(team_, team_size());
  left_velocities_.resize(3, body.m_nodes.size());
  for_nodes([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      const btVector3& velocity = body.m_nodes[i].m_v;
      left_velocities_.col(i) << velocity.x(), velocity.y(), velocity.z();
    }
  });
}

// BDF2 takes a change of velocity between steps for the beginning of a trend, and makes 4/3 of it: such a step is implicit
// Euler, which counts it once. The steps after it have a history that has had that velocity.
bool FastBody::was_pushed() const {
  if (impulses_.cols() > 0) return true;
  return left_velocities_.cols() == start_velocities_.cols() &&
         left_velocities_ != start_velocities_;
}

void FastBody::predict(btSoftBody& body, btScalar time_step, const Matrix3X<btScalar>& positions,
                       const Matrix3X<btScalar>& velocities) {
  const fast::ThreadTeam::Scope scope(team_, team_size());
  last_starts_.swap(starts_);
  last_velocities_.swap(start_velocities_);
  choose_origin(body);
  starts_.resize(3, positions.cols());
  start_velocities_.resize(3, positions.cols());
  for_nodes([&](int begin, int count) {
    starts_.middleCols(begin, count) = positions.middleCols(begin, count).colwise() - origin_;
    start_velocities_.middleCols(begin, count) = velocities.middleCols(begin, count);
  });
  contacts_.clear();
  obstacles_.clear();
  forget_supports();
  is_support_missing_ = false;
  ways_.outdate();
  if (is_plain(body)) {
    predict_nodes(body, time_step, last_velocities_, scratch_, team_);
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

// Of now: somebody may have pushed or pinned nodes since predict().
void FastBody::read_prediction(const btSoftBody& body) {
  predicted_.resize(3, body.m_nodes.size());
  std::array<bool, fast::ThreadTeam::kMostParts> has_pins{};
  fast::run_parts(team_, body.m_nodes.size(), [&](int part, int begin, int end) {
    bool any = false;
    for (int i = begin; i < end; ++i) {
      const btSoftBody::Node& node = body.m_nodes[i];
      predicted_.col(i) << node.m_v.x(), node.m_v.y(), node.m_v.z();
      any = any || node.m_im <= 0;
    }
    has_pins[static_cast<std::size_t>(part)] = any;
  });
  pins_.clear();
  const fast::NodeParts parts(body.m_nodes.size());
  for (int part = 0; part < parts.count(); ++part) {
    if (!has_pins[static_cast<std::size_t>(part)]) continue;
    for (int i = parts[part].begin; i < std::min(parts[part].end, body.m_nodes.size()); ++i) {
      if (body.m_nodes[i].m_im <= 0) pins_.push_back(i);
    }
  }
}

void FastBody::publish_bounds(btSoftBody& body) {
  if (btBroadphaseProxy* const proxy = body.getBroadphaseHandle()) {
    body.m_worldInfo->m_broadphase->setAabb(proxy, body.m_bounds[0], body.m_bounds[1],
                                            body.m_worldInfo->m_dispatcher);
  }
}

void FastBody::collide(const btSoftBody& body, const btCollisionObjectWrapper& object,
                       HullTable& hulls, btScalar time_step) {
  if ((body.m_cfg.collisions & btSoftBody::fCollision::SDF_RS) == 0) return;
  obstacles_.push_back(make_obstacle(object, hulls.find(*object.getCollisionShape()),
                                     static_cast<int>(obstacles_.size()), time_step));
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
  const fast::ThreadTeam::Pause pause(team_);  // helpers would wait for long
  if (solver_) return solver_->set_free(is_free);
  fast::SpringNetwork limited = network_;
  limited_.step = limited_.asked_step;
  limit_stiffness(limited_.step, masses_, limited);
  solver_ = std::make_unique<fast::ImplicitSolver<btScalar>>(limited, masses_, is_free);
  // A longer step needs a lower limit, of what the laws say.
  const bool may_be_limited =
      limit_stiffness(std::max(kLongestStep, limited_.step), masses_, limited);
  if (may_be_limited) limited_.as_given = std::move(network_);
  network_ = {};  // the solver has it now
}

bool FastBody::may_use_history(const btSoftBody& body, btScalar time_step) {
  if (!settings_.is_second_order || last_step_ != time_step || !contacts_.empty() ||
      body.m_scontacts.size() > 0 || places_.cols() != starts_.cols() || was_pushed()) {
    return false;
  }
  // Somebody may have moved a node since.
  for (const int pin : pins_) places_.col(pin) = starts_.col(pin);
  std::array<bool, fast::ThreadTeam::kMostParts> is_same;
  is_same.fill(true);
  fast::run_parts(team_, static_cast<int>(starts_.cols()), [&](int part, int begin, int end) {
    is_same[static_cast<std::size_t>(part)] =
        places_.middleCols(begin, end - begin) == starts_.middleCols(begin, end - begin);
  });
  return std::all_of(is_same.begin(), is_same.end(), [](bool same) { return same; });
}

// What does that work is not known: pins and anchors that lead, obstacles that are led, other cloth.
bool FastBody::gets_work_from_outside() const {
  if (!led_.empty()) return true;
  for (const RigidContact& contact : contacts_) {
    if (contact.motion.length2() > 0 && movable(contact.object) == nullptr) return true;
  }
  return std::any_of(pins_.begin(), pins_.end(),
                     [&](int pin) { return places_.col(pin) != starts_.col(pin); });
}

// A node that is put out of a surface after the solution stretches springs, and a very stiff sheet would throw it back with
// energy that nobody has given to it. What is stored in springs cannot be taken away without another step: it is kept in mind
// until it comes out as motion. Solutions that stay as they are gain nothing and are not looked at.
void FastBody::keep_energy(btScalar time_step) {
  if (gets_work_from_outside()) excess_ = 0;
  if (solver_->is_converged() && !is_projected_ && pushed_.empty() && excess_ == 0) return;
  if (weights_.cols() != places_.cols()) {
    weights_ = masses_.transpose().cast<btScalar>().replicate(3, 1);
  }
  for (const int pin : pins_) weights_.col(pin).setZero();
  const double given =
      energy_put_in({weights_, starts_, start_velocities_, predicted_, places_, time_step}, team_);
  const double now = kinetic_energy(weights_, velocities_, team_);
  const double most = given - given_to_bodies_ + solver_->spring_energy(starts_, team_) - excess_ +
                      kEnergySlack * solver_->step_energy() -
                      solver_->spring_energy(places_, team_);
  if (now > most) limit_energy(weights_, most, pins_.empty(), velocities_, team_);
  excess_ = std::max(0.0, -most);
}

void FastBody::place(btSoftBody& body, btScalar time_step, bool is_looked_at) {
  is_projected_ = solver_->was_clamped();
  keep_out_of_missed(body, time_step);
  leave_depths();
  give_impulses(body, time_step);
  is_placed_ = is_looked_at;
  if (is_looked_at) write_places(body);
}

// Pinned nodes are where their leader has put them, to the last bit.
void FastBody::write_places(btSoftBody& body) {
  for_nodes([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      if (body.m_nodes[i].m_im > 0) body.m_nodes[i].m_x = in_world(i);
    }
  });
}

void FastBody::project_cloth_contacts(btSoftBody& body) {
  if (body.m_scontacts.size() > 0) btSoftBody::PSolve_SContacts(&body, 1, 0);
  stay_outside(body);
}

// What has moved nodes since they were put to their places: other cloth.
bool FastBody::take_pushed_places(const btSoftBody& body) {
  bool any = false;
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    const btSoftBody::Node& node = body.m_nodes[i];
    if (node.m_im <= 0 || node.m_x == in_world(i)) continue;
    any = true;
    places_.col(i) = from_bullet<btScalar>(node.m_x) - origin_;
  }
  return any;
}

void FastBody::end_solve(btSoftBody& body, btScalar time_step) {
  const TraceScope trace("write back");
  const fast::ThreadTeam::Scope scope(team_, team_size());
  is_predicted_ = false;
  const bool is_pushed = is_placed_ && take_pushed_places(body);
  const bool meets_cloth = body.m_scontacts.size() > 0 || is_pushed;
  velocities_.resize(3, places_.cols());
  for_nodes([&](int begin, int count) {
    auto velocities = velocities_.middleCols(begin, count);
    velocities = places_.middleCols(begin, count) - origins_.middleCols(begin, count);
    solver_->add_remainders(begin, velocities);
    velocities /= inertia_step_;
  });
  if (meets_cloth) {
    excess_ = 0;
  } else {
    keep_energy(time_step);
  }
  for_nodes([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      btSoftBody::Node& node = body.m_nodes[i];
      node.m_f.setZero();
      if (node.m_im > 0) {
        if (!is_placed_) node.m_x = in_world(i);
        node.m_v = (1 - body.m_cfg.kDP) * to_bullet(velocities_.col(i));
      } else {
        node.m_v = (node.m_x - node.m_q) / time_step;
      }
    }
    if (origin_.isZero(0)) return;
    auto places = places_.middleCols(begin, count);  // with Bullet's rounding
    places.colwise() += origin_;
    places.colwise() -= origin_;
  });
  const bool met_something = !contacts_.empty() || meets_cloth;
  last_step_ = met_something ? btScalar(0) : time_step;
}

void FastBody::update_normals(btSoftBody& body) {
  const TraceScope trace("normals");
  const fast::ThreadTeam::Scope scope(team_, team_size());
  normals_.update(body, team_);
  has_normals_ = true;
}

// What threads gain with one part each, they lose waiting for one another.
int FastBody::team_size() const {
  const int num_parts = fast::NodeParts(static_cast<int>(masses_.size())).count();
  return std::clamp(num_parts / 2, 1, num_threads_);
}

void FastBody::solve(btSoftBody& body, btScalar time_step, const fast::SolverEffort& effort,
                     bool is_again) {
  read_constraints(body, time_step, is_again);
  solver_->solve({targets_, starts_, time_step, inertia_step_, plane_contacts_, led_, inertias_,
                  bending_.empty() ? nullptr : &bending_, is_again},
                 effort, places_, team_);
  remember_ways();
}

void FastBody::prepare(const btSoftBody& body) {
  const fast::ThreadTeam::Scope scope(team_, team_size());
  read_prediction(body);
  prepare_solver(body);
}

void FastBody::detect_contacts(const btSoftBody& body, btScalar time_step) {
  const TraceScope trace("detect contacts");
  const fast::ThreadTeam::Scope scope(team_, team_size());
  follow_obstacles(false);
  for (const Obstacle& obstacle : obstacles_) find_contacts(body, obstacle, time_step, contacts_);
}

void FastBody::begin_solve(btSoftBody& body, btScalar time_step,
                           std::span<const btRigidBody* const> pushed) {
  const TraceScope trace("fast body");
  const fast::ThreadTeam::Scope scope(team_, team_size());
  all_pushed_.assign(pushed.begin(), pushed.end());
  // Bullet has predicted velocities v + h a; what it would do to nodes without springs.
  const bool uses_history = may_use_history(body, time_step);
  inertia_step_ = uses_history ? time_step * 2 / 3 : time_step;
  for (Matrix3X<btScalar>* vectors : {&origins_, &targets_, &places_}) {
    vectors->resize(3, starts_.cols());
  }
  for_nodes([&](int begin, int count) {
    const auto of = [&](Matrix3X<btScalar>& vectors) { return vectors.middleCols(begin, count); };
    if (uses_history) {
      of(origins_) = (4 * of(starts_) - of(last_starts_)) / 3;
      of(targets_) = of(origins_) +
                     inertia_step_ * ((4 * of(start_velocities_) - of(last_velocities_)) / 3 +
                                      (of(predicted_) - of(start_velocities_)) * btScalar(2) / 3);
    } else {
      of(origins_) = of(starts_);
      of(targets_) = of(origins_) + inertia_step_ * of(predicted_);
    }
    of(places_) = of(starts_) + time_step * of(start_velocities_);
    // Springs may hold back at once what a force would do alone.
    if (impulses_.cols() > 0) of(places_) -= time_step * of(impulses_);
  });
  for (const int pin : pins_) {
    targets_.col(pin) = from_bullet<btScalar>(body.m_nodes[pin].m_x) - origin_;
  }
  if (!bending_.empty()) bending_.begin_step(starts_);
  solve(body, time_step, settings_.effort, false);
}

void FastBody::look_again(btSoftBody& body, btScalar time_step) {
  const TraceScope trace("look again");
  const fast::ThreadTeam::Scope scope(team_, team_size());
  follow_obstacles(true);
  is_contact_missing_ = find_missed_contacts(body, time_step);
  is_support_missing_ = are_supports_wrong(time_step);
}

bool FastBody::looks_alone() const {
  return std::none_of(obstacles_.begin(), obstacles_.end(), [](const Obstacle& obstacle) {
    return needs_distance_field(*obstacle.shape, obstacle.facets);
  });
}

void FastBody::solve_again(btSoftBody& body, btScalar time_step,
                           std::span<const btRigidBody* const> pushed) {
  const TraceScope trace("fast body");
  const fast::ThreadTeam::Scope scope(team_, team_size());
  all_pushed_.assign(pushed.begin(), pushed.end());
  solve(body, time_step, settings_.effort, true);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
