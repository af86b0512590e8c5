#include <weft/bridge/classic/body_life.hpp>

#include <string>
#include <utility>

#include <BulletSoftBody/btSoftBodyInternals.h>

#include <weft/core/error.hpp>

namespace weft::bridge {
inline namespace WEFT_BULLET_PRECISION {
namespace {

class FollowedShape : public btSoftBodyCollisionShape {
 public:
  FollowedShape(btSoftBody& body, std::unique_ptr<btCollisionShape> own)
      : btSoftBodyCollisionShape(&body), own_(std::move(own)) {
    setUserPointer(own_->getUserPointer());
    setUserIndex(own_->getUserIndex());
  }
  ~FollowedShape() override { life_->is_alive = false; }
  FollowedShape(const FollowedShape&) = delete;
  FollowedShape& operator=(const FollowedShape&) = delete;

  [[nodiscard]] const std::shared_ptr<BodyLife>& life() const { return life_; }

  // The first thing that a world asks of a body that it is given, after it has named its solver.
  void getAabb(const btTransform& pose, btVector3& low, btVector3& high) const override {
    const bool is_in_world = m_body->getBroadphaseHandle() != nullptr;
    if (!is_in_world && life_->solver != nullptr && m_body->getSoftBodySolver() != nullptr &&
        m_body->getSoftBodySolver() != life_->solver) {
      throw InvalidArgument(
          "soft body solver: a body with laws is added to a world that has another solver, which "
          "would "
          "not know them; expected the world that was made with the laws' solver, or detach() "
          "first");
    }
    own_->getAabb(pose, low, high);
  }
  btScalar getMargin() const override { return own_->getMargin(); }
  void setMargin(btScalar margin) override { own_->setMargin(margin); }
  const char* getName() const override { return own_->getName(); }

 private:
  std::unique_ptr<btCollisionShape> own_;
  std::shared_ptr<BodyLife> life_ = std::make_shared<BodyLife>();
};

const FollowedShape* followed_shape(const btSoftBody& body) {
  return dynamic_cast<const FollowedShape*>(body.getCollisionShape());
}

}  // namespace

std::shared_ptr<BodyLife> follow_life(btSoftBody& body) {
  if (const FollowedShape* known = followed_shape(body)) return known->life();
  std::unique_ptr<btCollisionShape> own(body.getCollisionShape());
  auto* const shape = new FollowedShape(body, std::move(own));
  // btSoftBody's own setCollisionShape() does nothing.
  body.btCollisionObject::setCollisionShape(shape);
  return shape->life();
}

void check_solver(const char* who, const btSoftBody& body, const btSoftBodySolver& solver) {
  const bool is_in_world = body.getBroadphaseHandle() != nullptr;
  if (is_in_world && body.getSoftBodySolver() != &solver) {
    throw InvalidArgument(
        std::string(who) +
        ": the body is in a world that steps it with another solver, expected a world that "
        "was made with this one");
  }
  const FollowedShape* const known = followed_shape(body);
  const btSoftBodySolver* const other = known ? known->life()->solver : nullptr;
  if (other != nullptr && other != &solver) {
    throw InvalidArgument(
        std::string(who) +
        ": another solver has laws or contacts for the body, expected its detach() first");
  }
}

}  // namespace WEFT_BULLET_PRECISION
}  // namespace weft::bridge
