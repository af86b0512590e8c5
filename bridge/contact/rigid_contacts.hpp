#pragma once

// Tested by tests/bridge/contact/rigid_contacts_test.cpp, tests/bridge/contact/rigid_response_test.cpp, tests/bridge/implicit/fast_body_test.cpp.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/face_tree.hpp>
#include <weft/bridge/contact/surface/surface_distance.hpp>
#include <weft/bridge/rigid/movable_object.hpp>
#include <weft/fast_solver/threads/worker_team.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// A node in front of a rigid surface: normal . x >= offset at the end of the step.
struct RigidContact {
  int node = 0;
  btVector3 normal{0, 0, 0};  ///< out of the object
  btScalar offset = 0;        ///< [m]
  btVector3 motion{0, 0, 0};  ///< of the surface during the step [m]
  const btCollisionObject* object = nullptr;
  int collider = 0;               ///< Collider::number
  std::array<int, 2> triangle{};  ///< of a concave collider: Bullet's part and index
  bool is_dynamic = false;        ///< impulses move the object (MovableObject)
  // A dynamic object carries the plane with it: the node's position as seen from the object, in the world where the
  // step began, and in the object's frame; the normal in the object's frame.
  btVector3 met{0, 0, 0};
  btVector3 met_by_object{0, 0, 0};
  btVector3 normal_by_object{0, 0, 0};
  btScalar gap = 0;  ///< of that position in front of the plane [m]
  // The result of the last solution:
  btVector3 impulse{0, 0, 0};  ///< on the node [N s]
  bool is_sticking = false;
};

/// A whole object, or a part of it, that the body's bounds meet.
struct Collider {
  const btCollisionObject* object;
  const btCollisionShape* shape;
  btTransform pose;          ///< where the step begins; of what is not dynamic, where it stands
  const HullFacets* facets;  ///< of a hull, or nullptr
  int number = 0;            ///< to tell the parts of an object from each other
  btTransform object_pose = btTransform::getIdentity();  ///< of the whole object, as pose
  /// Takes the points of a movable object from where the step begins to where it ends.
  btTransform motion = btTransform::getIdentity();
  /// The velocity of an object that the program leads: a kinematic rigid body, or a link that no impulse moves.
  RigidVelocity led = {};
};

/// A collider of the present step, before Bullet has moved it: dynamic ones are expected to go on with their velocity.
[[nodiscard]] Collider make_collider(const btCollisionObjectWrapper& object,
                                     const HullFacets* facets, int number, btScalar time_step);

/// A concave object (ConcaveSurface) is met as a whole, not as the solids that Bullet makes of its triangles: the object
/// with its own shape if it is one; nullptr otherwise.
[[nodiscard]] const btCollisionShape* concave_shape_of(const btCollisionObjectWrapper& object);

/// Whether add_rigid_contacts() touches nothing that another body may use at the same time.
[[nodiscard]] bool is_detected_alone(const Collider& collider);

/// The swept bounds of a body's nodes, from m_q to m_x.
class SweptNodes {
 public:
  /// Nodes have moved since the last update().
  void invalidate() { is_current_ = false; }
  /// Does nothing unless invalidate() was called. Allocates memory only if the number of nodes is another.
  void update(const btSoftBody& body, fast::WorkerTeam* team = nullptr);
  /// Boxes of groups of nodes, as NodeGroups has them.
  [[nodiscard]] const std::vector<MotionBox>& boxes() const { return boxes_; }
  [[nodiscard]] std::span<const int> group(std::size_t g) const { return groups_[g]; }
  [[nodiscard]] const MotionBox& all() const { return all_; }
  /// The groups, for a body of so many nodes.
  void serialize(StateArchive& archive, int num_nodes) {
    groups_.serialize(archive, num_nodes);
    if (archive.is_reading()) invalidate();
  }

  /// work(first group, group behind the last, contacts) for ranges of the groups, by a team; appends what each adds, in
  /// order.
  template <class Work>
  void collect(const Work& work, fast::WorkerTeam* team, std::vector<RigidContact>& contacts) {
    const std::size_t num_ranges = num_ranges_for(team);
    if (num_ranges == 1) return work(std::size_t{0}, boxes_.size(), contacts);
    found_.resize(std::max(found_.size(), num_ranges));
    team->run(static_cast<int>(num_ranges), [&](int range) {
      const auto p = static_cast<std::size_t>(range);
      found_[p].clear();
      work(boxes_.size() * p / num_ranges, boxes_.size() * (p + 1) / num_ranges, found_[p]);
    });
    for (std::size_t p = 0; p < num_ranges; ++p) {
      contacts.insert(contacts.end(), found_[p].begin(), found_[p].end());
    }
  }

 private:
  /// Groups of a range, which are some microseconds of work.
  static constexpr std::size_t kGroups = 32;
  [[nodiscard]] std::size_t num_ranges_for(const fast::WorkerTeam* team) const {
    if (team == nullptr || team->num_threads() == 1) return 1;
    return std::clamp<std::size_t>(boxes_.size() / kGroups, 1, fast::WorkerTeam::kMostParts);
  }

  NodeGroups groups_;
  std::vector<MotionBox> boxes_;
  MotionBox all_ = MotionBox::nowhere();
  bool is_current_ = false;
  std::vector<std::vector<RigidContact>> found_;  ///< of each range
};

/// Which pinned nodes (without a mass of their own) have contacts.
enum class PinnedNodes {
  kLeftOut,            ///< none
  kWithDynamicObjects  ///< those in front of objects that they can push
};

/// Appends the contacts of a body's nodes with a collider, between btSoftBody::predictMotion and
/// solveConstraints of a step of time_step [s]. swept: of the body as it is now.
///
/// Nodes are looked up at the predicted position, as the collider sees it, up to twice the collision margin: exactly (surface_distance()), or in
/// Bullet's distance field of the shape, as Bullet does; at a concave one, each triangle around gives a contact. A node that travels farther than the margin is followed along
/// its path, relative to the object, and stopped at the surface that it meets first: however thin the
/// object, it is not shot through. Anchored nodes are left out, and those that are flagged, if there are flags for nodes. By a
/// team, in the same order for any.
void add_rigid_contacts(const btSoftBody& body, SweptNodes& swept, const Collider& collider,
                        btScalar time_step, PinnedNodes pinned, std::vector<RigidContact>& contacts,
                        fast::WorkerTeam* team = nullptr, std::span<const char> is_left_out = {});

/// Whether the collider is a convex solid that stands still and whose distances are exact: one plane of a contact is in front
/// of all of it.
[[nodiscard]] bool is_still_solid(const Collider& collider);

/// Whether two surfaces at a node face each other, as those that press cloth between them: normals within 37 degrees of opposite.
[[nodiscard]] inline bool are_opposite(const RigidContact& one, const RigidContact& other) {
  constexpr btScalar kOpposite = btScalar(-0.8);
  return btDot(one.normal, other.normal) <= kOpposite;
}
/// [m] For a node between two planes, its margins taken off.
[[nodiscard]] inline btScalar room_between(const RigidContact& one, const RigidContact& other,
                                           const btSoftBody& body) {
  const btVector3& position = body.m_nodes[one.node].m_x;
  return btDot(one.normal + other.normal, position) - one.offset - other.offset;
}

/// Moves the plane of a contact with a dynamic object with the object to its pose at the end of the step.
void follow_object(RigidContact& contact, const btTransform& object_pose);

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
