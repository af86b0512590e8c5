#include <weft/bridge/contact/cloth_pairs.hpp>

#include <algorithm>

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
  pairs_.emplace_back(first, member(other, other_contact));
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
  for (const Member& one : members_) one.contact->begin_step();  // nodes have moved
  for (const auto& [first, second] : pairs_) {
    const Member& a = members_[first];
    const Member& b = members_[second];
    a.contact->add_contacts(*a.body, *b.body, *b.contact, time_step);
    b.contact->add_contacts(*b.body, *a.body, *a.contact, time_step);
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
