#include <weft/bridge/cloth.hpp>

#include <algorithm>
#include <string>
#include <utility>

#include <weft/bridge/bullet/bullet_vector.hpp>
#include <weft/bridge/classic/attachment.hpp>
#include <weft/bridge/classic/body_life.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

/// Links are as long as in the mesh while laws are made of it: what is put back is followed as a change.
class LinksOfMesh {
 public:
  LinksOfMesh(btSoftBody& body, const ClothMesh& mesh) : body_(body) {
    for (int l = 0; l < body.m_links.size(); ++l) {
      btSoftBody::Link& link = body.m_links[l];
      rest_lengths_.push_back(link.m_rl);
      const auto end = [&](int k) -> Eigen::Index { return link.m_n[k] - &body.m_nodes[0]; };
      link.m_rl = static_cast<btScalar>(
          (mesh.rest_positions.col(end(0)) - mesh.rest_positions.col(end(1))).norm());
    }
  }
  ~LinksOfMesh() {
    for (int l = 0; l < body_.m_links.size(); ++l) {
      body_.m_links[l].m_rl = rest_lengths_[static_cast<std::size_t>(l)];
    }
  }
  LinksOfMesh(const LinksOfMesh&) = delete;
  LinksOfMesh& operator=(const LinksOfMesh&) = delete;

 private:
  btSoftBody& body_;
  std::vector<btScalar> rest_lengths_;
};

}  // namespace

std::string_view name_of(ClothState::Status status) {
  switch (status) {
    case ClothState::Status::kGone:
      return "gone";
    case ClothState::Status::kWithoutLaws:
      return "without laws";
    case ClothState::Status::kAwake:
      return "awake";
    case ClothState::Status::kAsleep:
      return "asleep";
    case ClothState::Status::kSuspended:
      return "suspended";
    case ClothState::Status::kBlownUp:
      return "blown up";
  }
  return "";
}

btSoftBody* Cloth::body() const {
  return life_ && life_->is_alive ? body_ : nullptr;
}

bool Cloth::has_laws() const {
  return body() != nullptr && life_->solver == solver_ && solver_->has_laws(*body_);
}

ClothState Cloth::state() const {
  using Status = ClothState::Status;
  if (body() == nullptr) return {Status::kGone};
  if (!has_laws()) return {Status::kWithoutLaws};
  ClothState state{Status::kAwake};
  if (solver_->is_fast(*body_)) state.step_error = solver_->step_error(*body_);
  state.blow_up = solver_->blow_up(*body_);
  if (state.blow_up) {
    state.status = Status::kBlownUp;
  } else if (solver_->is_suspended(*body_)) {
    state.status = Status::kSuspended;
  } else if (solver_->is_asleep(*body_)) {
    state.status = Status::kAsleep;
  }
  return state;
}

std::vector<forces::LawSpecification> Cloth::laws() const {
  if (!has_laws()) return {};
  const auto& source = solver_->find(*body_)->source;
  return source ? source->laws : std::vector<forces::LawSpecification>{};
}

std::optional<std::string> Cloth::set(const forces::LawSpecification& law) {
  std::vector<forces::LawSpecification> all = laws();
  const auto is_replaced = [&](const forces::LawSpecification& other) {
    return other.law == law.law && (law.sets.empty() || other.sets == law.sets);
  };
  const auto place = std::find_if(all.begin(), all.end(), is_replaced);
  if (place == all.end()) {
    all.push_back(law);
  } else {
    *place = law;
    all.erase(std::remove_if(place + 1, all.end(), is_replaced), all.end());
  }
  return replace(all);
}

std::optional<std::string> Cloth::remove(std::string_view law) {
  std::vector<forces::LawSpecification> all = laws();
  std::erase_if(all, [&](const forces::LawSpecification& other) { return other.law == law; });
  return replace(all);
}

std::optional<std::string> Cloth::replace(const std::vector<forces::LawSpecification>& laws) {
  if (!has_laws()) return "the body is " + std::string(name_of(state().status));
  const SoftBodySolver::Attachment& attachment = *solver_->find(*body_);
  if (attachment.blow_up) return "the body has blown up: " + attachment.blow_up->reason;
  if (!attachment.source)
    return "nobody knows the mesh of the body: it was attached with a LawSet, or has torn";
  const std::shared_ptr<const LawSource> source = attachment.source;  // of which another is made
  if (source->mesh.num_nodes() != body_->m_nodes.size()) {
    return "the body has " + std::to_string(body_->m_nodes.size()) +
           " nodes since the last step, expected the " + std::to_string(source->mesh.num_nodes()) +
           " of its mesh";
  }
  const LinksOfMesh links(*body_, source->mesh);
  PositionLimits limits = attachment.limits;
  solver_->replace_laws(*body_, source->mesh, laws);
  solver_->find(*body_)->limits = std::move(limits);
  return std::nullopt;
}

std::vector<ClothContactPoint> Cloth::contacts() const {
  std::vector<ClothContactPoint> contacts;
  if (!has_laws()) return contacts;
  const btScalar margin = body_->getCollisionShape()->getMargin();
  for (const NodeContact& contact : solver_->rigid_contacts(*body_)) {
    if (contact.impulse.isZero()) continue;
    const btVector3& position = body_->m_nodes[contact.node].m_x;
    contacts.push_back({contact.node, contact.object,
                        position - (contact.distance + margin) * contact.normal, contact.normal,
                        contact.impulse, contact.is_sticking});
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const auto& a, const auto& b) { return a.node < b.node; });
  return contacts;
}

bool Cloth::on_contact(std::function<void(const std::vector<ClothContactPoint>&)> callback) {
  if (!has_laws()) return false;
  solver_->find(*body_)->on_contact = std::move(callback);
  return true;
}

bool Cloth::on_blow_up(std::function<void(const BodyBlowUp&)> callback) {
  if (!has_laws()) return false;
  solver_->find(*body_)->on_blow_up = std::move(callback);
  return true;
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
