// What a snapshot has of a fast body.
// Tested by tests/bridge/snapshot_test.cpp, tests/engines/snapshot_test.cpp.
#include <algorithm>
#include <utility>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/implicit/fast_body.hpp>
#include <weft/bridge/snapshot/bullet_state.hpp>
#include <weft/bridge/snapshot/object_table.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// A matrix that mostly equals one that can be derived from the nodes; then only that is noted.
template <class Derive>
void serialize_derived(StateArchive& archive, const Derive& derive, Matrix3X<btScalar>& matrix) {
  bool is_derived = false;
  if (!archive.is_reading()) is_derived = matrix.cols() > 0 && matrix == derive();
  archive.value(is_derived);
  if (!is_derived) {
    archive.value(matrix);
  } else if (archive.is_reading()) {
    matrix = derive();
  }
}

template <btVector3 btSoftBody::Node::*kVector>
Matrix3X<btScalar> vectors_of(const btSoftBody& body) {
  Matrix3X<btScalar> vectors(3, body.m_nodes.size());
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    vectors.col(i) = from_bullet<btScalar>(body.m_nodes[i].*kVector);
  }
  return vectors;
}

}  // namespace

void FastBody::Structure::serialize(StateArchive& archive, int num_nodes) {
  archive.part("structure");
  archive.value(has_solver);
  archive.value(num_new_rest_lengths);
  if (!has_solver) return;
  archive.value(step);
  free_nodes.resize(static_cast<std::size_t>(num_nodes));
  archive.runs(std::span(free_nodes));
  archive.value(kinematic);
}

FastBody::Structure FastBody::structure() const {
  Structure present;
  present.has_solver = solver_ != nullptr;
  present.num_new_rest_lengths = num_new_rest_lengths_;
  if (!solver_) return present;
  present.free_nodes.assign(is_free_.begin(), is_free_.end());
  present.kinematic = solver_->kinematic_nodes();
  present.step = limited_.step;
  return present;
}

bool FastBody::fits(const Structure& stored) const {
  if (!is_fresh_) return false;
  if (!solver_) return true;
  if (!stored.has_solver || stored.step != limited_.step) return false;
  const bool are_nodes_alike = std::equal(
      is_free_.begin(), is_free_.end(), stored.free_nodes.begin(), stored.free_nodes.end(),
      [](bool is_free, char flag) { return is_free == (flag != 0); });
  // A solver that has led no node yet begins to with the next step, as the one that was saved did.
  const std::vector<int>& kinematic = solver_->kinematic_nodes();
  return are_nodes_alike && (kinematic.empty() || kinematic == stored.kinematic);
}

void FastBody::make_solver(const Structure& stored) {
  limited_.asked_step = stored.step;
  is_free_.assign(stored.free_nodes.begin(), stored.free_nodes.end());
  solver_pins_.clear();
  for (std::size_t i = 0; i < is_free_.size(); ++i) {
    if (!is_free_[i]) solver_pins_.push_back(static_cast<int>(i));
  }
  set_free(is_free_);
}

void FastBody::serialize_motion(StateArchive& archive, const btSoftBody& body) {
  for (int k = 0; k < 3; ++k) archive.value(origin_[k]);
  archive.value(starts_);
  archive.value(start_velocities_);
  serialize_derived(
      archive,
      [&]() -> Matrix3X<btScalar> {
        return vectors_of<&btSoftBody::Node::m_x>(body).colwise() - origin_;
      },
      positions_);
  serialize_derived(
      archive, [&] { return vectors_of<&btSoftBody::Node::m_v>(body); }, left_velocities_);
  const Eigen::Index num_nodes = masses_.size();
  for (const Matrix3X<btScalar>* matrix :
       {&starts_, &start_velocities_, &positions_, &left_velocities_}) {
    if (matrix->cols() <= num_nodes) continue;  // fewer: of steps before it tore
    archive.refuse("vectors of " + std::to_string(matrix->cols()) + " nodes, expected at most " +
                   std::to_string(num_nodes));
  }
}

void FastBody::serialize(StateArchive& archive, const Structure& stored, const ObjectTable& objects,
                         const btSoftBody& body) {
  archive.part("fast body");
  const auto num_nodes = static_cast<int>(masses_.size());
  archive.expect(num_nodes, "number of nodes");
  if (archive.is_reading() && stored.has_solver && !solver_) make_solver(stored);
  serialize_motion(archive, body);
  archive.value(limited_.asked_step);
  archive.value(last_step_);
  archive.value(last_spacing_);
  archive.value(inertia_step_);
  archive.value(velocity_step_);
  archive.value(excess_);
  archive.value(num_substeps_);
  archive.value(step_error_.distance);
  archive.value(step_error_.newton_iterations);
  archive.value(step_error_.is_within_tolerance);
  force_history_.serialize(archive, num_nodes);
  sleep_.serialize(archive, objects);
  pushed_.serialize(archive, objects);
  pinches_.serialize(archive, num_nodes);
  swept_.serialize(archive, num_nodes);
  if (solver_) solver_->serialize(archive);
  if (!archive.is_reading()) return;
  contacts_.clear();
  colliders_.clear();
  impulses_.resize(3, 0);
  sticking_points_ = {};  // those of links, which no snapshot has
  led_links_ = {};
  is_predicted_ = false;
  has_normals_ = false;
  is_contact_missing_ = false;
  is_support_missing_ = false;
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
