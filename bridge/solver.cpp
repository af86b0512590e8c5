#include <weft/bridge/solver.hpp>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/adoption/suitable_body.hpp>
#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/classic/nodes/position_limits.hpp>
#include <weft/bridge/classic/torn_laws.hpp>
#include <weft/bridge/cloth.hpp>
#include <weft/core/error.hpp>
#include <weft/core/trace.hpp>
#include <weft/custom_forces/registry.hpp>
#include <weft/mesh/cutting/tear.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

using LawSet = forces::LawSet<btScalar>;

namespace {

/// Those that Bullet integrates as forces: FastBody solves for springs and bending.
LawSet explicit_laws(const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws) {
  std::vector<forces::LawSpecification> rest;
  for (const forces::LawSpecification& law : laws) {
    if (!fast::is_implicit(law) && !fast::is_bending(law.law)) rest.push_back(law);
  }
  return make_laws(mesh, rest);
}

/// A body may leave its world and come back; only one that does not exist any more is forgotten.
template <class Entry>
void forget_deleted(std::vector<std::unique_ptr<Entry>>& list) {
  std::erase_if(list, [](const std::unique_ptr<Entry>& entry) { return !entry->life->is_alive; });
}

bool is_among(const btAlignedObjectArray<btSoftBody*>& present, btSoftBody* body) {
  return present.findLinearSearch(body) != present.size();
}

/// Why implicit springs cannot stand in for what the body has; nothing if they can.
std::optional<std::string> reason_against_fast(const btSoftBody& body,
                                               const std::vector<forces::LawSpecification>& laws) {
  if (auto reason = reason_against_implicit(body)) return reason;
  const auto is_tension = [](const forces::LawSpecification& law) {
    return forces::role_of(law.law) == forces::LawRole::kSpring;
  };
  if (body.m_links.size() > 0 && std::none_of(laws.begin(), laws.end(), is_tension)) {
    return "it has " + std::to_string(body.m_links.size()) +
           " links, which implicit springs replace, and no tension law is among the laws";
  }
  return std::nullopt;
}

/// Contacts that Weft has found, and then Bullet's.
std::vector<NodeContact> node_contacts(const btSoftBody& body,
                                       const std::vector<RigidContact>& own) {
  std::vector<NodeContact> contacts;
  for (const RigidContact& contact : own) {
    const btVector3& position = body.m_nodes[contact.node].m_x;
    contacts.push_back({contact.node, contact.object, contact.normal,
                        btDot(position, contact.normal) - contact.offset, contact.impulse,
                        contact.is_sticking});
  }
  for (int i = 0; i < body.m_rcontacts.size(); ++i) {
    const btSoftBody::RContact& contact = body.m_rcontacts[i];
    // Nodes that the program has added since the step have moved all of them, and left this pointer behind.
    const btSoftBody::Node* const first = &body.m_nodes[0];
    const std::less<> is_before;
    if (is_before(contact.m_node, first) || !is_before(contact.m_node, first + body.m_nodes.size()))
      continue;
    const auto node = static_cast<int>(contact.m_node - first);
    const btSoftBody::sCti& met = contact.m_cti;
    contacts.push_back({node, met.m_colObj, met.m_normal,
                        btDot(contact.m_node->m_x, met.m_normal) + met.m_offset});
  }
  return contacts;
}

}  // namespace

SoftBodySolver::SoftBodySolver(const BulletLayout& caller)
    : attachments_(std::make_unique<Attachments>()) {
  require_matching_bullet(caller);
}

SoftBodySolver::~SoftBodySolver() {
  for (const auto& attachment : attachments_->list) attachment->life->solver = nullptr;
  for (const auto& entry : attachments_->contacts) entry->life->solver = nullptr;
}

SoftBodySolver::Attachment* SoftBodySolver::find(const btSoftBody& body) const {
  return attachments_->find(body);
}

void SoftBodySolver::attach(btSoftBody& body, const ClothMesh& mesh,
                            const std::vector<forces::LawSpecification>& laws,
                            DampingPlace damping) {
  check_topology("soft body solver", body, mesh);
  LawSet set = make_laws(mesh, laws);
  attach(body, std::move(set), mesh.masses.cast<btScalar>(), damping);
  find(body)->source = std::make_shared<LawSource>(LawSource{mesh, laws});
}

void SoftBodySolver::attach(btSoftBody& body, LawSet laws, VectorX<btScalar> masses,
                            DampingPlace damping) {
  if (has_laws(body)) {
    throw InvalidArgument("soft body solver: the body has laws already, expected detach() first");
  }
  check_solver("soft body solver", body, *this);
  auto attachment = std::make_unique<Attachment>(body, std::move(laws), std::move(masses), damping);
  attachment->life->solver = this;
  attachments_->list.push_back(std::move(attachment));
}

