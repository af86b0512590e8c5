#include <weft/bridge/snapshot/fast_body_state.hpp>

#include <algorithm>
#include <string>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/snapshot/bullet_state.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// A matrix that mostly equals one that can be derived from the nodes; then only that is noted.
template <class Derive>
void serialize_derived(StateArchive& archive, const Derive& derive, Matrix3X<btScalar>& matrix) {
  bool is_derived = false;
  if (!archive.is_reading() && matrix.cols() > 0) {
    // A tear adds nodes: a matrix of the step before it is shorter.
    const Matrix3X<btScalar> derived = derive();
    is_derived = matrix.cols() == derived.cols() && matrix == derived;
  }
  archive.value(is_derived);
  if (!is_derived) {
    archive.value(matrix);
  } else if (archive.is_reading()) {
    matrix = derive();
  }
}

}  // namespace

FastBodyState::FastBodyState(const FastBody& body)
    : has_solver_(body.solver_ != nullptr),
      num_new_rest_lengths_(body.history_.num_new_rest_lengths) {
  if (!has_solver_) return;
  free_nodes_.assign(body.is_free_.begin(), body.is_free_.end());
  step_ = body.limited_.step;
}

void FastBodyState::serialize_structure(StateArchive& archive, const FastBody& body) {
  archive.part("structure");
  archive.value(has_solver_);
  archive.value(num_new_rest_lengths_);
  if (num_new_rest_lengths_ != body.history_.num_new_rest_lengths) {
    archive.refuse("springs had other rest lengths, expected those that they have now");
  }
  if (!has_solver_) return;
  archive.value(step_);
  free_nodes_.resize(static_cast<std::size_t>(body.masses_.size()));
  archive.runs(std::span(free_nodes_));
}

bool FastBodyState::fits(const FastBody& body) const {
  if (!is_fresh(body)) return false;
  if (!body.solver_) return true;
  if (!has_solver_ || step_ != body.limited_.step) return false;
  return std::equal(body.is_free_.begin(), body.is_free_.end(), free_nodes_.begin(),
                    free_nodes_.end(),
                    [](bool is_free, char flag) { return is_free == (flag != 0); });
}

void FastBodyState::make_solver(FastBody& body) const {
  body.limited_.asked_step = step_;
  body.is_free_.assign(free_nodes_.begin(), free_nodes_.end());
  body.solver_pins_.clear();
  for (std::size_t i = 0; i < free_nodes_.size(); ++i) {
    if (free_nodes_[i] == 0) body.solver_pins_.push_back(static_cast<int>(i));
  }
  body.set_free(body.is_free_);
}

void FastBodyState::serialize_motion(StateArchive& archive, const btSoftBody& nodes,
                                     FastBody& body) {
  for (int k = 0; k < 3; ++k) archive.value(body.origin_[k]);
  archive.value(body.starts_);
  archive.value(body.start_velocities_);
  serialize_derived(
      archive,
      [&]() -> Matrix3X<btScalar> {
        return vectors_of<&btSoftBody::Node::m_x>(nodes).colwise() - body.origin_;
      },
      body.positions_);
  serialize_derived(
      archive, [&] { return vectors_of<&btSoftBody::Node::m_v>(nodes); }, body.left_velocities_);
  const Eigen::Index num_nodes = body.masses_.size();
  for (const Matrix3X<btScalar>* matrix :
       {&body.starts_, &body.start_velocities_, &body.positions_, &body.left_velocities_}) {
    if (matrix->cols() <= num_nodes) continue;  // fewer: of steps before it tore
    archive.refuse("vectors of " + std::to_string(matrix->cols()) + " nodes, expected at most " +
                   std::to_string(num_nodes));
  }
}

