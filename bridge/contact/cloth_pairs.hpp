#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include <weft/bridge/bullet/precision.hpp>
#include <weft/bridge/contact/cloth_contact.hpp>
#include <weft/bridge/contact/layer_impacts.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {

/// Fast bodies that may meet each other or themselves in a step. Their contacts are found where springs have led the nodes: where
/// they would fly without springs, stiff bodies that lie on each other have other neighbors than they end the step with.
class ClothPairs {
 public:
  /// In each step anew.
  void clear();
  /// Body and contact must live until the end of the step, and are in no pair but by these.
  void add(btSoftBody& body, ClothContact& contact, btSoftBody& other, ClothContact& other_contact);
  /// One that meets itself.
  void add_self(btSoftBody& body, ClothContact& contact) { add(body, contact, body, contact); }
  [[nodiscard]] bool empty() const { return pairs_.empty(); }
  [[nodiscard]] bool are_pair(const btSoftBody& one, const btSoftBody& other) const;
  /// Keeps pairs of which both bodies are in, and returns the others.
  [[nodiscard]] ClothPairs take_apart(const std::function<bool(const btSoftBody&)>& is_in);
  /// Has these pairs from now on.
  void take_back(ClothPairs&& pairs);
  /// Forgets pairs of which a body has stopped in this step.
  void drop_stopped(const std::function<bool(const btSoftBody&)>& has_stopped);

  /// Takes contacts with bodies that are in no pair out of m_scontacts, and puts them back.
  void set_others_aside();
  void take_others_back();
  /// Makes m_scontacts those of the pairs, where nodes are now. Returns whether there are any. time_step [s].
  bool find_contacts(btScalar time_step);
  /// The same, beside what is there.
  void add_contacts(btScalar time_step);
  /// Keeps layers from passing through each other between m_q and m_x, but for pairs of which one is inside of the other, which
  /// must come out. use(body, outcome) for each body that met something.
  void keep_apart(const std::function<void(const btSoftBody&, const LayerImpacts::Outcome&)>& use);

 private:
  struct Member {
    btSoftBody* body;
    ClothContact* contact;
    std::vector<btSoftBody::SContact> others;
  };
  struct Pair {
    std::size_t first, second;  ///< of members_; equal: it meets itself
    bool is_inside = false;     ///< one of the other, as the last search for contacts found
    [[nodiscard]] bool is_self() const { return first == second; }
  };
  [[nodiscard]] std::size_t member(btSoftBody& body, ClothContact& contact);
  [[nodiscard]] bool meets_others(std::size_t member) const;

  std::vector<Member> members_;
  std::vector<Pair> pairs_;
  LayerImpacts impacts_;
};

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