// An attachment of its own is checked first, so that laws that do not fit leave all as it was.
void SoftBodySolver::replace_laws(btSoftBody& body, LawSet laws, VectorX<btScalar> masses) {
  Attachment* const old = find(body);
  if (!old) {
    throw InvalidArgument("soft body solver: the body has no laws, expected attach() first");
  }
  auto attachment =
      std::make_unique<Attachment>(body, std::move(laws), std::move(masses), old->damping);
  attachment->contact_response = old->contact_response;
  attachment->blow_up = old->blow_up;
  attachment->is_reported = old->is_reported;
  attachment->was_in_world = old->was_in_world;
  attachment->is_suspended = old->is_suspended;
  attachment->time = old->time;
  attachment->on_contact = old->on_contact;
  attachment->on_blow_up = old->on_blow_up;
  const bool was_begun = old->deferred.is_in_flight();
  for (auto& entry : attachments_->list) {
    if (entry.get() == old) entry = std::move(attachment);
  }
  if (was_begun && !is_still(body)) find(body)->begin_forces();
}

std::optional<std::string> SoftBodySolver::attach_fast(
    btSoftBody& body, const ClothMesh& mesh, const std::vector<forces::LawSpecification>& laws,
    const FastSettings& settings) {
  if (auto reason = reason_against_fast(body, laws)) return reason;
  check_topology("soft body solver", body, mesh);
  LawSet set = explicit_laws(mesh, laws);
  auto fast = std::make_unique<FastBody>(mesh, laws, mesh.masses, settings);
  fast->share(attachments_->prepared);
  attach(body, std::move(set), mesh.masses.cast<btScalar>());
  find(body)->fast = std::move(fast);
  find(body)->links.note(body);
  find(body)->source = std::make_shared<LawSource>(LawSource{mesh, laws});
  return std::nullopt;
}

Cloth SoftBodySolver::cloth(btSoftBody& body) {
  return {*this, body, follow_life(body)};
}

FastBody& SoftBodySolver::fast_body(const btSoftBody& body) const {
  Attachment* attachment = find(body);
  if (!attachment || !attachment->fast) {
    throw InvalidArgument("soft body solver: the body is not fast, expected attach_fast() first");
  }
  return *attachment->fast;
}

void SoftBodySolver::set_fast_settings(btSoftBody& body, const FastSettings& settings) {
  FastBody& fast = fast_body(body);
  check(settings);
  fast.set_settings(settings);
}

StepError SoftBodySolver::step_error(const btSoftBody& body) const {
  return fast_body(body).step_error();
}

bool SoftBodySolver::is_asleep(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment && attachment->fast && attachment->fast->is_asleep();
}

void SoftBodySolver::wake(btSoftBody& body) {
  Attachment* attachment = find(body);
  if (attachment && attachment->fast) attachment->fast->wake();
}

bool SoftBodySolver::is_fast(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment && attachment->fast;
}

int SoftBodySolver::num_contacts(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  const int num_with_cloth = body.m_scontacts.size();
  if (attachment && attachment->fast) {
    return num_with_cloth + static_cast<int>(attachment->fast->contacts().size());
  }
  const int num_own = attachment ? attachment->rigid_response.num_contacts() : 0;
  return num_with_cloth + num_own + body.m_rcontacts.size();
}

std::vector<NodeContact> SoftBodySolver::rigid_contacts(const btSoftBody& body) const {
  std::vector<RigidContact> own;
  if (const Attachment* const attachment = find(body)) {
    if (attachment->fast) own = attachment->fast->contacts();
    attachment->rigid_response.list_contacts(own);
  }
  return node_contacts(body, own);
}

void SoftBodySolver::replace_laws(btSoftBody& body, const ClothMesh& mesh,
                                  const std::vector<forces::LawSpecification>& laws) {
  const Attachment* const old = find(body);
  const bool is_fast = old && old->fast;
  check_topology("soft body solver", body, mesh);
  LawSet set = is_fast ? explicit_laws(mesh, laws) : make_laws(mesh, laws);
  auto source = std::make_shared<LawSource>(LawSource{mesh, laws});
  std::unique_ptr<FastBody> fast;
  if (is_fast) {
    fast = std::make_unique<FastBody>(mesh, laws, mesh.masses, old->fast->settings());
    fast->share(attachments_->prepared);
  }
  replace_laws(body, std::move(set), mesh.masses.cast<btScalar>());
  find(body)->source = std::move(source);
  if (!fast) return;
  find(body)->fast = std::move(fast);
  find(body)->links.note(body);
}

