// What a snapshot has of a body's laws and contacts.
// Tested by tests/bridge/snapshot_test.cpp.
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/snapshot/object_table.hpp>
#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

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

/// Of the laws' names and parameters; 0 where only the laws themselves are known.
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

/// Of what Bullet's own constraints hold a body together with.
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

}  // namespace

void FollowedMasses::serialize(StateArchive& archive) {
  archive.runs(std::span(masses_.data(), static_cast<std::size_t>(masses_.size())));
  archive.runs(std::span(inverse_masses_));
}

void SoftBodySolver::Attachment::renew_fast() {
  if (!source) {
    throw Error(
        "snapshot: the body has torn or has laws without names, expected replace_laws() with its "
        "mesh and the names of its laws first");
  }
  const bool are_masses_of_mesh = masses().size() == source->mesh.masses.size() &&
                                  masses() == source->mesh.masses.cast<btScalar>();
  fast = std::make_unique<FastBody>(
      source->mesh, source->laws,
      are_masses_of_mesh ? source->mesh.masses : VectorX<double>(masses().cast<double>()),
      fast->settings());
}

void SoftBodySolver::Attachment::serialize(StateArchive& archive, const ObjectTable& objects) {
  archive.part("attached laws");
  const bool is_fast = fast != nullptr;
  archive.expect(is_fast, "implicit springs");
  archive.expect(masses().size(), "number of masses");
  check_laws(archive, source.get());
  if (!is_fast) {
    std::uint64_t links = fingerprint_of_links(*body);
    const std::uint64_t own = links;
    archive.value(links);
    if (links != own) archive.refuse("the links had other rest lengths, expected those of now");
  }
  archive.value(time);
  archive.value(is_suspended);
  archive.value(is_reported);
  archive.value(was_in_world);
  bool is_blown_up = blow_up.has_value();
  archive.value(is_blown_up);
  if (archive.is_reading()) {
    blow_up = is_blown_up ? std::optional<BodyBlowUp>(BodyBlowUp{}) : std::nullopt;
    deferred.drop();
    is_moving = false;
  }
  if (is_blown_up) {
    archive.value(blow_up->node);
    archive.value(blow_up->reason);
  }
  followed.serialize(archive);
  rigid_response.serialize(archive, body->m_nodes.size());
  if (!is_fast) return;
  FastBody::Structure stored = fast->structure();
  const int num_new_rest_lengths = stored.num_new_rest_lengths;
  stored.serialize(archive, body->m_nodes.size());
  if (stored.num_new_rest_lengths != num_new_rest_lengths) {
    archive.refuse("springs had other rest lengths, expected those that they have now");
  }
  if (archive.is_reading() && !fast->fits(stored)) {
    if (num_new_rest_lengths > 0) {
      archive.refuse(
          "springs have got rest lengths of their own, and pins or masses have changed: a solver "
          "cannot be made "
          "again from the laws");
    }
    renew_fast();
  }
  fast->serialize(archive, stored, objects, *body);
}

void SoftBodySolver::serialize(StateArchive& archive, const ObjectTable& objects,
                               btSoftBody& body) {
  Attachment* const attachment = find(body);
  archive.expect(attachment != nullptr, "attached laws");
  if (attachment) attachment->serialize(archive, objects);
  ContactEntry* entry = find_contact_entry(body);
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
  if (!entry) entry = &contact_by_flag(body);
  archive.value(entry->was_in_world);
  entry->contact.serialize(archive, body);
}

bool SoftBodySolver::is_fresh(const btSoftBody& body) const {
  const Attachment* const attachment = find(body);
  return !attachment || !attachment->fast || attachment->fast->is_fresh();
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
