#include <weft/bridge/contact/cloth_pairs.hpp>

#include <algorithm>

#include <weft/core/parallel/parallel_for.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

void ClothPairs::clear() {
  members_.clear();
  pairs_.clear();
}

std::size_t ClothPairs::member(btSoftBody& body, ClothContact& contact) {
  for (std::size_t m = 0; m < members_.size(); ++m) {
    if (members_[m].body == &body) return m;
  }
  members_.push_back({&body, &contact, {}});
  return members_.size() - 1;
}

void ClothPairs::add(btSoftBody& body, ClothContact& contact, btSoftBody& other,
                     ClothContact& other_contact) {
  const std::size_t first = member(body, contact);
  pairs_.push_back({first, member(other, other_contact)});
}

bool ClothPairs::are_pair(const btSoftBody& one, const btSoftBody& other) const {
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const auto& pair) {
    const btSoftBody* const first = members_[pair.first].body;
    const btSoftBody* const second = members_[pair.second].body;
    return (first == &one && second == &other) || (first == &other && second == &one);
  });
}

ClothPairs ClothPairs::take_apart(const std::function<bool(const btSoftBody&)>& is_in) {
  ClothPairs inside;
  ClothPairs outside;
  for (const Pair& pair : pairs_) {
    const Member& a = members_[pair.first];
    const Member& b = members_[pair.second];
    ClothPairs& part = is_in(*a.body) && is_in(*b.body) ? inside : outside;
    part.add(*a.body, *a.contact, *b.body, *b.contact);
  }
  // The surfaces that it knows stay here.
  members_ = std::move(inside.members_);
  pairs_ = std::move(inside.pairs_);
  return outside;
}

void ClothPairs::take_back(ClothPairs&& pairs) {
  members_ = std::move(pairs.members_);
  pairs_ = std::move(pairs.pairs_);
}

void ClothPairs::drop_stopped(const std::function<bool(const btSoftBody&)>& has_stopped) {
  std::erase_if(pairs_, [&](const auto& pair) {
    return has_stopped(*members_[pair.first].body) || has_stopped(*members_[pair.second].body);
  });
}

void ClothPairs::set_others_aside() {
  for (Member& one : members_) {
    auto& contacts = one.body->m_scontacts;
    one.others.clear();
    for (int c = 0; c < contacts.size(); ++c) one.others.push_back(contacts[c]);
    contacts.resizeNoInitialize(0);
  }
}

void ClothPairs::take_others_back() {
  for (Member& one : members_) {
    one.body->m_scontacts.resizeNoInitialize(0);
    for (const btSoftBody::SContact& contact : one.others) one.body->m_scontacts.push_back(contact);
  }
}

bool ClothPairs::find_contacts(btScalar time_step) {
  for (const Member& one : members_) one.body->m_scontacts.resizeNoInitialize(0);
  add_contacts(time_step);
  return std::any_of(members_.begin(), members_.end(),
                     [](const Member& one) { return one.body->m_scontacts.size() > 0; });
}

void ClothPairs::add_contacts(btScalar time_step) {
  parallel_for(pairs_.size(), [&](std::size_t p) {
    const Member& one = members_[pairs_[p].first];
    if (pairs_[p].is_self()) one.contact->add_self_contacts(*one.body, time_step);
  });
  for (Pair& pair : pairs_) {
    if (pair.is_self()) continue;
    const Member& a = members_[pair.first];
    const Member& b = members_[pair.second];
    const bool is_one = a.contact->add_contacts(*a.body, *b.body, *b.contact, time_step);
    const bool is_other = b.contact->add_contacts(*b.body, *a.body, *a.contact, time_step);
    pair.is_inside = is_one || is_other;
  }
}

bool ClothPairs::meets_others(std::size_t member) const {
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    return !pair.is_self() && (pair.first == member || pair.second == member);
  });
}

void ClothPairs::keep_apart(
    const std::function<void(const btSoftBody&, const LayerImpacts::Outcome&)>& use) {
  impacts_.clear();
  bool is_any = false;
  for (const Pair& pair : pairs_) {
    const Member& one = members_[pair.first];
    // Another body could push parts of this one into each other, in a later round.
    const bool is_apart =
        pair.is_self() && !meets_others(pair.first) && one.contact->is_apart_from_itself(*one.body);
    if (pair.is_inside || is_apart) continue;
    impacts_.add_pair(pair.first, pair.second);
    is_any = true;
  }
  if (!is_any) return;
  for (const Member& one : members_) impacts_.add({one.body, one.contact});
  const std::vector<LayerImpacts::Outcome> outcomes = impacts_.resolve();
  for (std::size_t m = 0; m < members_.size(); ++m) use(*members_[m].body, outcomes[m]);
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