TornLaws SoftBodySolver::laws_after(const btSoftBody& body, const Tear& tear,
                                    const std::vector<forces::LawSpecification>& laws) const {
  if (!is_fast(body)) return {make_laws(tear.mesh, laws), {}, {}, {}};
  TornLaws torn{explicit_laws(tear.mesh, laws), {tear.mesh, laws}, {}, {}};
  torn.is_changed.assign(static_cast<std::size_t>(tear.mesh.num_nodes()), 0);
  for (const int node : tear.changed) torn.is_changed[static_cast<std::size_t>(node)] = 1;
  torn.springs = fast::make_network_at(torn.is_changed, tear.mesh, laws);
  return torn;
}

void SoftBodySolver::replace_laws(btSoftBody& body, const Tear& tear, TornLaws laws) {
  Attachment* const old = find(body);
  std::unique_ptr<FastBody> fast = old ? std::move(old->fast) : nullptr;
  try {
    replace_laws(body, std::move(laws.laws), tear.mesh.masses.cast<btScalar>());
  } catch (...) {
    if (old) old->fast = std::move(fast);
    throw;
  }
  if (!fast) return;
  fast->set_bending(std::move(laws.bending));
  fast->tear(laws.springs, laws.is_changed, tear.mesh.masses, tear.origins);
  find(body)->fast = std::move(fast);
}

void SoftBodySolver::detach(btSoftBody& body) {
  std::erase_if(attachments_->list, [&](const auto& attachment) {
    if (!attachment->is_of(body)) return false;
    if (!find_contact_entry(body)) attachment->life->solver = nullptr;
    return true;
  });
}

void SoftBodySolver::set_position_limits(btSoftBody& body, PositionLimits limits) {
  Attachment* attachment = find(body);
  if (!attachment) {
    throw InvalidArgument(
        "soft body solver: limits for a body without laws, expected attach() first");
  }
  check_position_limits(limits, body.m_nodes.size());
  attachment->limits = std::move(limits);
  wake(body);
}

void SoftBodySolver::set_suspended(btSoftBody& body, bool is_suspended) {
  Attachment* attachment = find(body);
  if (!attachment) {
    throw InvalidArgument(
        "soft body solver: suspends a body without laws, expected attach() first");
  }
  if (attachment->is_suspended == is_suspended) return;
  attachment->is_suspended = is_suspended;
  attachment->deferred.drop();
  // Those of the last step with it would be solved once more, and it may be elsewhere now.
  body.m_rcontacts.resizeNoInitialize(0);
  body.m_scontacts.resizeNoInitialize(0);
  attachment->rigid_response.begin_step();
  if (!is_suspended) body.updateNormals();
  wake(body);
}

bool SoftBodySolver::is_suspended(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment && attachment->is_suspended;
}

void SoftBodySolver::set_cloth_contact(btSoftBody& body, const ClothContactSettings& settings) {
  check_solver("soft body solver", body, *this);
  ClothContact contact(body, settings);
  auto entry = std::make_unique<ContactEntry>(body, follow_life(body), std::move(contact));
  entry->life->solver = this;
  auto& list = attachments_->contacts;
  std::erase_if(list, [&](const auto& known) { return known->is_of(body); });
  list.push_back(std::move(entry));
  // Last in every iteration: links that are solved after a contact pull layers into each other.
  body.m_cfg.m_psequence.remove(btSoftBody::ePSolver::SContacts);
  body.m_cfg.m_psequence.push_back(btSoftBody::ePSolver::SContacts);
}

ContactEntry* SoftBodySolver::find_contact_entry(const btSoftBody& body) const {
  return attachments_->contact_of(body);
}

ClothContact* SoftBodySolver::find_contact(const btSoftBody& body) const {
  ContactEntry* const entry = find_contact_entry(body);
  return entry ? &entry->contact : nullptr;
}

void SoftBodySolver::add_copies(const btSoftBody& body, const std::vector<int>& origins) {
  if (ClothContact* contact = find_contact(body)) contact->add_copies(body, origins);
}

void SoftBodySolver::set_deferred(bool is_deferred) {
  is_deferred_ = is_deferred;
  if (is_deferred) return;
  for (const auto& attachment : attachments_->list) attachment->deferred.drop();
}

long SoftBodySolver::num_recomputed(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment ? attachment->deferred.num_recomputed() : 0;
}

void SoftBodySolver::set_contact_response(btSoftBody& body, ContactResponse response) {
  Attachment* attachment = find(body);
  if (!attachment || attachment->fast) {
    throw InvalidArgument(
        "the body has no attached laws, or implicit springs, which have contacts of their own; "
        "expected attach() before "
        "set_contact_response()");
  }
  attachment->contact_response = response;
}

bool SoftBodySolver::has_laws(const btSoftBody& body) const {
  return find(body) != nullptr;
}

std::optional<BodyBlowUp> SoftBodySolver::blow_up(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  return attachment ? attachment->blow_up : std::nullopt;
}

