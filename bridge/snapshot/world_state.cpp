#include <weft/bridge/snapshot/world_state.hpp>

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/snapshot/bullet_state.hpp>
#include <weft/bridge/snapshot/fast_body_state.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

constexpr int kVersion = 5;

/// FNV-1a, to tell whether a body has the laws that it had.
class Fingerprint {
 public:
  void add(std::string_view text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
    add_byte(0);
  }
  void add(double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    for (int k = 0; k < 64; k += 8) add_byte(static_cast<unsigned char>(bits >> k));
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3U; }

  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

/// A hash of the laws' names and parameters; 0 where only the laws themselves are known.
std::uint64_t fingerprint_of(const LawSource* source) {
  if (source == nullptr) return 0;
  Fingerprint all;
  for (const forces::LawSpecification& law : source->laws) {
    all.add(law.law);
    for (const std::string& set : law.sets) all.add(set);
    for (const auto& [name, values] : law.parameters) {
      all.add(name);
      for (const double value : values) all.add(value);
    }
  }
  return all.value();
}

/// A hash of the links with which Bullet's own constraints hold a body together.
std::uint64_t fingerprint_of_links(const btSoftBody& body) {
  Fingerprint all;
  for (int l = 0; l < body.m_links.size(); ++l) {
    all.add(static_cast<double>(body.m_links[l].m_rl));
  }
  return all.value();
}

void check_laws(StateArchive& archive, const LawSource* source) {
  const std::uint64_t own = fingerprint_of(source);
  std::uint64_t stored = own;
  archive.value(stored);
  if (stored == own || stored == 0 || own == 0) return;
  archive.refuse("the body had other laws, expected those that it has now");
}

void check_links(StateArchive& archive, const btSoftBody& body) {
  const std::uint64_t own = fingerprint_of_links(body);
  std::uint64_t stored = own;
  archive.value(stored);
  if (stored != own) archive.refuse("the links had other rest lengths, expected those of now");
}

}  // namespace

void FollowedMasses::serialize(StateArchive& archive) {
  archive.runs(std::span(masses_.data(), static_cast<std::size_t>(masses_.size())));
  archive.runs(std::span(inverse_masses_));
}

bool WorldState::is_fresh(const SoftBodySolver& solver, const btSoftBody& body) {
  const SoftBodySolver::Attachment* const attachment = solver.find(body);
  return !attachment || !attachment->fast || FastBodyState::is_fresh(*attachment->fast);
}

void WorldState::check() const {
  const btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) check_savable(*objects[i], i);
}

// So that a snapshot of another world is not taken for one of this.
void WorldState::check_objects(StateArchive& archive) const {
  btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  archive.part("world");
  archive.expect(kVersion, "version");
  archive.expect(static_cast<int>(sizeof(btScalar)), "bytes of a number");
  archive.expect(objects.size(), "number of objects");
  for (int i = 0; i < objects.size(); ++i) {
    archive.expect(objects[i]->getInternalType(), "type of an object");
    archive.expect(objects[i]->getCollisionShape()->getShapeType(), "shape of an object");
  }
}

void WorldState::serialize(StateArchive& archive) {
  check_objects(archive);
  btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    if (btSoftBody* const body = btSoftBody::upcast(objects[i])) {
      serialize_body(archive, *body);
    } else {
      bridge::serialize(archive, *objects[i]);
    }
  }
  serialize_joints(archive);
  rebuild_broadphase(archive, *world_);
}

void WorldState::serialize_body(StateArchive& archive, btSoftBody& body) {
  const bool keeps_starts = solver_->is_still(body) || !body.isActive();
  bridge::serialize(archive, keeps_starts, body);
  const bool has_laws = solver_->has_laws(body);
  archive.expect(has_laws, "attached laws");
  if (has_laws) serialize_laws(archive, body);
  serialize_contact(archive, body);
  bool has_face_tree = !body.m_fdbvt.empty();
  archive.value(has_face_tree);
  // Trees of a body that only Weft solves bound its nodes and decide nothing.
  const bool are_trees_asked =
      !solver_->is_fast(body) || (body.m_cfg.collisions & btSoftBody::fCollision::VF_SS) != 0;
  if (are_trees_asked) rebuild_trees(has_face_tree, body);
  if (are_trees_asked || archive.is_reading()) body.updateNormals();
}