void FastBodyState::serialize(StateArchive& archive, const ObjectTable& objects,
                              const btSoftBody& nodes, FastBody& body) const {
  archive.part("fast body");
  const auto num_nodes = static_cast<int>(body.masses_.size());
  archive.expect(num_nodes, "number of nodes");
  if (archive.is_reading() && has_solver_ && !body.solver_) make_solver(body);
  serialize_motion(archive, nodes, body);
  archive.value(body.limited_.asked_step);
  archive.value(body.last_step_);
  archive.value(body.last_spacing_);
  archive.value(body.inertia_step_);
  archive.value(body.velocity_step_);
  archive.value(body.excess_);
  archive.value(body.num_substeps_);
  body.explicit_.serialize(archive);
  archive.value(body.step_error_.distance);
  archive.value(body.step_error_.newton_iterations);
  archive.value(body.step_error_.is_within_tolerance);
  body.force_history_.serialize(archive, num_nodes);
  body.sleep_.serialize(archive, objects);
  body.pushed_.serialize(archive, objects);
  body.backed_.serialize(archive, num_nodes);
  body.swept_.serialize(archive, num_nodes);
  if (body.solver_) fast::SolverState::serialize(archive, *body.solver_);
  if (!archive.is_reading()) return;
  body.contacts_.clear();
  body.pinches_.clear();
  body.steady_.forget();
  body.colliders_.clear();
  body.impulses_.resize(3, 0);
  body.sticking_points_ = {};  // those of links, which no snapshot has
  body.led_links_ = {};
  body.is_predicted_ = false;
  body.has_normals_ = false;
  body.is_contact_missing_ = false;
  body.is_support_missing_ = false;
}

void ForceHistory::serialize(StateArchive& archive, Eigen::Index num_nodes) {
  archive.value(step_);
  if (step_ == 0) return;
  archive.value(has_filtered_);
  archive.value(last_);
  if (has_filtered_) {
    archive.value(filtered_);
    archive.value(filtered_before_);
  }
  if (!archive.is_reading()) return;
  coming_.setZero(3, num_nodes);
  if (!has_filtered_) {
    filtered_.setZero(3, num_nodes);
    filtered_before_.setZero(3, num_nodes);
  }
  for (const Matrix3X<btScalar>* forces : {&last_, &filtered_, &filtered_before_}) {
    if (forces->cols() == num_nodes) continue;
    archive.refuse("forces on " + std::to_string(forces->cols()) + " nodes, expected " +
                   std::to_string(num_nodes));
  }
}

void BodySleep::serialize(StateArchive& archive, const ObjectTable& objects) {
  archive.part("sleep");
  archive.value(is_asleep_);
  archive.value(rest_time_);
  if (!is_asleep_) return;
  archive.value(meets_motion_);
  for (std::vector<Neighbor>* list : {&met_, &neighbors_, &anchors_}) {
    archive.list(*list, [&](Neighbor& neighbor) {
      objects.serialize(archive, neighbor.object);
      bridge::serialize(archive, neighbor.pose);
    });
  }
  archive.list(positions_, [&](btVector3& position) { bridge::serialize(archive, position); });
  archive.value(inverse_masses_);
  bridge::serialize(archive, gravity_);
  bridge::serialize(archive, wind_);
}

void CoupledBodies::serialize(StateArchive& archive, const ObjectTable& objects) {
  archive.part("coupled bodies");
  const auto serialize_object = [&](MovableObject& one) {
    const btCollisionObject* object = one.object();
    objects.serialize(archive, object);
    if (archive.is_reading()) one = MovableObject(object);
  };
  // begin_step() asks only which of them are loaded.
  std::vector<MovableObject> held;
  for (const Support& support : supports_) {
    if (support.is_loaded) held.push_back(support.body);
  }
  archive.list(held, serialize_object);
  archive.list(last_, serialize_object);
  last_displacements_.resize(last_.size());
  for (GeneralizedDisplacement& displacement : last_displacements_) {
    for (int k = 0; k < 6; ++k) archive.value(displacement[k]);
  }
  archive.value(last_step_);
  if (!archive.is_reading()) return;
  clear();
  supports_.clear();
  supported_.clear();
  for (const MovableObject& object : held) {
    supports_.push_back({object, Vector3<btScalar>::Zero(), Vector3<btScalar>::Zero(), true});
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