bool SoftBodySolver::is_still(const btSoftBody& body) const {
  const Attachment* attachment = find(body);
  if (!attachment) return false;
  return attachment->blow_up || attachment->is_suspended ||
         (attachment->fast && attachment->fast->is_asleep());
}

// The world hands over its bodies at the start of every step.
void SoftBodySolver::optimize(btAlignedObjectArray<btSoftBody*>& bodies, bool force_update) {
  btDefaultSoftBodySolver::optimize(bodies, force_update);
  forget_deleted(attachments_->list);
  forget_deleted(attachments_->contacts);
  for (const auto& attachment : attachments_->list) {
    const bool was_in_world = attachment->was_in_world;
    attachment->was_in_world = is_among(m_softBodySet, attachment->body);
    // One that comes back may come to another position.
    if (attachment->was_in_world && !was_in_world && attachment->fast) attachment->fast->wake();
  }
  for (const auto& entry : attachments_->contacts) {
    entry->was_in_world = is_among(m_softBodySet, entry->body);
  }
}

void SoftBodySolver::set_on_blow_up(std::function<void(btSoftBody&, const BodyBlowUp&)> callback) {
  attachments_->on_blow_up = std::move(callback);
}

void SoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* object) {
  Attachment* attachment = find(*body);
  if (!attachment) return btDefaultSoftBodySolver::processCollision(body, object);
  attachment->guard([&] {
    const bool has_stopped = attachment->blow_up || attachment->is_suspended;
    if (has_stopped || attachment->collide(*object, attachments_->hulls, time_step_)) return;
    btDefaultSoftBodySolver::processCollision(body, object);
  });
}

// Cloth that moves keeps or wakes what it meets. Cloth that is not fast is taken to move.
void SoftBodySolver::tell_of_each_other(btSoftBody& body, btSoftBody& other) {
  Attachment* const a = find(body);
  Attachment* const b = find(other);
  const auto is_at_rest = [](const Attachment* attachment) {
    return attachment && attachment->fast && attachment->fast->is_at_rest();
  };
  if (a && a->fast) a->fast->notify_cloth(is_at_rest(b));
  if (b && b->fast) b->fast->notify_cloth(is_at_rest(a));
}

// Bullet's margin of a contact grows with the speed of the node, and so does the speed with which the contact throws it
// out. Links that hold nothing exactly eat that up; springs that are solved for do not.
ContactEntry& SoftBodySolver::contact_by_flag(btSoftBody& body) {
  constexpr double kLeastMargin = 1e-3;  // [m] a shape may have none, layers cannot
  const double margin =
      std::max(kLeastMargin, static_cast<double>(body.getCollisionShape()->getMargin()));
  const double friction = static_cast<double>(body.m_cfg.kDF);
  const ClothContactSettings settings{.with_others = true, .margin = margin, .friction = friction};
  ContactEntry* entry = find_contact_entry(body);
  if (!entry) {
    attachments_->contacts.push_back(
        std::make_unique<ContactEntry>(body, follow_life(body), ClothContact(body, settings)));
    entry = attachments_->contacts.back().get();
    entry->was_in_world = entry->is_by_flag = true;
  } else if (!entry->contact.settings().with_others) {
    entry->contact.meet_others(margin, friction);
    entry->is_by_flag = true;
  }
  return *entry;
}

void SoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other) {
  Attachment* const attachment = find(*body);
  if (!attachment) return notify_cloth(*body, *other);
  attachment->guard([&] { notify_cloth(*body, *other); });
}

void SoftBodySolver::notify_cloth(btSoftBody& body, btSoftBody& other) {
  tell_of_each_other(body, other);
  if (is_still(body) || is_still(other)) return;
  const auto is_asked_for = [&](const btSoftBody& one) {
    const ContactEntry* const entry = find_contact_entry(one);
    return entry && entry->contact.settings().with_others && !entry->is_by_flag;
  };
  const auto has_flag = [](const btSoftBody& one) {
    return (one.m_cfg.collisions & btSoftBody::fCollision::VF_SS) != 0;
  };
  const bool by_flag = (is_fast(body) || is_fast(other)) && has_flag(body) && has_flag(other);
  if (!by_flag && !(is_asked_for(body) && is_asked_for(other))) {
    return btDefaultSoftBodySolver::processCollision(&body, &other);
  }
  ClothContact& contact = by_flag ? contact_by_flag(body).contact : *find_contact(body);
  ClothContact& other_contact = by_flag ? contact_by_flag(other).contact : *find_contact(other);
  if (attachments_->add_pair(find(body), contact, find(other), other_contact)) return;
  contact.add_contacts(body, other, other_contact, time_step_);
  other_contact.add_contacts(other, body, contact, time_step_);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