void WorldState::serialize_laws(StateArchive& archive, btSoftBody& body) {
  SoftBodySolver::Attachment& attachment = *solver_->find(body);
  archive.part("attached laws");
  const bool is_fast = attachment.fast != nullptr;
  archive.expect(is_fast, "implicit springs");
  archive.expect(attachment.masses().size(), "number of masses");
  check_laws(archive, attachment.source.get());
  if (!is_fast) check_links(archive, body);
  archive.value(attachment.time);
  archive.value(attachment.is_suspended);
  archive.value(attachment.is_reported);
  archive.value(attachment.was_in_world);
  bool is_blown_up = attachment.blow_up.has_value();
  archive.value(is_blown_up);
  if (archive.is_reading()) {
    attachment.blow_up.reset();
    if (is_blown_up) attachment.blow_up.emplace();
    attachment.deferred.drop();
    attachment.is_moving = false;
  }
  if (is_blown_up) {
    archive.value(attachment.blow_up->node);
    archive.value(attachment.blow_up->reason);
  }
  attachment.followed.serialize(archive);
  attachment.rigid_response.serialize(archive, body.m_nodes.size());
  if (is_fast) serialize_fast(archive, body);
}

void WorldState::serialize_fast(StateArchive& archive, btSoftBody& body) {
  SoftBodySolver::Attachment& attachment = *solver_->find(body);
  FastBodyState state(*attachment.fast);
  state.serialize_structure(archive, *attachment.fast);
  if (archive.is_reading() && !state.fits(*attachment.fast)) {
    if (state.has_new_rest_lengths()) {
      archive.refuse(
          "springs have got rest lengths of their own, and pins or masses have changed, expected "
          "one of the two at most: a solver cannot be made again of the laws");
    }
    renew_fast(body);
  }
  state.serialize(archive, objects_, body, *attachment.fast);
}

void WorldState::renew_fast(const btSoftBody& body) {
  SoftBodySolver::Attachment& attachment = *solver_->find(body);
  const LawSource* const source = attachment.source.get();
  if (source == nullptr) {
    throw Error(
        "snapshot: the body has torn or has laws without names, expected replace_laws() with its "
        "mesh and the names of its laws first");
  }
  const VectorX<btScalar>& masses = attachment.masses();
  const bool are_of_mesh =
      masses.size() == source->mesh.masses.size() && masses == source->mesh.masses.cast<btScalar>();
  VectorX<double> own = are_of_mesh ? source->mesh.masses : masses.cast<double>().eval();
  attachment.fast = std::make_unique<FastBody>(source->mesh, source->laws, std::move(own),
                                               attachment.fast->settings());
}

void WorldState::serialize_contact(StateArchive& archive, btSoftBody& body) {
  ContactEntry* entry = solver_->find_contact_entry(body);
  bool has_contact = entry != nullptr;
  archive.value(has_contact);
  if (!has_contact) {
    const bool is_too_much = entry != nullptr && !entry->is_by_flag;
    if (is_too_much) archive.refuse("the body had no contact with cloth, expected some");
    return;
  }
  bool is_by_flag = entry != nullptr && entry->is_by_flag;
  archive.value(is_by_flag);
  if (!entry && !is_by_flag) archive.refuse("the body had contact with cloth, expected none");
  if (!entry) entry = &solver_->contact_by_flag(body);
  archive.value(entry->was_in_world);
  archive.value(entry->is_in_contact);
  entry->contact.serialize(archive, body);
}

void WorldState::serialize_joints(StateArchive& archive) {
  archive.part("joints");
  archive.expect(world_->getNumConstraints(), "number of joints");
  for (int i = 0; i < world_->getNumConstraints(); ++i) {
    btTypedConstraint& joint = *world_->getConstraint(i);
    bool is_enabled = joint.isEnabled();
    btScalar impulse = joint.internalGetAppliedImpulse();
    archive.value(is_enabled);
    archive.value(impulse);
    joint.setEnabled(is_enabled);
    joint.internalSetAppliedImpulse(impulse);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
