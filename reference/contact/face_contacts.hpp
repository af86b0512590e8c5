#pragma once

// Tested by tests/reference/face_contact_test.cpp.

#include <vector>

#include <weft/reference/contact/contact_points.hpp>
#include <weft/reference/contact/touches.hpp>

namespace weft::reference {

/// Contacts of the triangles of cloth with colliders over one step: at the deepest place of each
/// triangle, beside its corners, which are nodes. A place stays where it is on the triangle for the
/// rest of the step; where another one is then deeper, that one is added.
class FaceContacts {
 public:
  explicit FaceContacts(const System& system);
  [[nodiscard]] bool is_needed() const { return is_needed_; }

  /// Linearises the colliders, in the poses of the end of the step, at the places so far, and adds
  /// new ones. Levers are those of position-stage impulses (contact_stages.hpp). True if something
  /// is new. only_new: places so far keep their planes.
  bool update(const System& system, const SystemStep& step, const std::vector<Pose>& poses,
              bool friction, bool only_new, ContactPoints& points, ContactProblem& problem);

  /// The places that pushed, for the velocity part of the step.
  void collect(const ContactProblem& problem, std::vector<FaceTouch>& touches) const;

 private:
  struct Entry {
    std::size_t contact;  // index in the problem
    FaceTouch touch;
  };
  bool linearise(const System& system, const SystemStep& step, const std::vector<Pose>& poses,
                 const Entry& entry, const ContactPoints& points, ContactProblem& problem) const;
  bool find(const System& system, const SystemStep& step, const std::vector<Pose>& poses,
            bool friction, ContactPoints& points, ContactProblem& problem);

  bool is_needed_ = false;
  std::vector<Entry> entries_;
};

/// A place is added if it is deeper than this part of the triangle's size [-]: beyond the accuracy
/// of deepest_point(), which costs its square in depth.
inline constexpr double kFaceTolerance = 1e-5;

/// Velocity stage: a contact at a touch, with no approach wanted.
[[nodiscard]] Contact contact_at(const FaceTouch& touch, const SystemStep& step,
                                 ContactPoints& points, ContactProblem& problem,
                                 bool end_velocities);

}  // namespace weft::reference
